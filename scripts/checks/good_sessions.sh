#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs sessions that must be good, prints the report of each, and fails if one has a BAD line: the demo's session, the first
# session of the README, and a short one on each sample wall. Takes some minutes. docs/testing.md
#
# usage: scripts/checks/good_sessions.sh [--out DIR] [--steps N]      (N: steps on each sample wall, default 60)
set -uo pipefail
umask g-w,o-w  # only this user may write the files that sessions read
root=$(cd "$(dirname "$0")/../.." && pwd)
out="$root/out/good" steps=60
while [[ $# -gt 0 ]]; do
    case "$1" in
        --out) out=$(realpath -m "${2:?--out needs a folder}"); shift 2 ;;
        --steps) steps=${2:?--steps needs a number}; shift 2 ;;
        *) echo "usage: scripts/checks/good_sessions.sh [--out DIR] [--steps N]" >&2; exit 2 ;;
    esac
done
[[ $steps =~ ^[1-9][0-9]{0,6}$ ]] || { echo "good_sessions.sh: --steps $steps: must be a whole number, 1 or more" >&2; exit 2; }
cd "$root"
mkdir -p "$out"
failed=() gl=osmesa
[[ -f build/release/bin/sandwall-gl-osmesa.so ]] || gl=egl

# session NAME OPTIONS...: runs a session and prints its report.
session() {
    local name=$1 status=0
    shift
    echo "== $name"
    scripts/sandwall run --here --gl "$gl" --no-pictures --out "$out/$name" "$@" >"$out/$name.txt" 2>"$out/$name.err" </dev/null || status=$?
    grep -E '^([^ ].*: (good|NOT GOOD)|  (ok  |note|BAD |--  )  )' "$out/$name.txt"
    if [[ $status -ne 0 ]] || grep -q '^  BAD ' "$out/$name.txt"; then
        tail -n 5 "$out/$name.err"
        failed+=("$name (status $status)")
    fi
}

scripts/figures/make_hand_trace.py "$out/hand.csv" >"$out/hand.txt"
session demo --wall walls/configs/tiled_3x4.toml --scene scenes/writing.toml --device "trace:$out/hand.csv" --pace fast --steps 720
session readme --wall walls/configs/desktop.toml --scene scenes/dunes.toml --device script:gis --steps 240
for wall in walls/configs/*.toml; do
    session "$(basename "$wall" .toml)" --wall "$wall" --scene scenes/sandbox.toml --device script:gis --pace fast --steps "$steps" --frame-timeout 120
done
if [[ ${#failed[@]} -gt 0 ]]; then
    printf 'good_sessions.sh: not good: %s\n' "${failed[@]}" >&2
    exit 1
fi
echo "no session has a BAD line"
