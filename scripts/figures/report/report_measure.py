# SPDX-License-Identifier: Apache-2.0
"""Measures the parts of the report. An interrupted report continues with the tables that are missing."""

import os
import re
import shutil
import signal
import subprocess
import tempfile
import time

from report.report_data import Table, TableFault
from report.report_parts import ROOT, algorithm_version, fingerprint, release, why_old
from sessions.measured_session import die_with_parent

LEAST_FREE = 16 << 20  # [byte], free space below which no part begins
SAYS_EVERY = 30  # [s], time between two lines of a long part
END_SECONDS = 20  # longest time that an interrupted part gets to end


def commit_of(root=ROOT):
    """Returns the commit of the sources, and whether they have changed since. The report itself does not count."""
    def git(*words):
        ran = subprocess.run(["git", "-C", root, *words], capture_output=True, text=True, check=False)
        return ran.stdout.strip() if ran.returncode == 0 else None
    commit = git("rev-parse", "--short", "HEAD")
    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/report")
    return "unknown" if commit is None else f"{commit}, with changes" if changed else commit


def minutes(seconds):
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def state_of(part, data, quick, root=ROOT):
    """Returns why a part has to be measured, or None if its table is whole and that of the present sources."""
    file = data / f"{part.name}.csv"
    if not file.exists():
        return f"{part.name}.csv: is missing"
    try:
        return why_old(part, Table(file), quick, root)
    except TableFault as fault:
        return str(fault)


def expected(part, data, quick):
    """Returns the expected time of a part [s]: that of the last time with the same options, if its table has it."""
    try:
        table = Table(data / f"{part.name}.csv")
        if table.fact("command") == " ".join(part.words(quick)):
            return float(table.fact("took").split()[0])
    except (TableFault, ValueError):
        pass
    return part.seconds[1 if quick else 0]


def total(parts, data, quick, cores):
    """Returns the expected time of all `parts` [s]. Parts without times run at once, one per core."""
    alone = sum(expected(part, data, quick) for part in parts if part.timed)
    others = [expected(part, data, quick) for part in parts if not part.timed]
    return alone + max([sum(others) / cores, *others])


class Job:
    """A part that is being measured, into a file beside its table."""

    def __init__(self, part, data, quick, root):
        self.part, self.data, self.quick, self.root = part, data, quick, root
        self.file = data / f".{part.name}.csv.part"
        self.began, self.load = time.monotonic(), os.getloadavg()[0]
        self.said = time.monotonic()
        self.log = tempfile.TemporaryFile("w+", errors="replace")
        self.process = subprocess.Popen([*part.words(quick, str(root / part.program)), "--out", str(self.file)], cwd=root,
                                        stdin=subprocess.DEVNULL, stdout=self.log, stderr=self.log, preexec_fn=die_with_parent)

    def seconds(self):
        return time.monotonic() - self.began

    def last_line(self):
        self.log.seek(0)
        return ([line.strip() for line in self.log if line.strip()] or ["it said nothing"])[-1][:200]

    def end(self):
        """Ends the process in order, or by force, and removes what it wrote."""
        for number in (signal.SIGINT, signal.SIGKILL):
            if self.process.poll() is None:
                self.process.send_signal(number)
                try:
                    self.process.wait(END_SECONDS)
                except subprocess.TimeoutExpired:
                    pass
        self.close()

    def close(self):
        self.log.close()
        self.file.unlink(missing_ok=True)

    def finish(self):
        """Completes the table's head and gives the table its name. Returns why this is impossible, or None."""
        if self.process.returncode != 0:
            return f"{self.part.name}: failed with status {self.process.returncode}: {self.last_line()}"
        head = [f"release: {release(self.root)}", f"commit: {commit_of(self.root)}", f"source: {fingerprint(self.part.source, self.root)}",
                f"algorithm: {algorithm_version(self.root)}",
                f"load: {self.load:.2f} before and {os.getloadavg()[0]:.2f} after, on {os.cpu_count()} processors",
                f"took: {self.seconds():.1f} s"]
        try:
            text = re.sub(r"^(# command: .*?) --out .+$", r"\1", self.file.read_text(), flags=re.MULTILINE)
            self.file.unlink()
            with self.file.open("w") as file:
                file.write("".join(f"# {line}\n" for line in head) + text)
                file.flush()
                os.fsync(file.fileno())
            table = Table(self.file)  # a table that is cut short does not get its name
            if old := why_old(self.part, table, self.quick, self.root):
                return str(old)
            self.file.rename(self.data / f"{self.part.name}.csv")
        except (OSError, TableFault) as error:
            return f"{self.part.name}: its table could not be written ({error})"
        return None


class Measuring:
    """Measures parts: first those without times, one per core, then each of the others alone."""

    def __init__(self, parts, data, quick, root=ROOT):
        self.data, self.quick, self.root = data, quick, root
        self.cores = len(os.sched_getaffinity(0))
        self.waiting = sorted((part for part in parts if state_of(part, data, quick, root)), key=lambda part: part.timed)
        self.count, self.done = len(self.waiting), 0
        self.jobs, self.failures = [], {}
        self.spent = self.planned = 0.0
        for rest in data.glob(".*.csv.part"):  # of a report that was killed
            rest.unlink()

    def left(self):
        """Returns the expected time of the waiting parts and of the rest of the running ones [s], at the pace of the parts before."""
        pace = min(max(self.spent / self.planned, 0.3), 5) if self.planned > 20 else 1
        running = sum(max(expected(job.part, self.data, self.quick) - job.seconds(), 0) for job in self.jobs)
        return pace * (total(self.waiting, self.data, self.quick, self.cores) + running)

    def say(self, text):
        print(f"report.sh: {text}", flush=True)

    def begin(self):
        while self.waiting and (not self.jobs or not self.waiting[0].timed and len(self.jobs) < self.cores):
            if self.jobs and self.jobs[0].part.timed:
                return
            part = self.waiting.pop(0)
            if shutil.disk_usage(self.data).free < LEAST_FREE:
                self.failures[part.name] = f"{part.name}: the disk is full; make room on it"
                self.say(self.failures[part.name])
                continue
            try:
                self.jobs.append(Job(part, self.data, self.quick, self.root))
            except OSError as error:
                self.failures[part.name] = f"{part.name}: {part.program} does not start ({error.strerror})"
                self.say(self.failures[part.name])
                continue
            self.say(f"{part.name}: measuring; {self.count - len(self.waiting)} of {self.count}, about {minutes(self.left())} left")

    def look(self):
        for job in list(self.jobs):
            if job.process.poll() is None:
                if time.monotonic() - job.said > SAYS_EVERY:
                    job.said = time.monotonic()
                    self.say(f"{job.part.name}: {job.last_line()} ({minutes(job.seconds())}; about {minutes(self.left())} left)")
                continue
            self.jobs.remove(job)
            plan = expected(job.part, self.data, self.quick)
            if why := job.finish():
                self.failures[job.part.name] = why
                self.say(why)
            else:
                self.planned += plan
                self.spent += job.seconds()
                self.say(f"{job.part.name}: done in {minutes(job.seconds())}")
            job.close()

    def run(self):
        """Returns why parts failed, by name. The other parts are measured nevertheless."""
        try:
            while self.waiting or self.jobs:
                self.begin()
                self.look()
                time.sleep(0.05)
        finally:
            for job in self.jobs:
                job.end()
        return self.failures
