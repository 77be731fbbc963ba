# Sourced by tests/run and experiments/reproduce: packages and builds. Bash.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '\n== %s\n' "$*"; }

# Packages of .ci/packages.txt that are not installed.
missing_packages() {
    grep -v '^#' "$root/.ci/packages.txt" | while read -r package; do
        [ -n "$package" ] || continue
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || printf '%s ' "$package"
    done
}

# Names what is missing and installs it; without the rights to, prints the one line to run and gives up.
install_packages() {
    local missing as_root
    missing=$(missing_packages)
    [ -n "$missing" ] || return 0
    say "missing packages: $missing"
    as_root=
    if [ "$(id -u)" != 0 ]; then
        if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null; then
            printf 'Please run this once, then start again:\n  sudo apt-get update && sudo apt-get install -y --no-install-recommends %s\n' "$missing"
            exit 1
        fi
        as_root=sudo
    fi
    $as_root apt-get update -qq &&
        $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null || {
        printf 'Installing failed. The packages needed: %s\n' "$missing"
        exit 1
    }
}

# build_into FOLDER [meson options]: configures (again, if need be) and builds $build_target (everything where it is not
# set); output only when it fails.
build_into() {
    local folder=$1 log
    shift
    mkdir -p "$folder"
    log=$folder/build.log
    if [ ! -f "$folder/build.ninja" ]; then
        meson setup "$folder" "$root" "$@" >"$log" 2>&1 || { cat "$log"; return 1; }
    fi
    ninja -C "$folder" ${build_target:-} >"$log" 2>&1 || { tail -n 60 "$log"; return 1; }
}

# A build folder outside the tree's view of git: $SEAMLAB_BUILD or build/ in the checkout.
build_root=${SEAMLAB_BUILD:-$root/build}
