#!/usr/bin/env bash
# What the program says of itself is what it does: help, man pages, completion and README against the options accepted.
set -u
seamlab=$1
root=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0

fail() {
    echo "$*"
    failed=1
}

# A value that an option of this kind takes.
value_of() {
    case $1 in
    flag) ;;
    on-off) echo on ;;
    choice) echo "${2%%|*}" ;;
    int | real | size) echo "$2" ;;
    *) echo some-text ;;
    esac
}

check_option() {
    local verb=$1 name=$2 letter=$3 kind=$4 value
    value=$(value_of "$kind" "${5:-}")
    "$seamlab" "$verb" "--$name${value:+=$value}" --help >/dev/null || fail "$verb: --$name is listed and not accepted"
    if [ "$letter" != - ]; then
        # shellcheck disable=SC2086
        "$seamlab" "$verb" "-$letter" $value --help >/dev/null || fail "$verb: -$letter is listed and not accepted"
    fi
    grep -q -- "--$name\b" "$scratch/help" || fail "$verb: --help does not name --$name"
    grep -q -- "--$name\b" "$scratch/man" || fail "$verb: the man page does not name --$name"
    grep -q -- "'\*\?--$name\[" "$scratch/_seamlab" || fail "$verb: zsh does not complete --$name"
}

# Everything that looks like an option in a text is one of the verb's.
check_mentions() {
    local verb=$1 where=$2 option
    for option in $(grep -o -- '--[a-z][a-z-]*[a-z]' "$where" | sort -u); do
        grep -q "^${option#--} " "$scratch/words" || [ "$option" = --help ] || fail "$verb: $option is named in $3 only"
    done
}

"$seamlab" --help=zsh >"$scratch/_seamlab"
"$seamlab" --help=bash >"$scratch/bash"
bash -n "$scratch/bash" || fail "the bash completion is no bash"
for verb in $("$seamlab" --help=words); do
    "$seamlab" "$verb" --help >"$scratch/help" || fail "$verb --help fails"
    "$seamlab" "$verb" --help=man >"$scratch/troff"
    "$seamlab" "$verb" --help=words >"$scratch/words"
    sed 's/\\-/-/g' "$scratch/troff" >"$scratch/man"
    while read -r name letter kind value; do
        check_option "$verb" "$name" "$letter" "$kind" "$value"
    done <"$scratch/words"
    check_mentions "$verb" "$scratch/help" "its help"
    "$seamlab" "$verb" --no-such-option >/dev/null 2>&1
    [ $? = 2 ] || fail "$verb: an unknown option is no usage error"
    "$seamlab" --help | grep -q "^  $verb " || fail "$verb is not in the program's help"
    grep -o "seamlab $verb [^\`|]*" "$root/README.md" >"$scratch/readme"
    check_mentions "$verb" "$scratch/readme" "the README"
    if command -v man >/dev/null; then
        LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l "$scratch/troff" 2>"$scratch/warnings" >/dev/null
        [ ! -s "$scratch/warnings" ] || fail "$verb: $(head -n 2 "$scratch/warnings")"
    fi
done

# The completion at work.
complete_words() {
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    COMPREPLY=()
    _seamlab
    printf '%s ' "${COMPREPLY[@]}"
}
# shellcheck disable=SC1091
. "$scratch/bash"
[ "$(complete_words seamlab unw)" = "unwrap " ] || fail "bash does not complete a verb"
[ "$(complete_words seamlab unwrap --resol)" = "--resolution " ] || fail "bash does not complete an option"
[ "$(complete_words seamlab unwrap --symmetry o)" = "off " ] || fail "bash does not complete a choice"
[ $failed = 0 ] && echo "help, man pages, completion and README agree with the program"
exit $failed
