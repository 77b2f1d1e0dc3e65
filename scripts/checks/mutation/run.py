#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plants one bug at a time in a copy of the sources, and expects a test to fail: scripts/mutate.sh. docs/testing.md"""

import collections
import concurrent.futures
import contextlib
import os
import pathlib
import re
import signal
import sys
import time
import tomllib

SCRIPTS = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SCRIPTS / "launcher"), str(SCRIPTS / "checks")]
import draw
import table
from base.command_line import Parser
from workspace import ROOT, DoesNotCompile, Workspace

TABLES = ROOT / "tests" / "mutations"
COUNT = 64  # bugs that are drawn
# Sessions over real ranks, and comparisons with other libraries, are too slow to run for each drawn bug.
SLOW = {"cluster_tests", "latency_tests", "sand_oracle_tests", "delaunay_oracle_tests", "window_tests", "module_tests"}
# A few sessions, for the parts of the programs that no unit test reaches.
SESSIONS = "cluster_tests Lockstep.*:Resuming.*:WrongServer.*:Devices.*"
SEES_EVERY_CHANGE = "mutations_test"  # fails if a line of a row is not there, whatever replaces it
# Python tests that start neither sessions nor windows.
SCRIPT_TESTS = re.compile(r"^sandwall_python_test\(([\w/]+) LABELS unit", re.MULTILINE)


class TableBug:
    """A bug of a row of tests/mutations. Throws table.Misplaced if the row's lines are not in `sources` exactly once."""

    def __init__(self, row, sources):
        self.title, self.test, self.programs = row.name, row.tests, list(row.programs)
        self.changes = sources.changes(row)
        self.names = sorted({change.file for change in self.changes})

    def targets(self):
        return self.programs if ".py" in self.test else [self.test.split()[0], *self.programs]

    def try_in(self, space):
        texts = {name: space.read(name) for name in self.names}
        for name, text in texts.items():
            space.write(name, table.planted(text, [change for change in self.changes if change.file == name]))
        try:
            if targets := self.targets():
                space.build(targets)
            failure = space.run(self.test, space.limit(self.test))
        except DoesNotCompile:
            return False, "does not compile"
        finally:
            for name, text in texts.items():
                space.write(name, text)
        return (True, f"caught by {failure}") if failure else (False, f"SURVIVED {self.test}")


class DrawnBug:
    """The first of `bugs` that compiles. A failure of any test counts that `tests` gives for its source."""

    def __init__(self, bugs, tests):
        self.bugs = bugs
        self.tests_of = {name: tests(name) for name in {bug.name for bug in bugs}}
        self.tests = sorted(set().union(*self.tests_of.values()))
        self.names = [bugs[0].name]
        self.title, self.key = bugs[0].words(), key(bugs[0])
        self.test = None

    def targets(self):
        return sorted({test.split()[0] for test in self.tests if ".py" not in test})

    def try_in(self, space):
        for bug in self.bugs:
            self.title, self.key = bug.words(), key(bug)
            space.write(bug.name, bug.planted())
            try:
                return self.run_tests(space, self.tests_of[bug.name])
            except DoesNotCompile:
                continue
            finally:
                space.write(bug.name, bug.text)
        return False, "no bug of these sources compiles"

    def run_tests(self, space, tests):
        for test in tests:
            if ".py" not in test:
                space.build([test.split()[0]])
            # A failure counts if it comes twice, because a test may also fail on a busy machine.
            if (failure := space.run(test, space.limit(test))) and space.run(test, space.limit(test)):
                return True, f"caught by {failure}"
        return False, "SURVIVED"


def key(bug):
    """Returns the name of a drawn bug in drawn.toml. It has no number of a line, which a change elsewhere would move."""
    return f"{bug.name}: {bug.site.words(bug.text)}"


def test_programs():
    """Returns the test programs and their folders, relative to tests/."""
    found = {}
    for file in sorted((ROOT / "tests").rglob("CMakeLists.txt")):
        for name in re.findall(r"^ *sandwall_test\((\w+)", file.read_text(), re.MULTILINE):
            found[name] = file.parent.relative_to(ROOT / "tests").as_posix()
    return found


def common(a, b):
    """Returns how many folders two paths have in common."""
    return len(os.path.commonprefix([a.split("/"), b.split("/")]))


def tests_for(name, programs):
    """Returns the tests that should see a bug in the source `name`, the nearest first.

    For a script these are the Python tests, otherwise the unit tests of its top folder, and then a few sessions.
    """
    if name.endswith(".cpp"):
        near = {program: common(name, folder) for program, folder in programs.items() if program not in SLOW}
        units = sorted((program for program, depth in near.items() if depth > 0), key=lambda program: (-near[program], program))
        return [*units, SESSIONS]
    listed = SCRIPT_TESTS.findall((ROOT / "tests" / "scripts" / "CMakeLists.txt").read_text())
    paths = [path for path in listed if not path.endswith(SEES_EVERY_CHANGE)]
    stem = pathlib.PurePath(name).stem
    module = re.compile(rf"\b{stem}\b")
    return [f"{path.rpartition('/')[2]}.py" for path in sorted(paths, key=lambda path: (
        not path.endswith(f"/{stem}_test"), not module.search((ROOT / "tests" / "scripts" / f"{path}.py").read_text())))]


def parse(arguments):
    parser = Parser(prog="scripts/mutate.sh", description=__doc__)
    parser.add_argument("which", nargs="*", metavar="FOLDER|ROW",
                        help="only the bugs in sources below these folders, or the rows of these names (default: all, and the drawn bugs)")
    parser.add_argument("--drawn", type=int, default=COUNT, metavar="N", help=f"how many bugs to draw (default: {COUNT}; 0: none)")
    parser.add_argument("--drawn-only", action="store_true", help="plant only drawn bugs, and no row of a table")
    parser.add_argument("--seed", help="draw by this text instead of the one in tests/mutations/drawn.toml")
    parser.add_argument("--list", action="store_true", help="print the bugs and do not plant them")
    options = parser.parse_args(arguments)
    return options


