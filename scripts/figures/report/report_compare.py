#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the figures of two reports beside each other, where they differ by more than their spread, as a table in Markdown.

Rows of the same keys are compared. Errors, sweeps and hashes differ if they are not the same. A time differs if the ranges
from the least to the most do not meet; a time without such a range is not compared.

usage: scripts/figures/report/report_compare.py DATA DATA
"""

import pathlib
import sys

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / room) for room in ("figures", "launcher")]
from base.command_line import Parser
from report.report_check import is_compared, same
from report.report_data import TableFault, keys_of, markdown
from report.report_page import read_tables


def ranges_meet(a, b, column):
    """Returns whether the ranges of a median meet in two rows. Returns True if there is no range."""
    least, most = (column.replace("_median", end) for end in ("_min", "_max"))
    return least not in a or least not in b or (a[least] <= b[most] and b[least] <= a[most])


def differences(name, old, new):
    """Yields rows of the printed table: table, keys, column, old value, new value."""
    keys = keys_of(name, old.columns)
    known = {tuple(row[key] for key in keys): row for row in old.rows}
    for row in new.rows:
        before = known.get(tuple(row.get(key) for key in keys))
        if before is None:
            continue
        for column in new.columns:
            if column in keys or column not in before:
                continue
            differs = not same(before[column], row[column]) if is_compared(row, column) else (
                column.endswith("_median") and not ranges_meet(before, row, column))
            if differs:
                yield [name, ", ".join(str(row[key]) for key in keys), column, before[column], row[column]]


def main():
    parser = Parser(prog="report_compare.py", description=__doc__.splitlines()[0])
    parser.add_argument("old", type=pathlib.Path, metavar="DATA", help="folder of tables")
    parser.add_argument("new", type=pathlib.Path, metavar="DATA", help="folder of other tables")
    args = parser.parse_args()
    for folder in (args.old, args.new):
        if not folder.is_dir():
            parser.error(f"{folder} is not a folder")
    (old, _), (new, faults) = read_tables(args.old), read_tables(args.new)
    try:
        rows = [line for name in new if name in old for line in differences(name, old[name], new[name])]
    except (TableFault, TypeError) as fault:
        parser.error(f"the tables cannot be compared ({fault})")
    for fault in faults.values():
        print(f"report_compare.py: {fault}", file=sys.stderr)
    print(markdown(["table", "row", "column", str(args.old), str(args.new)], rows) if rows else "no figure differs by more than its spread")
    return 0


if __name__ == "__main__":
    sys.exit(main())
