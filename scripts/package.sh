#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes a Debian package of the release build, and prints its path. Builds only what a session needs. docs/install.md
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build/release
usage="usage: scripts/package.sh [--out DIR] [--build DIR]   (default: out/package, build/release)"

out=$root/out/package
while [[ $# -gt 0 ]]; do
    case "$1" in
        --out) out=$(realpath -m "${2:?--out needs a folder}"); shift 2 ;;
        --build) build=$(realpath -m "${2:?--build needs a folder}"); shift 2 ;;
        *) echo "$usage" >&2; exit 2 ;;
    esac
done

refuse() { echo "package.sh: $1" >&2; exit 2; }
# A file shows whether the folder can be written: `test -w` is always true for root.
mkdir -p "$out" 2>/dev/null && trial=$(mktemp "$out/trial.XXXXXX" 2>/dev/null) || refuse "$out: cannot be written; choose another --out"
rm "$trial"
for program in cpack help2man dpkg-shlibdeps file strip; do
    command -v "$program" >/dev/null || refuse "$program: not found; run scripts/install_dependencies.sh --with-tests"
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{ [[ -f $build/CPackConfig.cmake ]] || (cd "$root" && cmake --preset release); } >"$work/log" 2>&1 &&
    cmake --build "$build" --target sandwall >>"$work/log" 2>&1 || { tail -n 60 "$work/log" >&2; exit 1; }
(cd "$work" && umask 022 && cpack --config "$build/CPackConfig.cmake" -B "$work") \
    >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
for package in "$work"/*.deb; do
    mv "$package" "$out/"
    echo "$out/${package##*/}"
done
