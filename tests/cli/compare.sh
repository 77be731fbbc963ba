#!/usr/bin/env bash
# seamlab compare: its tables, pictures and refusals; and, where the peers' atlases are at hand, our evaluator against the
# table that another evaluator made of them, digit by digit.
#   tests/cli/compare.sh PATH/TO/seamlab
# The peers' folder holds atlases.csv and uvs/MESH.TOOL.obj.gz: $SEAMLAB_PEERS, else ../shared/peers beside the tree.
set -u
seamlab=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
root=$(cd "$(dirname "$0")/../.." && pwd)
peers=${SEAMLAB_PEERS:-$root/../shared/peers}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
[ ! -d "$peers" ] || peers=$(cd "$peers" && pwd)
cd "$scratch" || exit 1
bad=0

complain() {
    printf '%s\n' "$*"
    bad=1
}

expect() {
    local code=$1 got
    shift
    "$@" >out.txt 2>err.txt </dev/null
    got=$?
    [ $got = "$code" ] || {
        complain "exit $got, not $code: $*"
        cat err.txt
    }
}

contains() {
    grep -q -- "$2" "$1" || complain "$1 does not say '$2': $(head -c 300 "$1")"
}

is_png() { [ -s "$1" ] && head -c 8 "$1" | od -An -tx1 | grep -q '89 50 4e 47 0d 0a 1a 0a'; }

# Two quads of a bent strip: one atlas in one piece, one cut, one stretched to twice its width.
strip='v 0 0 0\nv 1 0 0\nv 2.1 0 0.9\nv 0 1 0\nv 1 1 0\nv 2.1 1 0.9\n'
# shellcheck disable=SC2059
{
    printf "$strip"'vt 0 0\nvt .3 0\nvt .7 0\nvt 0 .3\nvt .3 .3\nvt .7 .3\nf 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\n' >one.obj
    printf "$strip"'vt 0 0\nvt .3 0\nvt .7 0\nvt 0 .3\nvt .3 .3\nvt .7 .3\nvt .3 .5\nvt .7 .5\nvt .3 .8\nvt .7 .8\n' >cut.obj
    printf 'f 1/1 2/2 5/5 4/4\nf 2/7 3/8 6/10 5/9\n' >>cut.obj
    printf "$strip"'vt 0 0\nvt .6 0\nvt 1.4 0\nvt 0 .3\nvt .6 .3\nvt 1.4 .3\nf 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\n' >wide.obj
}
expect 0 "$seamlab" compare one.obj cut.obj late=wide.obj --resolution 256
contains out.txt 'charts .* 1\* .* 2 .* 1\*'
contains out.txt 'seamLen .* 0.000\* .*[1-9] '
contains out.txt 'angMean .* 1.9[0-9]* $'
expect 0 "$seamlab" compare one.obj cut.obj late=wide.obj --resolution 256 --csv
contains out.txt '^name,tri,charts,charts10,seamLen,flip,deg,ovIn,ovX,angMean,ang95,angMax,L2,Linf,areaMean,areaMax,pack,'
contains out.txt '^cut,4,2,2,'
contains out.txt '^late,4,1,1,0.000,'
[ "$(wc -l <out.txt)" = 4 ] || complain "compare --csv: not a line an atlas"
expect 0 "$seamlab" compare one.obj cut.obj --resolution 256 --json
if command -v python3 >/dev/null; then
    python3 -c 'import json; a = json.load(open("out.txt"))["atlases"]; assert [r["charts"] for r in a] == [1, 2]' ||
        complain "compare --json is not what it should be"
fi
expect 0 "$seamlab" compare one.obj cut.obj -o both.png --panel 96 --resolution 64 --threads 1
is_png both.png || complain "no picture"
expect 0 "$seamlab" compare one.obj cut.obj -o again.png --panel 96 --resolution 64 --threads 3
cmp -s both.png again.png || complain "the picture depends on the number of threads"
expect 0 "$seamlab" compare one.obj cut.obj late=wide.obj -o folder --panel 64 --no-shadows --camera back --resolution 64
for name in compare one cut late; do is_png folder/$name.png || complain "no picture of $name"; done
expect 2 "$seamlab" compare
expect 2 "$seamlab" compare one.obj ./one.obj
contains err.txt 'NAME=FILE'
expect 2 "$seamlab" compare one.obj --camera sideways
expect 3 "$seamlab" compare one.obj missing.obj
expect 1 "$seamlab" compare one.obj -o no/folder/x.png --panel 64 --resolution 64
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >bare.obj
expect 3 "$seamlab" compare one.obj bare.obj
contains err.txt 'no UVs'

# --- the peers
if [ ! -r "$peers/atlases.csv" ]; then
    echo "skipped: no $peers/atlases.csv to check the evaluator against"
else
    names=()
    for file in "$peers"/uvs/*.obj.gz; do
        name=$(basename "$file" .obj.gz)
        gunzip -c "$file" >"$name.obj"
        names+=("$name=$name.obj")
    done
    expect 0 "$seamlab" compare "${names[@]}" --csv
    # Ours is MESH.TOOL,tri,...; theirs is TOOL,MESH,rc,user,rssMB,tri,...: columns 2 to 17 against 6 to 21.
    awk -F, -v files=${#names[@]} '
        { sub(/\r$/, "") }
        NR == FNR { if (FNR > 1) for (k = 6; k <= 21; k++) theirs[$2 "." $1, k - 4] = $k; next }
        FNR == 1 { for (k = 2; k <= 17; k++) name[k] = $k; next }
        {
            for (k = 2; k <= 17; k++) {
                checked++
                if ($k != theirs[$1, k]) { print $1 ": " name[k] " is " $k ", the table says " theirs[$1, k]; bad = 1 }
            }
        }
        END { print checked " numbers of " files " atlases checked"; exit bad || checked != 16 * files }' \
        "$peers/atlases.csv" out.txt || complain "our evaluator differs from the peers' table"
fi
exit $bad
