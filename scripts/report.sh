#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Measures the sand, draws the curves and writes docs/report: README.md, pictures, and their tables.
#
#   scripts/report.sh           Measures the tables that are missing or old. If it is interrupted, the next call continues.
#   scripts/report.sh --quick   Smaller fields and fewer runs, into out/report.
#   scripts/report.sh --list    Only prints the parts, which of them are to be measured, and the time that they take.
#   scripts/report.sh --check   Measures the smallest N of each table again, and compares errors, sweeps and hashes.
#   scripts/report.sh --draw    Only the pictures and the text, from the tables that exist.
#
# Exit status: 0 if the report is whole. 1 if a part failed, a section is missing, or a table is not valid. 2 for bad input.
# 130 after Ctrl-C.
set -euo pipefail
# Debian's own interpreter, because another python3 may come first in PATH, without Debian's matplotlib.
exec /usr/bin/python3 "$(dirname "$0")/figures/report/report.py" "$@"
