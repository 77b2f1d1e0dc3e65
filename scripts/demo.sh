#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the demo without a display: a recorded hand writes "GIS" into sand on a passive-stereo wall of 3x4 tiles, which 12
# render ranks draw.
set -euo pipefail
umask g-w,o-w  # only this user may write the files that sessions read
root=$(cd "$(dirname "$0")/.." && pwd)

out="$root/out/demo"
scene=scenes/writing.toml
while [[ $# -gt 0 ]]; do
    case "$1" in
        --out) out=$(realpath -m "${2:?--out needs a folder}"); shift 2 ;;
        --scene) scene=$(realpath -e "${2:?--scene needs a scene file}"); shift 2 ;;
        *) echo "usage: scripts/demo.sh [--scene FILE] [--out DIR]" >&2; exit 2 ;;
    esac
done

cd "$root"
scripts/install_dependencies.sh
[[ -f build/release/build.ninja ]] || echo "configuring the build ..."
[[ -f build/release/build.ninja ]] || cmake --preset release >/dev/null
# Programs and modules alone, without tests and benchmarks.
cmake --build build/release --target sandwall

gl=osmesa
[[ -f build/release/bin/sandwall-gl-osmesa.so ]] || gl=egl # Mesa has no OSMesa any more

mkdir -p "$out"
scripts/figures/make_hand_trace.py "$out/hand.csv"
# The hand writes for 12 s at 60 steps per second. With --pace fast it waits for the wall: on a slow or busy machine a hand in
# real time would be gone before the wall has shown its strokes.
status=0
scripts/sandwall run --wall walls/configs/tiled_3x4.toml --scene "$scene" --gl "$gl" \
    --device "trace:$out/hand.csv" --pace fast --steps 720 --out "$out" || status=$?
echo "pictures and summary: $out (see wall_anaglyph.png first)"
exit "$status"  # that of the session: 1 if its report begins with NOT GOOD
