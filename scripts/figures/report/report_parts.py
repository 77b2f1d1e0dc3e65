# SPDX-License-Identifier: Apache-2.0
"""The parts of the report: which command measures each table, and whether a table is that of the present sources."""

import hashlib
import pathlib
import re
from dataclasses import dataclass
from typing import Optional

ROOT = pathlib.Path(__file__).resolve().parents[3]
RELEASE = "build/release/bin"
PRESETS = ("release", "golden-clang-O3", "golden-g++-O0", "golden-g++-O2", "golden-clang-O0")  # builds whose hashes are compared
# Comments of a script, and the lines that say where files are.
PLACES = r"^(?:\s*#[^\n]*|(?:from|import) (?:[^\n(]*\([^)]*\)|[^\n]*)|sys\.path[^\n]*|[^\n]*__file__[^\n]*)?\n"


@dataclass
class Part:
    """One table, and the command that measures it."""
    name: str  # of the table, and of the subcommand unless `command` is another
    full: str  # options of the full report
    quick: Optional[str]  # options of the quick report; None: not in it
    seconds: tuple  # expected time of the full report and of the quick one [s]; a table's head has the measured one
    source: str  # file that measures
    timed: bool = True  # measures times, so that nothing may run beside it
    program: str = f"{RELEASE}/sandwall-bench"
    command: Optional[str] = None  # subcommand; "": none
    check: Optional[str] = None  # options that measure the smallest N again; None: derived from the options; "": it has only times
    check_program: Optional[str] = None  # program for that; None: `program`

    def options(self, quick):
        return self.quick if quick else self.full

    def words(self, quick, program=None):
        """Returns the command that the table's head must have, as report.sh runs it without --out."""
        subcommand = self.name if self.command is None else self.command
        return [program or pathlib.PurePath(self.program).name, *subcommand.split(), *self.options(quick).split()]

    def check_options(self, quick):
        """Returns the options that measure the smallest N of the table once, or None."""
        if self.check is not None:
            return self.check.split() or None
        options = re.sub(r"(--sizes \d+)[\d,]*", r"\1", self.options(quick))
        return re.sub(r"--runs \d+", "--runs 1", options).split()


def hash_parts():
    for preset in PRESETS:
        quick = "--sizes 64" if preset == "release" else None
        yield Part(f"hashes-{preset}", "--sizes 64", quick, (20, 20), "bench/sand/hashes.cpp", False,
                   f"build/{preset}/bin/sandwall-bench", "hashes", check_program=f"{RELEASE}/sandwall-bench")


