#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that the tests can fail. Applies each one-line mutation of tests/mutations to a copy of the sources, builds the
# tests that the mutation names, and expects them to fail. Prints a table; exits with 1 if a mutation survives. Takes
# about half an hour on two cores; scripts/test.sh does not run it. docs/testing.md
#
# usage: scripts/mutate.sh [PATCH...]      (default: all mutations)
set -euo pipefail
cd "$(dirname "$0")/.."
(($#)) || set -- tests/mutations/*.patch
copy=build/mutants
mkdir -p "$copy"

# A mutation has these lines before its diff: "# tests: TARGET FILTER", and "# programs: TARGET…" for programs that the
# tests start.
tests_of() { sed -n 's/^# tests: //p' "$1"; }
programs_of() { sed -n 's/^# programs: //p' "$1"; }

build() { cmake --build "$copy/build/release" --parallel "$(nproc)" --target "$@" >"$copy/build.log" 2>&1; }
run() { (cd "$copy" && timeout --kill-after=10 300 "build/release/bin/$1" --gtest_filter="$2" >run.log 2>&1); }
change() { patch --directory "$copy" --strip 1 --fuzz 0 --silent --no-backup-if-mismatch "${@:2}" <"$1"; }

# The copies keep the times of their sources, so that only changed files are built again. A file of the copy that is newer
# than its source was changed by a mutation of a run before: its object files may hold the mutation, so it is touched.
mapfile -t mutated < <(git ls-files | while read -r file; do [[ ! "$copy/$file" -nt "$file" ]] || echo "$copy/$file"; done)
git ls-files -z | xargs -0 cp --parents --preserve=timestamps --target-directory "$copy"
((${#mutated[@]} == 0)) || touch "${mutated[@]}"
# The build is not a unity build, because a mutation changes one file. -O1 compiles in half the time of the release build.
# Warnings are off, because a mutation may leave a name unused.
cmake --preset release -S "$copy" -B "$copy/build/release" -DCMAKE_UNITY_BUILD=OFF \
    -DCMAKE_CXX_FLAGS= -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" >/dev/null
mapfile -t targets < <(for patch in "$@"; do
    tests_of "$patch" | cut -d' ' -f1
    programs_of "$patch" | tr ' ' '\n'
done | sort -u)
echo "== building ${targets[*]}"
build "${targets[@]}" || { tail -n 20 "$copy/build.log" >&2; exit 1; }

echo "== testing without mutations"
for patch in "$@"; do tests_of "$patch"; done | sort -u | while read -r target filter; do
    if ! run "$target" "$filter" || grep -q '^\[  PASSED  \] 0 tests' "$copy/run.log"; then
        echo "mutate.sh: $target --gtest_filter=$filter fails or runs no test without a mutation; mend the tests or the filter first" >&2
        exit 1
    fi
done

echo "== testing with each of $# mutations"
survived=0
for patch in "$@"; do
    read -r target filter < <(tests_of "$patch")
    read -ra programs < <(programs_of "$patch" | tr '\n' ' ') || true
    change "$patch"
    if ! build "$target" "${programs[@]}"; then
        result="does not compile"
        survived=1
    elif run "$target" "$filter"; then
        result="SURVIVED $filter"
        survived=1
    else
        failed=$(sed -n 's/^\[  FAILED  \] \([^ ,]*\).*/\1/p' "$copy/run.log" | head -n 1)
        result="caught by ${failed:-a crash or the time limit of $filter}"
    fi
    printf '%-44s %s\n' "$(basename "$patch" .patch)" "$result"
    change "$patch" --reverse
done
exit $survived
