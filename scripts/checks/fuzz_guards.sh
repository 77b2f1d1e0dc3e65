#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Feeds random ticks to the guards of a haptic arm, and runs random haptic servers under a virtual clock. Every force for
# the arm is checked against the bounds of docs/forces.md. The exit status is 1 if a push breaks a bound, or if a replay
# gives other forces.
#
# usage: scripts/checks/fuzz_guards.sh [GATE [LOOP]]     (default: 1000000 sequences of ticks, and 1000 servers)
#
# SANDWALL_SEED chooses the random numbers; without it every run has others. The default takes five minutes of one core
# after the build. Next to builds on two cores it took 18 minutes.
set -euo pipefail
cd "$(dirname "$0")/../.."
gate=${1:-1000000}
loop=${2:-1000}
for number in "$gate" "$loop"; do
    if [[ ! $number =~ ^[1-9][0-9]{0,8}$ ]]; then
        echo "fuzz_guards.sh: $number: must be a whole number from 1 to 999999999" >&2
        exit 2
    fi
done
if [[ ! ${SANDWALL_SEED:-0} =~ ^[0-9]{1,10}$ ]]; then
    echo "fuzz_guards.sh: SANDWALL_SEED: must be a whole number of at most ten digits, got '$SANDWALL_SEED'" >&2
    exit 2
fi
cmake --preset release >/dev/null
cmake --build build/release --parallel "$(nproc)" --target haptic_tests >/dev/null
export SANDWALL_SEED=${SANDWALL_SEED:-$((RANDOM << 15 | RANDOM))}
echo "SANDWALL_SEED=$SANDWALL_SEED"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
SANDWALL_FUZZ_GATE=$gate SANDWALL_FUZZ_LOOP=$loop build/release/bin/haptic_tests \
    --gtest_filter='GateFuzz.*:GuardsFuzz.*:LoopFuzz.*' >"$log" || status=1
if [[ $status == 0 ]]; then
    grep -E '^(gate|guards|loop): |^\[       OK' "$log"
else
    cat "$log"
fi
exit "$status"
