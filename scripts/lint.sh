#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks the English of the text with scripts/plain_english.py, the format with clang-format 14 and the code with clang-tidy
# 14. All sources take half an hour on two cores. With FILE.cpp, the English and the code of only those files are checked.
# Needs clang-format-14 and clang-tidy-14.
#
# usage: scripts/lint.sh [FILE.cpp...]   (paths from the root of the repository)
set -euo pipefail
# The paths of the build's commands have no link, so that the patterns below match them.
cd -P "$(dirname "$0")/.."
here=$(python3 -c 'import os, re; print(re.escape(os.getcwd()))')

# Matches every compiled source outside build/. tests/scripts/checks/lint_test.py compares them with the folders.
every_source="^$here/(?!build/)"
selected=()
for file in "$@"; do
    [[ $file == *.cpp && -f $file ]] || { echo "lint.sh: $file: is not a .cpp file of the repository; usage: scripts/lint.sh [FILE.cpp...]" >&2; exit 2; }
    selected+=("^$here/$file\$")
done
# The check of the English takes seconds. If it fails, the other checks still run, and the script ends with its status.
english=0
scripts/plain_english.py "$@" || english=$?

scripts/install_dependencies.sh --with-tests

git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format-14 --dry-run -Werror

# clang-tidy needs the commands by which clang would build each file. They must not use precompiled headers, which only a
# build makes. Some files include generated headers, so glad is built.
cmake --preset clang -B build/lint -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
cmake --build build/lint --parallel "$(nproc)" --target glad
# A quarter of the analyser's default depth halves the time.
depth=(-extra-arg=-Xclang -extra-arg=-analyzer-config -extra-arg=-Xclang -extra-arg=max-nodes=60000)
run-clang-tidy-14 -quiet -j "$(nproc)" -p build/lint "${depth[@]}" "${selected[@]:-$every_source}"
echo "format and code: no findings"
exit "$english"
