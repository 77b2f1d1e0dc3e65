#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares the walk over the rows of a height field bit for bit with sweeps in two passes: a million sweeps of random worlds
# for each code path of this processor, with 1, 2, 3 and 7 threads. Takes some minutes for each path. scripts/test.sh compares
# ten thousand sweeps for each path.
#
#   scripts/checks/walk.sh [--sweeps N] [--path PATH] [--threads N] [--seed N]
set -euo pipefail
cd "$(dirname "$0")/../.."

[[ -f build/release/build.ninja ]] || cmake --preset release >/dev/null
cmake --build build/release --target sand_walk >/dev/null
exec build/release/bin/sand_walk "$@"