SAND, TIN, FORCE = "bench/sand", "bench/tin", "bench/force"
PARTS = [
    Part("error-at-rest", "--sizes 32,64,128,256,512,1024", "--sizes 32,64,128", (200, 3), f"{SAND}/rest_curves.cpp", False),
    Part("sweeps", "--sizes 32,64,128,256,512", "--sizes 32,64,128", (100, 3), f"{SAND}/rest_curves.cpp", False),
    Part("anisotropy", "--sizes 64,256", "--sizes 64,128", (20, 2), f"{SAND}/rest_curves.cpp", False),
    Part("decay", "--sizes 128", "--sizes 64", (5, 1), f"{SAND}/rest_curves.cpp", False),
    Part("height-bits", "--sizes 32,64,128", "--sizes 32,64", (5, 1), f"{SAND}/unit_curves.cpp", False),
    Part("band", "--sizes 128", "--sizes 64", (10, 1), f"{SAND}/unit_curves.cpp", False),
    Part("mass-drift", "--sizes 128", "--sizes 64", (10, 2), f"{SAND}/mass_drift.cpp", False),
    Part("certificate", "--sizes 32,64,128,256", "--sizes 32,64", (120, 2), f"{SAND}/certificate.cpp", False),
    Part("budget", "--sizes 64,128,256", "--sizes 64", (15, 1), f"{SAND}/unit_curves.cpp", False),
    Part("stability", "--runs 10", "--runs 1", (10, 2), f"{SAND}/stability.cpp", False, check="--runs 1"),
    Part("guarded-sweep", "--runs 10", "--runs 1", (100, 2), f"{SAND}/stability.cpp", False, check="--rows touch/0/0.5 --runs 10"),
    Part("extremes", "--runs 1", "--runs 1", (2, 2), f"{SAND}/extremes.cpp", False),
    Part("force-work", "--sizes 256", "--sizes 256", (2, 2), f"{FORCE}/force_work.cpp", False),
    *hash_parts(),
    Part("work-precision", "--sizes 16,32,64,128,256,512 --runs 10", "--sizes 16,32,64,128 --runs 3", (450, 20), f"{SAND}/work_precision.cpp"),
    Part("edit", "--sizes 512,1024,2048 --runs 10", "--sizes 512,2048 --runs 3", (20, 5), f"{SAND}/edit.cpp"),
    Part("held-tools", "--sizes 96", "--sizes 96", (6, 6), f"{SAND}/held_tools.cpp", check="--sizes 96"),
    Part("dig", "--sizes 256,512,2048 --runs 10", "--sizes 256,512 --runs 1", (1500, 120), f"{SAND}/dig.cpp"),
    Part("large-tools", "--sizes 512,1024,2048,4096", "--sizes 512", (2400, 240), f"{SAND}/large_tools.cpp"),
    Part("throughput", "--sizes 64,128,256,512,1024,2048,4096 --runs 10", "--sizes 64,256,1024 --runs 5", (120, 10), f"{SAND}/throughput.cpp"),
    Part("force-rate", "--sizes 256 --runs 10", "--sizes 256 --runs 2", (15, 4), f"{FORCE}/force_rate.cpp"),
    Part("parts", "--sizes 512,1024,2048 --runs 10", "--sizes 512 --runs 3", (30, 2), f"{SAND}/parts.cpp"),
    Part("explain", "scenes/dunes.toml", "scenes/dunes.toml", (5, 5), "bench/session/explain.cpp"),
    Part("rest", "--sizes 128,512,1024 --runs 10", "--sizes 128,512 --runs 1", (250, 40), f"{SAND}/rest.cpp"),
    Part("rest-moving", "--sizes 64,256,512 --runs 10", "--sizes 64,256 --runs 1", (1300, 40), f"{SAND}/rest.cpp"),
    Part("tin-piles", "--sizes 32,64,128,256", "--sizes 32,64", (350, 2), f"{TIN}/tin_curves.cpp"),
    Part("tin-simplify", "--sizes 256,1024 --runs 10", "--sizes 256 --runs 1", (30, 1), f"{TIN}/simplify.cpp"),
    Part("tin-imprint", "--sizes 512 --runs 10", "--sizes 256 --runs 2", (20, 2), f"{TIN}/imprint.cpp"),
    Part("tin-active", "--sizes 500 --runs 10", "--sizes 200 --runs 3", (15, 2), f"{TIN}/tin_curves.cpp", check="--sizes 500 --runs 10"),
    Part("detail", "--sizes 1024,2048 --runs 10 --frames 12", "--sizes 2048 --runs 3 --frames 4", (240, 15), "bench/draw/detail_bench.cpp",
         program=f"{RELEASE}/detail_bench", command=""),
    Part("ranks", "--walls 1x1,2x2,3x4", None, (60, 0), "scripts/figures/report/report_ranks.py",
         program="scripts/figures/report/report_ranks.py", command="", check="--walls 1x1"),
    Part("latency", "--seconds 10", None, (420, 0), "scripts/figures/sessions/latency.py", check=""),
]


def algorithm_version(root=ROOT):
    return re.search(r"kAlgorithmVersion = (\d+);", (root / "sand" / "model" / "rules.hpp").read_text())[1]


def release(root=ROOT):
    return re.search(r"project\(sandwall VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]


def fingerprint(source, root=ROOT):
    """Returns a hash of the code that measures.

    This code is the file, the files of bench/ and tests/support/ that it includes, and the scripts that it imports. A
    script is in the folder of the importing one, or in one beside it.

    Comments, spaces and the places of files do not count, so a table stays valid when sources move. The lists of curves and
    the writer of tables do not count either.
    """
    seen, waiting = {}, [source]
    while waiting:
        name = waiting.pop()
        file = root / name
        if name in seen or re.match(r"bench/report/(csv|curves)\.", name) or not file.is_file():
            continue
        text = file.read_text()
        seen[name] = re.sub(r"//[^\n]*|^#include [^\n]*|\s+" if name.endswith("pp") else PLACES, "", text, flags=re.MULTILINE)
        for included in re.findall(r'#include "((?:bench|tests/support)/[^"]+)"', text):
            waiting += [included, re.sub(r"\.hpp$", ".cpp", included)]
        if name.endswith(".py"):
            folder = pathlib.PurePath(name).parent
            for module in re.findall(r"^(?:from|import) ([\w.]+)", text, re.MULTILINE):
                waiting += [str(above / f"{module.replace('.', '/')}.py") for above in (folder, folder.parent)]
    return hashlib.blake2b("\n".join(sorted(seen.values())).encode(), digest_size=8).hexdigest()


@dataclass
class Old:
    """Why a table is not that of the present sources: a fact of its head, and what the fact would be now."""
    name: str
    fact: str  # command, source or algorithm
    found: str
    wanted: str

    def __str__(self):
        return f"{self.name}.csv: its {self.fact} is {self.found}, and the present one is {self.wanted}"


def why_old(part, table, quick, root=ROOT):
    """Returns why a table is old, or None if its command, source and algorithm are the present ones."""
    for fact, wanted in (("command", " ".join(part.words(quick))), ("source", fingerprint(part.source, root)),
                         ("algorithm", algorithm_version(root))):
        found = table.fact(fact, "unknown")
        if found != wanted:
            return Old(part.name, fact, found, wanted)
    return None
