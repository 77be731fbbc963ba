#!/usr/bin/env bash
# Fails on an #include that climbs: a room may include what it stands on (the table in src/meson.build), transitively,
# and itself; private headers (*_internal.h) only their own room.
set -u
src=${1:-$(cd "$(dirname "$0")/../.." && pwd)/src}
awk -v src="$src" '
function allowed(room, other,    i, n, list) {
    if (room == other) return 1
    n = split(below[room], list, " ")
    for (i = 1; i <= n; i++) if (allowed(list[i], other)) return 1
    return 0
}
/^  \[\x27/ {
    line = $0
    gsub(/[^a-z ]/, " ", line)
    n = split(line, word, " ")
    names[++rooms] = word[1]
    for (i = 2; i <= n; i++) below[word[1]] = below[word[1]] " " word[i]
}
END {
    if (rooms < 10) { print "the table of rooms was not found"; exit 1 }
    for (r = 1; r <= rooms; r++) {
        command = "ls " src "/" names[r] "/*.c " src "/" names[r] "/*.h 2>/dev/null"
        while ((command | getline file) > 0) {
            while ((getline line < file) > 0) {
                if (line !~ /^#include "/) continue
                split(line, quoted, "\"")
                split(quoted[2], part, "/")
                if (part[2] == "" || !allowed(names[r], part[1]) ||
                    (quoted[2] ~ /_internal\.h$/ && part[1] != names[r])) {
                    print file ": " line
                    bad = 1
                }
                seen++
            }
            close(file)
        }
        close(command)
    }
    if (seen < 20) { print "hardly any #include was seen: " seen; bad = 1 }
    exit bad
}' "$src/meson.build" || exit 1

# The test must be able to fail: a climbing include in a copy is found.
if [ $# = 0 ]; then
    copy=$(mktemp -d)
    trap 'rm -rf "$copy"' EXIT
    cp -r "$src" "$copy/src"
    printf '#include "mesh/mesh.h"\n' >>"$copy/src/sparse/csc.h"
    if bash "$0" "$copy/src" >/dev/null; then
        echo "a climbing include went unnoticed"
        exit 1
    fi
fi
