#!/usr/bin/env bash
# The same report on a second run, byte for byte but for times: runs experiments twice by experiments/reproduce, on one
# thread and on three, and compares every file.
#
#   tests/experiments/twice.sh [NAME...]        a few cheap ones, small, or those named
#   tests/experiments/twice.sh --compare A B    two report folders that are there already
#
# What differs from run to run, and is not compared: files with "timing" in their path, the cells of class "time" in pages,
# and what reproduce keeps for itself (seconds*, stamp). Nothing else is let through.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
differ=0

# The files of a report, without those that may differ.
files_of() {
    (cd "$1" && find . -type f ! -path '*timing*' ! -name 'seconds*' ! -name stamp | LC_ALL=C sort)
}

# Pages without the contents of their cells of times, and without the rows and sections that are all about time.
without_times() {
    case $1 in
    *.html) sed -e 's/\(<t[dh] class="[^"]*\btime"\)>[^<]*</\1></g' "$1" ;;
    *) cat "$1" ;;
    esac
}

compare() {
    local file count=0
    files_of "$1" >"$scratch/files1"
    files_of "$2" >"$scratch/files2"
    if ! diff "$scratch/files1" "$scratch/files2"; then
        echo "not the same files"
        differ=1
    fi
    while read -r file; do
        count=$((count + 1))
        if [ -f "$2/$file" ] && ! cmp -s <(without_times "$1/$file") <(without_times "$2/$file"); then
            echo "differs: $file"
            case $file in
            *.html | *.csv | *.jsonl | *.svg) diff <(without_times "$1/$file") <(without_times "$2/$file") | cut -c1-300 | head -n 6 ;;
            esac
            differ=1
        fi
    done <"$scratch/files1"
    echo "$count files compared"
    [ "$count" -ge 3 ] || { echo "too few"; differ=1; }
}

if [ "${1:-}" = --compare ]; then
    compare "${2:?}" "${3:?}"
    exit $differ
fi
[ $# != 0 ] || set -- fig05-straight fig13-crab fig17-degenerate higher-cuts
for threads in 1 3; do
    SEAMLAB_THREADS=$threads "$root/experiments/reproduce" --quick --again --out "$scratch/$threads" "$@" >"$scratch/log" 2>&1 || {
        tail -n 30 "$scratch/log"
        exit 1
    }
done
compare "$scratch/1" "$scratch/3"
exit $differ
