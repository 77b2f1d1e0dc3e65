#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs libFuzzer on all code that reads bytes from outside, under the address and undefined behaviour sanitizers. Then
# feeds changed files to the launcher, which is written in Python.
#
# usage: scripts/fuzz.sh [SECONDS [NAME...]]     (default: 600 seconds for each fuzzer of tests/fuzz, and for launcher)
#
# Inputs that reach new code are kept in build/fuzz/corpus/NAME for the next run. An input that causes a failure is kept
# there too, named crash-..., oom-..., timeout-... or leak-...; the exit status is then 1.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-600}
shift || true
launcher=
names=()
for name in "$@"; do
    if [[ $name == launcher ]]; then launcher=1; else names+=("$name"); fi
done
if [[ $# -eq 0 ]]; then
    launcher=1
    for source in tests/fuzz/*_fuzz.cpp; do
        names+=("$(basename "$source" _fuzz.cpp)")
    done
fi

corpus=build/fuzz/corpus
mkdir -p "$corpus"
if [[ ${#names[@]} -gt 0 ]]; then
    scripts/install_dependencies.sh --with-tests
    cmake --preset fuzz >/dev/null
    cmake --build build/fuzz --parallel "$(nproc)" --target fuzz_seeds "${names[@]/#/fuzz_}" >/dev/null
    build/fuzz/bin/fuzz_seeds "$corpus/written"
fi
status=0
echo "| fuzzer | seconds | executions | corpus | findings |"
echo "|---|---|---|---|---|"
for name in "${names[@]}"; do
    mkdir -p "$corpus/$name"
    seeds=()
    for folder in "$corpus/written/$name" "tests/fuzz/corpus/$name"; do
        [[ -d $folder ]] && seeds+=("$folder")
    done
    [[ $name == wall ]] && seeds+=(walls/configs tests/walls/broken)
    log=$corpus/$name.log
    limits=()
    # GDAL's libraries reserve memory by numbers in a header. Only memory that is used counts here.
    [[ $name == raster || $name == png ]] && limits=(-malloc_limit_mb=1048576)
    # An input with the largest tool on the longest step takes 5 s on an idle machine, and much more on a busy one.
    build/fuzz/bin/"fuzz_$name" -max_total_time="$seconds" -rss_limit_mb=4096 -timeout=120 -max_len=8192 "${limits[@]}" \
        -print_final_stats=1 -artifact_prefix="$corpus/$name/" "$corpus/$name" "${seeds[@]}" 2>"$log" || true
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    findings=$(find "$corpus/$name" -name 'crash-*' -o -name 'oom-*' -o -name 'timeout-*' -o -name 'leak-*' | wc -l)
    inputs=$(find "$corpus/$name" -type f | wc -l)
    echo "| $name | $seconds | ${executions:-?} | $((inputs - findings)) | $findings |"
    if [[ $findings -gt 0 || -z $executions ]]; then
        status=1
        grep -m 5 -E 'ERROR|runtime error|what\(\)|SUMMARY' "$log" >&2 || tail -n 5 "$log" >&2
    fi
done
if [[ -n $launcher ]]; then
    log=$corpus/launcher.log
    findings=0
    SANDWALL_SEED=$(date +%s) python3 tests/scripts/launcher/launcher_fuzz_test.py "$seconds" >"$log" || findings=$(grep -c '^SANDWALL_SEED' "$log" || true)
    executions=$(sed -n 's/^.*: \([0-9]*\) inputs;.*/\1/p' "$log" | awk '{ sum += $1 } END { print sum }')
    echo "| launcher | $seconds | ${executions:-?} | | $findings |"
    if [[ $findings -gt 0 || -z $executions ]]; then
        status=1
        cat "$log" >&2
    fi
fi
exit $status