def selected(options, kept, rows, sources):
    """Returns the bugs that the options select. Throws table.Misplaced, and ValueError for an option that names nothing."""
    named = {row.name: row for row in rows}
    folders = [pathlib.Path(which).as_posix() for which in options.which if which not in named]
    for folder in folders:
        if not (ROOT / folder).is_dir():
            raise ValueError(f"{folder}: there is no such folder in {ROOT}, and no such row in {TABLES.relative_to(ROOT)}")
    chosen = [TableBug(named[which], sources) for which in dict.fromkeys(options.which) if which in named]
    if chosen and not folders:
        return chosen
    programs = test_programs()
    bugs = [] if options.drawn_only else [TableBug(row, sources) for row in rows if row.name not in options.which]
    bugs += [DrawnBug(list_, lambda name: tests_for(name, programs)) for list_ in draw.drawn(options.seed or kept["seed"], options.drawn)]
    if folders:
        bugs = [bug for bug in bugs if any(common(name, folder) == len(folder.split("/"))
                                           for name in bug.names for folder in folders)]
    return chosen + bugs


def test_without_bugs(space, tests):
    """Ends the run if a test of a row fails without a bug. Returns the tests that drawn bugs cannot use."""
    useless = set()
    for test, drawn in tests:
        if failure := space.run(test):
            if not drawn:
                sys.exit(f"mutate.sh: {test} fails without a bug ({failure}); mend the test or the filter first")
            print(f"left out, because it fails without a bug: {test} ({failure})", flush=True)
            useless.add(test)
    return useless


def main():
    options = parse(sys.argv[1:])
    kept = tomllib.loads((TABLES / "drawn.toml").read_text())
    try:
        bugs = selected(options, kept, table.rows(TABLES), table.Sources(ROOT))
    except (table.Misplaced, ValueError) as fault:
        print(f"mutate.sh: {fault}", file=sys.stderr)
        return 2
    drawn = [bug for bug in bugs if isinstance(bug, DrawnBug)]
    print(f"{len(bugs) - len(drawn)} bugs of tables, {len(drawn)} drawn bugs; seed {options.seed or kept['seed']}", flush=True)
    if options.list:
        print("\n".join(bug.title for bug in bugs))
        return 0
    cores = os.cpu_count() or 1
    workers = cores + (cores + 1) // 2  # tests of processes and links wait a third of their time
    spaces = [Workspace(ROOT / "build" / "mutants" / str(i), 1) for i in range(workers)]
    targets = sorted({target for bug in bugs for target in bug.targets()})
    print(f"== building {len(targets)} programs, for {workers} bugs at a time", flush=True)
    for space in spaces:
        space.prepare()
    spaces[0].jobs = cores
    for space in spaces:  # the others take from ccache what the first one has compiled
        try:
            if targets:  # a test of a script may need no program
                space.build(targets)
        except DoesNotCompile as fault:
            sys.exit(f"mutate.sh: the sources do not compile without a bug:\n{fault}")
    spaces[0].jobs = 1
    print("== testing without bugs", flush=True)
    tests = sorted({(bug.test, False) for bug in bugs if bug.test} | {(test, True) for bug in drawn for test in bug.tests})
    with threads(spaces) as pool:
        parts = list(pool.map(lambda i: test_without_bugs(spaces[i], tests[i::workers]), range(workers)))
    useless = set().union(*parts)
    seconds = {test: time_ for space in spaces for test, time_ in space.seconds.items()}
    for space in spaces:
        space.seconds = dict(seconds)
    for bug in drawn:
        bug.tests_of = {name: [test for test in tests if test not in useless] for name, tests in bug.tests_of.items()}
    print(f"== testing with each of {len(bugs)} bugs", flush=True)
    return try_all(bugs, spaces, kept.get("unseen", []))


@contextlib.contextmanager
def threads(spaces):
    """A pool with a thread for each workspace. An exception, such as Ctrl-C, ends the tests that run, and no other begins."""
    with concurrent.futures.ThreadPoolExecutor(len(spaces)) as pool:
        try:
            yield pool
        except BaseException:
            for space in spaces:
                space.close()
            raise


def try_all(bugs, spaces, unseen):
    """Tries the bugs, prints a line for each, and returns the exit status."""
    free = collections.deque(spaces)
    accepted = {entry["bug"]: entry["why"] for entry in unseen}
    survived = caught = 0

    def try_one(bug):
        space = free.popleft()
        try:
            return bug.try_in(space)
        finally:
            free.append(space)

    start = time.monotonic()
    with threads(spaces) as pool:
        running = {pool.submit(try_one, bug): bug for bug in bugs}
        for future in concurrent.futures.as_completed(running):
            bug, (found, result) = running[future], future.result()
            if not found and (why := accepted.get(getattr(bug, "key", None))):
                found, result = True, f"no user sees it: {why}"
            caught += found
            survived += not found
            print(f"{bug.title:<60} {result}", flush=True)
    print(f"{caught} caught or explained, {survived} not, in {(time.monotonic() - start) / 60:.0f} min")
    return 1 if survived else 0


def until_interrupted(work):
    """Returns what work() returns, or 130 after Ctrl-C, SIGTERM or the end of the terminal.

    A handler of our own keeps a signal that is ignored, as by nohup, from being ignored by the tests, too.
    """
    nohup = signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
    signal.signal(signal.SIGHUP, (lambda *_: None) if nohup else signal.default_int_handler)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        return work()
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(until_interrupted(main))
