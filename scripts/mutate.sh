#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that the tests can fail. Plants each bug of tests/mutations, and bugs that are drawn, in a copy of the sources.
# Builds the tests that should see it, and expects them to fail. Prints a table; exits with 1 if a bug survives.
# Takes too long for scripts/test.sh, which does not run it. docs/testing.md
#
# usage: scripts/mutate.sh [FOLDER…|ROW…]        (default: all bugs; --help lists the options)
cd "$(dirname "$0")/.." && exec python3 scripts/checks/mutation/run.py "$@"
