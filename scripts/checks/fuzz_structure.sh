#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Changes numbers in states and journals of small sessions, makes their checksums right, and lets replicas read them, under
# the address and undefined sanitizers. What is accepted must keep its volume in every step. The exit status is 1 if it does
# not, or if a program fails.
#
# usage: scripts/checks/fuzz_structure.sh [STATES [JOURNALS [FIRST]]]     (default: 700000 states and 300000 journals from 0 on)
#
# An input depends on SANDWALL_SEED and on its number alone. So FIRST continues a run, and several runs can share the work.
set -euo pipefail
cd "$(dirname "$0")/../.."
states=${1:-700000}
journals=${2:-300000}
first=${3:-0}
for number in "$states" "$journals" "$first"; do
    if [[ ! $number =~ ^(0|[1-9][0-9]{0,11})$ ]]; then
        echo "fuzz_structure.sh: $number: must be a whole number of at most 12 digits" >&2
        exit 2
    fi
done
if [[ ! ${SANDWALL_SEED:-0} =~ ^[0-9]{1,9}$ ]]; then
    echo "fuzz_structure.sh: SANDWALL_SEED: must be a whole number of at most nine digits, got '$SANDWALL_SEED'" >&2
    exit 2
fi
[[ -f build/asan-sand/build.ninja ]] || cmake --preset asan-sand >/dev/null
cmake --build build/asan-sand --parallel "$(nproc)" --target structure_tests >/dev/null
status=0
run() {
    [[ $2 == 0 ]] && return
    local log
    log=$(mktemp)
    SANDWALL_FUZZ_FIRST=$first SANDWALL_FUZZ_COUNT=$2 build/asan-sand/bin/structure_tests --gtest_filter="StructureFuzz.$1" \
        >"$log" 2>&1 || status=1
    if ! grep -E '^(states|journals): ' "$log" || [[ $status == 1 ]]; then
        status=1
        cat "$log"
    fi
    rm -f "$log"
}
run AnAcceptedStateKeepsItsSand "$states"
run AnAcceptedJournalKeepsItsSand "$journals"
exit "$status"
