#!/usr/bin/env bash
# Installs a build into a scratch folder and builds a program of a user's against it, with pkg-config alone.
set -eu
build=$1
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
DESTDIR=$scratch/root meson install -C "$build" --no-rebuild >/dev/null
prefix=$(find "$scratch/root" -name bin -type d | head -n 1)
prefix=${prefix%/bin}
PKG_CONFIG_PATH=$(dirname "$(find "$scratch/root" -name seamlab.pc)")
PKG_CONFIG_SYSROOT_DIR=$scratch/root
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR
# shellcheck disable=SC2046
cc -std=c17 -Wall -Wextra -Werror "$here/consumer.c" -o "$scratch/consumer" $(pkg-config --cflags --libs seamlab)
LD_LIBRARY_PATH=$(dirname "$(find "$scratch/root" -name 'libseamlab.so' | head -n 1)")
export LD_LIBRARY_PATH
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.4 0.9\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n' >"$scratch/pyramid.obj"
"$scratch/consumer" "$scratch/pyramid.obj" "$scratch/pyramid-uv.obj"
grep -q '^vt ' "$scratch/pyramid-uv.obj"
"$prefix/bin/seamlab" overlap "$scratch/pyramid-uv.obj" --exact
"$prefix/bin/seamlab" --version
