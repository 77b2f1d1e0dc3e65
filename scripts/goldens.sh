#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The golden hashes with both compilers at every level of optimisation; scripts/test.sh has time for two of these builds.
# Takes about ten minutes on two cores. docs/testing.md
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh --with-tests
mkdir -p build/goldens
presets=(golden-{g++,clang}-O{0,1,2,3})
for preset in "${presets[@]}"; do
    echo "== building $preset"
    cmake --preset "$preset" >/dev/null
    cmake --build "build/$preset" --parallel "$(nproc)" --target sand_golden_tests
    echo "subdirs(../$preset/tests/sand/golden)"
done | tee build/goldens/log
grep '^subdirs' build/goldens/log >build/goldens/CTestTestfile.cmake
ctest --test-dir build/goldens --output-on-failure --no-tests=error --parallel "$(nproc)"
