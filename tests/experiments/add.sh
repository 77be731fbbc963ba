#!/usr/bin/env bash
# What experiments/reproduce refuses, at once and in words: exit 2 before anything is installed, built or run.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
wrong=0
touch "$scratch/empty.obj"
echo 'v 0 0 0' >"$scratch/uv.obj"

# refused WORDS ARGUMENT...
refused() {
    local words=$1 said code
    shift
    said=$("$root/experiments/reproduce" --out "$scratch/out" "$@" 2>&1)
    code=$?
    if [ $code != 2 ] || ! grep -qF -- "$words" <<<"$said" || [ -e "$scratch/out/index.html" ]; then
        echo "wrong: reproduce $*: exit $code: $said"
        wrong=1
    fi
}

refused '--add wants NAME=FILE' --add
refused '--add wants NAME=FILE' --add "$scratch/uv.obj"
refused '--add wants NAME=FILE' --add "=$scratch/uv.obj"
refused '--add wants NAME=FILE' --add tool=
refused '--add wants NAME=FILE' --add "a tool=$scratch/uv.obj"
refused '--add wants NAME=FILE' --add "../tool=$scratch/uv.obj"
refused 'cannot be read' --add "tool=$scratch/nowhere.obj"
refused 'cannot be read' --add "tool=$scratch/empty.obj"
refused 'cannot be read' --add "tool=$scratch"
refused 'cannot be read' --quick --add "tool=$scratch/uv.obj" --add "other=$scratch/nowhere.obj" companion
refused 'there is no experiment' --add "tool=$scratch/uv.obj" nonesuch
refused 'experiments/reproduce' --nonesuch
exit $wrong
