#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs missing packages, builds, and runs every test of every build below in one ctest run. Fails if any part fails.
#
# release: all tests, with the sessions over real ranks.
#
# asan-sand: parsers, codecs, kernels and the haptic link under the address, leak and undefined behaviour sanitizers.
#
# golden-clang-O3: only the golden hashes, with another compiler. scripts/goldens.sh tests more levels of optimisation.
#
# The name of a test begins with the name of its build, except in the release build. docs/testing.md
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=$(nproc)
scripts/install_dependencies.sh --with-tests

# Tests start python many hundred times. pyenv's python3 is a script that takes longer than most of theirs, so they get the
# program that it chooses.
PATH=$(dirname "$(python3 -c 'import sys; print(sys.executable)')"):$PATH

# With ccache, a clone in any folder reuses the results of another clone. If the cache does not work, the build runs without
# it.
launcher=()
if command -v ccache >/dev/null; then
    export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
    export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
    trial=$(mktemp -d)
    echo 'int main() {}' >"$trial/trial.cpp"
    if ccache c++ -c "$trial/trial.cpp" -o "$trial/trial.o" >/dev/null 2>&1; then
        # ccache keeps precompiled headers, too. So a clone gets that of another clone, byte by byte, and what was compiled
        # with it.
        launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    else
        echo "test.sh: ccache does not work; building without it" >&2
    fi
    rm -r "$trial"
fi

# Configuring takes one core. So all builds are configured at once.
configured=()
for preset in release asan-sand golden-clang-O3; do
    cmake --preset "$preset" "${launcher[@]}" >/dev/null &
    configured+=($!)
done
for process in "${configured[@]}"; do
    wait "$process"
done

# build PRESET [TARGET...]: builds the targets of PRESET, or all targets if none is given.
build() {
    local preset=$1
    shift
    echo "== building $preset"
    cmake --build "build/$preset" --parallel "$jobs" ${1:+--target "$@"}
}

build release
build asan-sand
build golden-clang-O3 sand_golden_tests

# One list of tests over all builds, so that the last lines count every one of them.
for folder in release asan-sand golden-clang-O3/tests/sand/golden; do
    [[ -f build/$folder/CTestTestfile.cmake ]] || { echo "test.sh: build/$folder holds no tests" >&2; exit 1; }
    echo "subdirs($folder)"
done >build/CTestTestfile.cmake
echo "== testing"
# ctest gets five slots per core. Most tests take two slots, and tests that mostly wait take one (tests/CMakeLists.txt).
ctest --test-dir build --output-on-failure --no-tests=error --parallel $((5 * jobs))
