#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the sand at rims, walls, rock faces and holes, and under tools that are held there: one row for each experiment,
# with the largest value that is right. Fails if a value is larger, as it is for a sphere in "slope below a tool that touches it".
# scripts/test.sh does not run it. docs/sand.md
#
#   scripts/checks/borders.sh              Fields of 64 cells a side, less than a minute.
#   scripts/checks/borders.sh --size 256   Fields of 256 cells a side, more than an hour.
#   scripts/checks/borders.sh --size 256 --only 'rim, dry'   The experiments whose names contain this text; --list prints all.
set -euo pipefail
cd "$(dirname "$0")/../.."

[[ -f build/release/build.ninja ]] || cmake --preset release >/dev/null
cmake --build build/release --target sand_borders >/dev/null
exec build/release/bin/sand_borders "$@"
