#!/usr/bin/env bash
# seamlab-gen as a user meets it: names, exit codes, files whole or not there, the same bytes.
#   tests/datasets/check_gen.sh PATH/TO/seamlab-gen
set -u
gen=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
bad=0

complain() {
    printf '%s\n' "$*"
    bad=1
}

# expect CODE ARGUMENTS...: runs seamlab-gen, its output in out.txt and err.txt.
expect() {
    local code=$1 got
    shift
    "$gen" "$@" >out.txt 2>err.txt </dev/null
    got=$?
    [ $got = "$code" ] || {
        complain "exit $got, not $code: $*"
        cat err.txt
    }
}

expect 0 --list
models=$(wc -l <out.txt)
[ "$models" -ge 36 ] || complain "only $models models"
expect 0 --list --json
[ "$(grep -c '"name"' out.txt)" = "$models" ] || complain "the lists differ"
expect 0 --help
grep -q '^Examples:' out.txt || complain "no examples in the help"

# usage
expect 2
expect 2 --nonsense
expect 2 crab nobody -o some
grep -q nobody err.txt || complain "the unknown name is not named"
[ ! -e some ] || complain "a folder was made for an unknown name"
expect 2 --all crab
expect 2 crab --scale 0
expect 2 crab --scale 9
expect 2 crab --scale two
expect 2 crab --seed -1
expect 2 crab --seed 18446744073709551616
expect 2 crab -o
touch file
expect 1 crab -o file/sub

# everything, twice: the same bytes
expect 0 --all -o one --seed=18446744073709551615
expect 0 --all -q -o two --seed 18446744073709551615
[ ! -s err.txt ] || complain "-q is not quiet"
[ "$(find one -name '*.obj' | wc -l)" = "$models" ] || complain "not every model has an OBJ file"
[ "$(find one -name '*.json' | wc -l)" = "$models" ] || complain "not every model has a JSON file"
[ "$(find one -type f | wc -l)" = $((2 * models)) ] || complain "more was written than that"
diff -r one two >/dev/null || complain "the same seed gave other bytes"

# another seed changes what is random only; a bigger scale changes all
expect 0 rock torus -o three --json --seed 4
grep -q '"facets"' out.txt || complain "--json says nothing"
cmp -s one/rock.obj three/rock.obj && complain "the rock does not depend on the seed"
cmp -s one/torus.obj three/torus.obj || complain "the torus depends on the seed"
expect 0 torus -o three --scale=2
cmp -s one/torus.obj three/torus.obj && complain "the scale changes nothing"
exit $bad
