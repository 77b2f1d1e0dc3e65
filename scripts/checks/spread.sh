#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares whole steps of a height field with the same steps in parts of 1, 7, 16 and 64 sweeps, in random sessions with all
# tools and edits. Heights, outflow, fluxes and age must be equal. A thousand sessions take some minutes. scripts/test.sh
# compares ten.
#
#   scripts/checks/spread.sh [--sessions N] [--steps N] [--seed N]
set -euo pipefail
cd "$(dirname "$0")/../.."

[[ -f build/release/build.ninja ]] || cmake --preset release >/dev/null
cmake --build build/release --target sand_spread >/dev/null
exec build/release/bin/sand_spread "$@"
