#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the English of the text (scripts/plain_english.py), the format (clang-format 14) and the habits (clang-tidy 14).
# All sources take an hour on two cores; with FILE.cpp only the English and the habits of those files are checked. Needs
# clang-format-14 and clang-tidy-14.
#
# usage: scripts/lint.sh [FILE.cpp...]   (paths from the root of the repository)
set -euo pipefail
cd "$(dirname "$0")/.."

# Every compiled source outside build/; tests/scripts/lint_test.py compares them with the folders.
every_source="^$PWD/(?!build/)"
selected=()
for file in "$@"; do
    [[ $file == *.cpp && -f $file ]] || { echo "lint.sh: $file: no source of the repository; usage: scripts/lint.sh [FILE.cpp...]" >&2; exit 2; }
    selected+=("^$PWD/$file\$")
done
# The English takes seconds. A failure is the exit status of the script, after the other checks.
english=0
scripts/plain_english.py "$@" || english=$?

scripts/install_dependencies.sh --with-tests

git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format-14 --dry-run -Werror

# clang-tidy reads how clang would build each file, without the headers that only a build has precompiled; some files
# include generated ones.
cmake --preset clang -B build/lint -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
cmake --build build/lint --parallel "$(nproc)" --target glad
# The analyser looks a quarter as far into each function as it does by itself, which halves the time.
depth=(-extra-arg=-Xclang -extra-arg=-analyzer-config -extra-arg=-Xclang -extra-arg=max-nodes=60000)
run-clang-tidy-14 -quiet -j "$(nproc)" -p build/lint "${depth[@]}" "${selected[@]:-$every_source}"
echo "format and habits: nothing to complain about"
exit "$english"
