# SPDX-License-Identifier: Apache-2.0
"""A copy of the sources with a build of its own, in which one bug at a time is planted."""

import contextlib
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time

from base.process_marks import marked

ROOT = pathlib.Path(__file__).resolve().parents[3]
COMMIT = ["-c", "user.name=mutate.sh", "-c", "user.email=mutate.sh", "-c", "commit.gpgsign=false", "commit", "--quiet"]
LONGEST = 300  # [s], limit of a test program
MARK = "SANDWALL_MUTATED"  # name of a variable in the environment of all that builds and tests start
SKIPPED = 77   # status of a test program that passes, but has skipped a test that needs rights
FAILED = re.compile(r"^\[  FAILED  \] ([^ ,\n]+)", re.MULTILINE)
NO_TEST = re.compile(r"^\[  PASSED  \] 0 tests", re.MULTILINE)
PYTHON_FAILED = re.compile(r"^(?:FAIL|ERROR): (\w+) ", re.MULTILINE)


class DoesNotCompile(Exception):
    pass


class Closed(Exception):
    """The run ends, and starts nothing more."""


def copy_of(source, copy):
    """Copies a file, or a link as a link, if the copy differs. A copied source is newer than its object file, which is
    therefore built again."""
    if source.is_symlink() or copy.is_symlink():
        if source.is_symlink() and copy.is_symlink() and source.readlink() == copy.readlink():
            return
        copy.unlink(missing_ok=True)
    elif copy.is_file() and copy.read_bytes() == source.read_bytes():
        return
    copy.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, copy, follow_symlinks=False)


class Workspace:
    """Not for several threads at once: each thread has a workspace of its own. Any thread may call close()."""

    def __init__(self, folder, jobs):
        self.folder = folder
        self.jobs = jobs
        self.build_folder = folder / "build" / "release"
        self.bin = self.build_folder / "bin"
        self.seconds = {}  # of each test without a bug
        self.closed = False
        self.lock = threading.Lock()

    def prepare(self):
        """Copies the sources and configures the build. Ends what a run that was killed has left."""
        self.end_processes()
        self.copy_sources()
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        subprocess.run(["cmake", "--preset", "release", "-S", self.folder, "-B", self.build_folder, "-DSANDWALL_MUTANTS=ON",
                        *launcher],
                       cwd=self.folder, check=True, stdout=subprocess.DEVNULL, env=self.environment())

    def copy_sources(self, root=ROOT):
        """Copies the tracked files of `root`. Restores a file that a run before has left changed. Deletes every file outside the
        build that is not tracked any more, such as a renamed document, because tests read all files of a folder. The copy is a
        repository with these files, because tests ask git for them."""
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=root, capture_output=True, check=True, text=True).stdout.split("\0")
        names = set(filter(None, listed))
        for path in self.files_outside_the_build():
            if path.relative_to(self.folder).as_posix() not in names:
                path.unlink()
                with contextlib.suppress(OSError):  # of a folder that still holds files
                    os.removedirs(path.parent)
        for name in names:
            copy_of(root / name, self.folder / name)
        for command in (["init", "--quiet"], ["add", "--all"], [*COMMIT, "--allow-empty", "--message", "the sources without a bug"]):
            subprocess.run(["git", *command], cwd=self.folder, check=True)

    def files_outside_the_build(self):
        kept = [str(self.folder / name) for name in ("build", ".git")]
        for folder, folders, files in os.walk(self.folder):
            folders[:] = [name for name in folders if os.path.join(folder, name) not in kept]
            yield from (pathlib.Path(folder, name) for name in files)

    def environment(self):
        """Returns the environment of builds and tests. With it, one workspace uses what another one has compiled."""
        return dict(os.environ, SANDWALL_MAY_SKIP="1", CCACHE_BASEDIR=str(self.folder), CCACHE_NOHASHDIR="1",
                    CCACHE_SLOPPINESS="pch_defines,time_macros,include_file_mtime,include_file_ctime", PYTHONDONTWRITEBYTECODE="1",
                    SANDWALL_BIN=str(self.bin), **{MARK: str(self.folder)})

    def ended(self, command, limit=None):
        """Runs a command, and ends all processes that it leaves, such as a session of a launcher with a bug.

        Returns its status, or None at the time limit [s], and its output. Throws Closed after close().
        """
        with tempfile.TemporaryFile() as output:  # a process that the command leaves would hold a pipe open
            with self.lock:
                if self.closed:
                    raise Closed
                process = subprocess.Popen(command, cwd=self.folder, env=self.environment(), start_new_session=True,
                                           stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
            try:
                status = process.wait(limit)
            except subprocess.TimeoutExpired:
                status = None
            finally:
                self.end_processes()
                process.wait()
            output.seek(0)
            return status, output.read().decode(errors="replace")

    def end_processes(self):
        """Kills all that builds and tests in this workspace have started."""
        while left := marked(f"{MARK}={self.folder}".encode()):
            for process in left:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            time.sleep(0.01)

    def close(self):
        """Ends what runs, and lets nothing more begin."""
        with self.lock:
            self.closed = True
        self.end_processes()

    def build(self, targets):
        """Throws DoesNotCompile."""
        command = ["cmake", "--build", str(self.build_folder), "--parallel", str(self.jobs), "--target", *targets]
        status, output = self.ended(command)
        if status != 0:
            raise DoesNotCompile(output[-5000:])

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def read(self, name):
        return (self.folder / name).read_text()

    def run(self, test, limit=LONGEST):
        """Runs a test and returns the name of its first failure, or None if it passes.

        A test is "PROGRAM FILTER" of googletest, or "FILE.py [CLASS.TEST]" of a folder in tests/scripts.
        """
        program, _, which = test.partition(" ")
        if program.endswith(".py"):
            file = next((self.folder / "tests" / "scripts").rglob(program))
            command = ["python3", str(file), *which.split(), *(["--failfast"] if "unittest.main()" in file.read_text() else [])]
        else:
            command = [str(self.bin / program), f"--gtest_filter={which or '*'}", "--gtest_fail_fast"]
        start = time.monotonic()
        status, output = self.ended(command, limit)
        if status is None:
            return "the time limit"
        self.seconds.setdefault(test, time.monotonic() - start)
        if status in (0, SKIPPED):
            return "no test" if NO_TEST.search(output) else None
        named = (PYTHON_FAILED if program.endswith(".py") else FAILED).search(output)
        return named[1] if named else f"status {status}"

    def limit(self, test):
        """Returns the time limit of a test that may hang with a bug [s]."""
        return min(LONGEST, 20 + 5 * self.seconds.get(test, LONGEST))
