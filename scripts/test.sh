#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs every test of every build below in one ctest run; fails if any part fails.
#
#   release      everything: all tests, the sessions over real ranks among them
#   asan-sand    sand, files, pictures, walls, head tracking and the haptic link under the address, leak and undefined sanitizers
#   clang-sand   the sand's tests with clang at -O3
#   golden-*     the golden hashes alone, with further compilers and levels of optimisation
#
# A test of any build but release has the build's name before its own.
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)

# build PRESET [TARGET...]: everything without a target.
build() {
    local preset=$1
    shift
    echo "== building $preset"
    cmake --preset "$preset" >/dev/null
    cmake --build "build/$preset" --parallel "$jobs" ${1:+--target "$@"}
}

scripts/install_dependencies.sh --with-tests
build release
build asan-sand
build clang-sand sand_tests sand_golden_tests tin_tests
for variant in g++-O0 g++-O2 clang-O0; do
    build "golden-$variant" sand_golden_tests
done

# One list of tests over all builds, so that the last lines count every one of them.
folders=(release asan-sand clang-sand/tests/sand golden-{g++-O0,g++-O2,clang-O0}/tests/sand/golden)
for folder in "${folders[@]}"; do
    [[ -f build/$folder/CTestTestfile.cmake ]] || { echo "test.sh: build/$folder holds no tests" >&2; exit 1; }
    echo "subdirs($folder)"
done >build/CTestTestfile.cmake
echo "== testing"
# Most tests take two of these places, those that only wait take one (tests/CMakeLists.txt).
ctest --test-dir build --output-on-failure --no-tests=error --parallel 4
