# SPDX-License-Identifier: Apache-2.0
"""Checks the tables of the report: whether each is that of the present sources, and whether its smallest N gives the same again."""

import math
import re
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from report.report_data import Table, TableFault
from report.report_measure import state_of
from sessions.measured_session import die_with_parent

LONGEST = 120  # [s], of one part
# Columns that depend on the clock, on the number of runs or on the compiler. All others are compared.
OF_TIME = re.compile(r"(seconds|ms|us|ns|first|again|runs|idle)(_|$)|(wall|master|floor|frame)_|(times_copy|ratio|compiler|flags)$")
# Two numbers are the same if they differ by no more than the last of their six digits.
DIGIT = 1.01e-5


def is_compared(row, column):
    return not OF_TIME.match(column) and not (column == "cost" and row.get("unit") == "us")


def same(a, b):
    if isinstance(a, float) or isinstance(b, float):
        numbers = all(isinstance(value, (int, float)) for value in (a, b))
        return numbers and (math.isclose(a, b, rel_tol=DIGIT, abs_tol=1e-12) or (math.isnan(a) and math.isnan(b)))
    return a == b


def more_rows(old, new):
    """Returns a line for each N of the new table that has more rows in the old one."""
    sizes = new.distinct("N") if "N" in new.columns and "N" in old.columns else []
    counts = ((size, len(old.where(N=size)), len(new.where(N=size))) for size in sizes)
    return [f"{old.path.name}: has {was} rows with N = {size}, and now {now}" for size, was, now in counts if was > now]


def differences(old, new, whole):
    """Returns a line for each row of the new table that the old one does not have.

    `whole`: the new table has all rows of each N that it has, so that the old one must not have more.
    """
    lines = more_rows(old, new) if whole else []
    for place, row in enumerate(new.rows, 1):
        if row.get("kind") == "library":  # of the system
            continue
        columns = [column for column in new.columns if is_compared(row, column)]
        if missing := [column for column in columns if column not in old.columns]:
            return [f"{old.path.name}: has no column {missing[0]}"]
        near = [other for other in old.rows if "N" not in row or other["N"] == row["N"]] or old.rows
        wrong = min(([column for column in columns if not same(other[column], row[column])] for other in near), key=len)
        if wrong:
            closest = next(other for other in near if [column for column in columns if not same(other[column], row[column])] == wrong)
            values = ", ".join(f"{column} is {closest[column]}, and now {row[column]}" for column in wrong[:3])
            what = ", ".join(str(row[column]) for column in columns if column not in wrong)[:80]
            lines.append(f"{old.path.name}: row {place} of the smallest N ({what}): {values}")
    return lines


def again(part, data, quick, root):
    """Measures the smallest N of a part again. Returns what differs, and the time that it took [s]."""
    options = part.check_options(quick)
    if options is None:
        return [], None
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="sandwall-report-") as folder:
        file = Path(folder) / f"{part.name}.csv"
        words = [root / (part.check_program or part.program), *part.words(quick)[1:]]
        words = [*words[:len(words) - len(part.options(quick).split())], *options, "--out", file]
        try:
            ran = subprocess.run([str(word) for word in words], cwd=root, capture_output=True, text=True, errors="replace",
                                 timeout=LONGEST, preexec_fn=die_with_parent, check=False)
            if ran.returncode != 0:
                said = (ran.stderr.strip() or ran.stdout.strip() or "it said nothing").splitlines()[-1][:200]
                return [f"{part.name}.csv: cannot be measured again (status {ran.returncode}: {said})"], None
            return differences(Table(data / f"{part.name}.csv"), Table(file), part.check is None), time.monotonic() - began
        except (OSError, TableFault, subprocess.TimeoutExpired) as error:
            return [f"{part.name}.csv: cannot be measured again ({error})"], None


def check(parts, data, quick, root, cores):
    """Prints a line for each table. Returns the number of tables that are not valid."""
    began, bad = time.monotonic(), 0
    with ThreadPoolExecutor(cores) as pool:
        waiting = []
        for part in parts:
            old = state_of(part, data, quick, root)
            waiting.append((part, old, None if old else pool.submit(again, part, data, quick, root)))
        for part, old, result in waiting:
            lines, took = ([str(old)], None) if old else result.result()
            if lines:
                bad += 1
                print("\n".join(lines[:3] + ([f"… and {len(lines) - 3} further rows"] if len(lines) > 3 else [])), flush=True)
            else:
                measured = f"its smallest N gives the same in {took:.1f} s" if took is not None else "nothing of it can be measured again at once"
                print(f"{part.name}.csv: valid; {measured}", flush=True)
    print(f"{len(parts) - bad} of {len(parts)} tables are valid; checked in {time.monotonic() - began:.0f} s")
    return bad
