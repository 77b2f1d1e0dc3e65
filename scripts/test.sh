#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing, builds, and runs every test.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_dependencies.sh --with-tests
cmake --preset release >/dev/null
cmake --build build/release
ctest --test-dir build/release --output-on-failure -j 2
