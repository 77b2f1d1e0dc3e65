#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests the golden hashes with both compilers at every level of optimisation. scripts/test.sh tests only clang -O3, its
# release build (g++ -O3), and its sanitizer build (g++ -O1). Takes about four minutes on two cores. docs/testing.md
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh --with-tests
presets=(golden-g++-O{0,1,2} golden-clang-O{0,1,2,3})
for preset in "${presets[@]}"; do
    echo "== building $preset"
    cmake --preset "$preset" >/dev/null
    cmake --build "build/$preset" --parallel "$(nproc)" --target sand_golden_tests
done
mkdir -p build/goldens
printf 'subdirs(../%s/tests/sand/golden)\n' "${presets[@]}" >build/goldens/CTestTestfile.cmake
ctest --test-dir build/goldens --output-on-failure --no-tests=error --parallel "$(nproc)"
