#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A report of made-up parts, for tests: it runs scripts/figures/report/report.py as scripts/report.sh does.

usage: report_fixture.py ROOT [OPTIONS OF report.sh]

ROOT has a made-up benchmark, bench.py, and what report.py reads of a repository.
"""

import pathlib
import sys

sys.dont_write_bytecode = True
REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(REPOSITORY / "scripts" / folder) for folder in ("figures", "launcher")]
from report import report  # noqa: E402
from report.report_claims import times  # noqa: E402
from report.report_data import markdown  # noqa: E402
from report.report_parts import Part  # noqa: E402
from report.report_text import Section  # noqa: E402

NAMES = ("first", "second", "third", "fourth", "fifth")
# Writes errors that depend on N, and times that differ in each run. The file NAME.does says what a part does: it waits, fails,
# or writes a table that is cut short.
BENCH = """#!/usr/bin/env python3
import pathlib, sys, time
here, name = pathlib.Path(__file__).parent, sys.argv[1]
options = dict(zip(sys.argv[2::2], sys.argv[3::2]))
with (here / "calls").open("a") as calls:
    print(name, options["--sizes"], file=calls)
does = (here / f"{name}.does").read_text() if (here / f"{name}.does").exists() else ""
sizes = [int(size) for size in options["--sizes"].split(",")]
with open(options["--out"], "w") as out:
    print(f"# machine: a made-up one\\n# compiler: none\\n# flags: none\\n# command: bench.py {' '.join(sys.argv[1:])}", file=out)
    print("# date: 2026-01-01T00:00:00Z\\nN,error,hash,runs,ms_median", file=out)
    for size in sizes:
        print(f"{size},{1 / size ** 2:.6g},{size:016x},3,{time.monotonic():.6f}", file=out, flush=True)
        if does == "wait":
            (here / f"{name}.began").touch()
            time.sleep(300)
        if does == "cut":
            out.write(f"{size},0.1")
            break
    if does == "large":
        out.write("# " + "x" * 100000)
if does == "fail":
    print("the made-up part fails", file=sys.stderr)
    sys.exit(3)
"""


def parts():
    return [Part(name, "--sizes 8,16,32", "--sizes 8", (1, 1), f"bench/{name}.cpp", number > 1, "bench.py") for number, name in enumerate(NAMES)]


def text(name):
    def reading(tables):
        table = tables[name]
        first, last = table.rows[0], table.rows[-1]
        return (f"From N = {first['N']} to {last['N']} the error becomes {times(last['error'], first['error'])} as large.\n\n" +
                markdown(["N", "error"], [[row["N"], row["error"]] for row in table.rows]))
    return reading


def make_root(root):
    """Makes the folder of a made-up project."""
    (root / "sand" / "model").mkdir(parents=True)
    (root / "sand" / "model" / "rules.hpp").write_text("inline constexpr std::uint32_t kAlgorithmVersion = 7;\n")
    (root / "CMakeLists.txt").write_text("project(sandwall VERSION 1.2.3 LANGUAGES CXX)\n")
    (root / "bench.py").write_text(BENCH)
    (root / "bench.py").chmod(0o755)
    (root / "bench").mkdir()
    for name in NAMES:
        (root / "bench" / f"{name}.cpp").write_text(f'#include "bench/shared.hpp"\nint {name}();\n')
    (root / "bench" / "shared.hpp").write_text("int shared();  // a comment\n")


if __name__ == "__main__":
    sections = [Section(name.title(), None, [name], text(name)) for name in NAMES]
    sys.exit(report.run(sys.argv[2:], parts(), sections, lambda waiting, programs: None, pathlib.Path(sys.argv[1])))
