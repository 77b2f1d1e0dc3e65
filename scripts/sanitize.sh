#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the tests under sanitizers that take too long for scripts/test.sh: a quarter of an hour on two cores. docs/testing.md
#
# usage: scripts/sanitize.sh [asan] [tsan]    (default: both)
#
# asan: tests whole sessions over real ranks, with the address and undefined behaviour sanitizers in every process.
#
# tsan: tests haptic server, link, trackers, worker threads, and the threads of the master for data races: watchdog,
# checkpoints, and the replay that checks a majority.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

# build PRESET TARGET...: configures PRESET and builds the targets.
build() {
    local preset=$1
    shift
    echo "== building $preset"
    cmake --preset "$preset" >/dev/null
    cmake --build "build/$preset" --parallel "$jobs" --target "$@"
}

# tests/cluster/CMakeLists.txt sets ASAN_OPTIONS. Leaks are not detected here; the preset asan-sand detects them.
sessions() {
    build asan cluster_tests
    echo "== sessions with the address and undefined sanitizers"
    export UBSAN_OPTIONS=print_stacktrace=1
    local suites='Lockstep|Recovery|Ending|Drill|Healing|Resuming|Operator|HeadTracking|BadInput|BadLink|ForeignBuild'
    suites+='|WrongServer|Watched|FloatEnvironment|Spread'
    ctest --test-dir build/asan/tests/cluster --output-on-failure --no-tests=error -R "^($suites)\."
}

threads() {
    build tsan base_tests haptic_tests link_tests tracking_tests host_tests lockstep_tests master_tests operator_tests \
        steps_tests summary_tests
    echo "== haptic server, link, trackers, worker threads and the master's threads with the thread sanitizer"
    export TSAN_OPTIONS=halt_on_error=1
    ctest --test-dir build/tsan/tests/base --output-on-failure --no-tests=error
    ctest --test-dir build/tsan/tests/haptic_bridge --output-on-failure --no-tests=error
    ctest --test-dir build/tsan/tests/tracking --output-on-failure --no-tests=error
    ctest --test-dir build/tsan/tests/host --output-on-failure --no-tests=error -R '^WorkerPool$'
    ctest --test-dir build/tsan/tests/lockstep --output-on-failure --no-tests=error -L unit
    ctest --test-dir build/tsan/tests/master --output-on-failure --no-tests=error
}

scripts/install_dependencies.sh --with-tests
[[ $# -gt 0 ]] || set -- asan tsan
for part in "$@"; do
    case $part in
        asan) sessions ;;
        tsan) threads ;;
        *) echo "usage: scripts/sanitize.sh [asan] [tsan]" >&2; exit 2 ;;
    esac
done
