#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds without OSMesa, as on a system with Mesa 25.1 or later. Then runs the golden pictures and the emulated cluster by EGL's
# software device, and compares the pictures of the cluster with those that OSMesa draws. docs/backends.md
set -euo pipefail
[[ $# -eq 0 ]] || { echo "usage: scripts/checks/no_osmesa.sh" >&2; exit 2; }
cd "$(dirname "$0")/../.."
build=build/no-osmesa out=$PWD/out/no_osmesa
targets=(sandwall render_node_tests)

cmake --preset release -B "$build" -DSANDWALL_OSMESA=OFF >/dev/null
cmake --build "$build" --parallel "$(nproc)" --target "${targets[@]}"
[[ ! -e $build/bin/sandwall-gl-osmesa.so ]] || { echo "no_osmesa.sh: $build has the backend osmesa" >&2; exit 1; }
[[ -e build/release/bin/sandwall-gl-osmesa.so ]] || cmake --preset release >/dev/null
cmake --build build/release --parallel "$(nproc)" --target sandwall

echo "== golden pictures"
"$build/bin/render_node_tests" --gtest_brief=1 --gtest_filter='Golden*:Picture*:*Seam*'

# session NAME BIN: runs the emulated cluster with the programs in BIN, and prints the hash.
session() {
    rm -rf "${out:?}/$1"
    mkdir -p "$out"
    SANDWALL_BIN=$2 scripts/checks/emulate_cluster.sh --out "$out/$1" --hosts 4 -- --device script:gis --pace fast --steps 60 >"$out/$1.log" 2>&1 ||
        { tail -n 20 "$out/$1.log" >&2; exit 1; }
    python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["state_hash"])' "$out/$1/summary.json"
}
echo "== the emulated cluster"
osmesa=$(session osmesa "$PWD/build/release/bin")
egl=$(session egl "$PWD/$build/bin")
grep -q '"renderer": ".*llvmpipe' "$out/egl/summary.json" || { echo "no_osmesa.sh: no rank drew with llvmpipe" >&2; exit 1; }
[[ $osmesa == "$egl" ]] || { echo "no_osmesa.sh: the hash is $egl by EGL, and $osmesa by OSMesa" >&2; exit 1; }

failed=0 compared=0
for picture in "$out"/osmesa/*.png; do
    name=${picture##*/}
    result=$(build/release/bin/sandwall-compare "$picture" "$out/egl/$name") || failed=$((failed + 1))
    echo "$name: ${result//$'\n'/, }"
    compared=$((compared + 1))
done
[[ $compared -gt 0 ]] || { echo "no_osmesa.sh: there are no pictures in $out/osmesa" >&2; exit 1; }
echo "hash $egl by both; $compared pictures compared, $failed differ"
[[ $failed -eq 0 ]]
