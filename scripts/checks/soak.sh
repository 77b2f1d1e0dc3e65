#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a million random edits with a hash at every step, in two ways whose hashes must be equal. Then runs 20 edits of the
# largest field, 16384 x 16384 cells, in two ways. Takes hours on a busy machine, and 7.6 GiB of memory. scripts/test.sh does
# not run it.
set -euo pipefail
cd "$(dirname "$0")/../.."

edits=1000000
largest=yes
while [[ $# -gt 0 ]]; do
    case "$1" in
        --edits) edits=${2:?--edits needs a number}; shift 2 ;;
        --no-largest) largest=no; shift ;;
        *) echo "usage: scripts/checks/soak.sh [--edits N] [--no-largest]" >&2; exit 2 ;;
    esac
done

scripts/install_dependencies.sh --with-tests
[[ -f build/release/build.ninja ]] || cmake --preset release >/dev/null
cmake --build build/release --target sand_soak
soak=build/release/bin/sand_soak

one=$("$soak" --edits "$edits" --threads 1 --block 64)
other=$("$soak" --edits "$edits" --threads 3 --block 16 --path baseline)
echo "$edits edits, 1 thread,  blocks of 64, fastest code path:  $one"
echo "$edits edits, 3 threads, blocks of 16, baseline code path: $other"
[[ $one == "$other" ]] || { echo "soak.sh: the hashes differ" >&2; exit 1; }

if [[ $largest == yes ]]; then
    one=$("$soak" --edits 20 --columns 16384 --rows 16384 --threads 1 --block 64)
    other=$("$soak" --edits 20 --columns 16384 --rows 16384 --threads 2 --block 32)
    echo "16384 x 16384 cells, 20 edits: $one and $other"
    [[ $one == "$other" ]] || { echo "soak.sh: the hashes differ" >&2; exit 1; }
fi
