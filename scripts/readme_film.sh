#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the film in README.md, docs/images/dig.gif: a hand writes "sand" on a wall of 3x4 tiles. Takes a few minutes.
# Needs ffmpeg. Wall, scene and hand are the three files in scripts/figures/readme_film.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

out="$root/out/readme_film"
while [[ $# -gt 0 ]]; do
    case "$1" in
        --out) out=$(realpath -m "${2:?--out needs a folder}"); shift 2 ;;
        *) echo "usage: scripts/readme_film.sh [--out DIR]" >&2; exit 2 ;;
    esac
done
command -v ffmpeg >/dev/null || { echo "readme_film.sh: ffmpeg is missing; run scripts/install_dependencies.sh --with-film" >&2; exit 2; }

cd "$root"
scripts/install_dependencies.sh
[[ -f build/release/build.ninja ]] || cmake --preset release >/dev/null
cmake --build build/release --target sandwall

# One rank records the hand; twelve ranks show the recording again. A fast session keeps every step on a busy machine.
parts=scripts/figures/readme_film
scripts/sandwall run --wall walls/configs/desktop.toml --scene $parts/scene.toml --device script:$parts/hand.strokes \
    --gl osmesa --pace fast --steps 350 --no-pictures --out "$out/session"
scripts/sandwall film "$out/session/session.journal" --wall $parts/wall.toml --fps 25 --out "$out/film"

# 175 pictures are seven seconds. The last ten fade into the first picture, so that the film loops without a jump.
# Without dithering, sand that rests has the same pixels in every picture and takes no bytes.
graph="[0]scale=880:-2:flags=area[film];[1]scale=880:-2:flags=area[first]"
graph+=";[film][first]xfade=duration=0.4:offset=6.6,split[colours][pictures]"
graph+=";[colours]palettegen[palette];[pictures][palette]paletteuse=dither=none:diff_mode=rectangle"
# ffmpeg runs in the folder of the pictures, because a per cent sign in its path would be read as a number.
(cd "$out/film" && ffmpeg -y -loglevel error -framerate 25 -i frame_%06d.png -framerate 25 -loop 1 -t 0.4 \
    -i frame_000001.png -filter_complex "$graph" "$root/docs/images/dig.gif")
echo "docs/images/dig.gif: $(stat -c %s docs/images/dig.gif) bytes"
