#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares a million sweeps of random worlds bit for bit: the walk over the rows, and sweeps in two passes. Prints the seed, with
# which SANDWALL_SEED repeats a run. Takes a few minutes. scripts/test.sh compares ten thousand sweeps.
#
#   scripts/walk.sh [SWEEPS]
set -euo pipefail
cd "$(dirname "$0")/.."

sweeps=${1:-1000000}
[[ $sweeps =~ ^[1-9][0-9]{0,8}$ ]] || { echo "usage: scripts/walk.sh [SWEEPS], a number up to 999999999" >&2; exit 2; }
[[ -f build/release/build.ninja ]] || cmake --preset release >/dev/null
cmake --build build/release --target sand_tests >/dev/null
export SANDWALL_SEED=${SANDWALL_SEED:-$RANDOM}
echo "seed $SANDWALL_SEED"
SANDWALL_SWEEPS=$sweeps exec build/release/bin/sand_tests --gtest_filter='Walk.*'
