# SPDX-License-Identifier: Apache-2.0
"""Keeps a session going: what dies is named and started again where the journal ends (docs/recovery.md)."""

import collections
import dataclasses
import json
import os
import pathlib
import shutil
import signal
import sys
import tempfile
import time

import events
import job_log
from processes import HapticServer, Input, Job
from rank_hosts import BadInput

BAD_INPUT = 2
FAILED = 1
FIRST_WAIT, LONGEST_WAIT = 1, 8  # seconds before the second restart in a row, and at most
SERVER_HUNG_SECONDS = 10  # without a link, while the wall goes on
JOURNAL = "session.journal"


def say(line):
    print(f"sandwall: {line}", file=sys.stderr, flush=True)


def signal_name(number):
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def ending_of(status):
    """How a process of ours ended, for programs: SIGKILL, or "status 3"."""
    return signal_name(-status) if status < 0 else f"status {status}"


def how_ended(status):
    """The same for people."""
    return f"died of {ending_of(status)}" if status < 0 else f"ended with {ending_of(status)}"


@dataclasses.dataclass
class Failure:
    """Who failed, and of what."""

    text: str  # for a person: "rank 3 on node02 died of SIGSEGV"
    rank: int = None  # None: no rank of the job
    how: str = ""  # for programs: SIGKILL, "status 3", "hung", "broken" or "disk"
    host_is_lost: bool = False  # it must not draw any more
    when: float = dataclasses.field(default_factory=time.time)
    frame: int = None  # the last one that is known to be shown
    step: int = None
    last_lines: list = dataclasses.field(default_factory=list)

    def shown(self):
        return f"frame {self.frame}, step {self.step}" if self.frame is not None else "no frame yet"

    def words(self):
        """For the master that continues the session: its record of the failure."""
        rank = [] if self.rank is None else ["--failed-rank", str(self.rank)]
        return ["--failed-at", f"{self.when:.3f}", "--failure", self.text, *rank, "--failed-how", self.how]


def taken(path):
    """What the master has left in failure.json, which is removed: it must not be found again."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        path.unlink()
        return found if isinstance(found, dict) else {}
    except (OSError, ValueError):
        return {}


def told_name(told, hosts):
    """The name of the rank that failure.json or its event is about."""
    if told["rank"] == 0:
        return "the master"
    tile = f" (tile {told['tile']})" if told.get("tile") else ""
    return f"rank {told['rank']}{tile} on {told.get('host') or hosts.host_of(told['rank'])}"


def failure_of_job(status, log, hosts, written):
    """What ended a job: from the master's failure.json or event, then mpirun's lines, then a rank's event."""
    told = written or log.failure or {}

    def name(rank):
        return "the master" if rank == 0 else f"rank {rank} on {hosts.host_of(rank)}"

    signalled, exited = log.signalled(), log.exited()
    rank = None
    lost = False
    if told.get("what") in ("broken", "hung", "disk"):
        how = told["what"]
        rank = told.get("rank") if isinstance(told.get("rank"), int) and told["rank"] >= 0 else None
        lost = how == "broken"
        message = " ".join(str(told.get("message") or f"{name(rank or 0)}: {how}").split())[:300]
        text = f"{told_name(told, hosts)} hung" if how == "hung" and rank is not None else message
    elif signalled:
        rank, how = signalled[0], signal_name(signalled[1])
        text = f"{name(rank)} died of {how}"
    elif log.ending:
        how = "hung"
        rank = next(iter(log.ending["ranks"]), None)
        text = f"{log.ending['names'][:300]} hung"
    elif exited:
        rank, how = exited[0], f"status {exited[1]}"
        text = f"{name(rank)} ended with {how}"
    else:
        how = ending_of(status)
        text = f"mpirun {how_ended(status)}"
    failure = Failure(text, rank, how, lost, frame=log.frame, step=log.step)
    failure.last_lines = list(log.said.get(rank) or log.said.get(0) or log.said.get(None) or [])
    return failure


class Allowance:
    """How often may be started again: so often in so many seconds, and so often in a row without a frame."""

    def __init__(self, restarts, window):
        self.restarts, self.window = restarts, window
        self.times = collections.deque()
        self.in_vain = 0

    def take(self, showed_a_frame):
        """Whether another restart is allowed; counts it."""
        now = time.monotonic()
        while self.times and now - self.times[0] > self.window:
            self.times.popleft()
        self.in_vain = 0 if showed_a_frame else self.in_vain + 1
        self.times.append(now)
        return max(len(self.times), self.in_vain) <= self.restarts

    def wait(self):
        """Seconds to leave before the restart that was just taken: none for the first."""
        row = max(len(self.times), self.in_vain)
        return 0 if row <= 1 else min(LONGEST_WAIT, FIRST_WAIT * 2 ** (row - 2))


class Supervisor:
    """Runs a session to its end, through failures.

    `job_of(hosts, haptic, words)` gives command and environment of the job, with more words for the master;
    `server_at(address, start)` the haptic server's command, or is None.
    """

    def __init__(self, out, hosts, job_of, server_at, haptic, options, stop):
        self.out, self.hosts = pathlib.Path(out), hosts
        self.job_of, self.server_at, self.haptic = job_of, server_at, haptic
        self.stop = stop
        self.supervised = options.restarts > 0
        self.allowance = Allowance(options.restarts, options.restart_window)
        self.limits = f"--restarts {options.restarts} in --restart-window {options.restart_window:g}"
        self.resume = options.resume
        self.input = Input(stop)
        self.failures = []
        self.server = self.job = None
        self.server_due = None  # when it is started again
        self.server_hung = False
        self.server_loads = False  # it was restarted and does not listen yet
        self.gave_up = False

    def run(self):
        with tempfile.TemporaryDirectory(prefix="sandwall-") as folder:
            try:
                if self.server_at:
                    self.server = HapticServer(self.server_at, folder)
                    self.server.start()
                    self.haptic = self.server.address()
                self.logs = self.prepare_logs(folder) if self.supervised else None
                return self.tries()
            finally:
                if self.server:
                    self.server.stop()

    def prepare_logs(self, otherwise):
        """OUT/log, or where nothing can be written a folder that goes; the master says what it thinks of that."""
        folder = self.out / "log"
        try:
            if not self.resume:
                shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            return pathlib.Path(otherwise)
        return folder if os.access(folder, os.W_OK | os.X_OK) else pathlib.Path(otherwise)

    def tries(self):
        before = self.journal_identity()
        if self.supervised:
            taken(self.out / "failure.json")  # what another session has left
        words = ["--resume"] if self.resume else []
        number = (job_log.earlier_tries(self.logs) or [0])[-1] if self.logs else 0
        while True:
            log = None
            if self.logs:
                number += 1
                job_log.forget_tries(self.logs, job_log.KEPT_TRIES - 1)
                log = job_log.JobLog(self.logs, number)
            status = self.one_try(words, log)
            if status in (0, BAD_INPUT) or not self.supervised or self.stop.count > 0 or self.gave_up:
                return FAILED if self.gave_up else status if status >= 0 else 128 - status
            failure = failure_of_job(status, log, self.hosts, taken(self.out / "failure.json"))
            log.close()
            if not self.may_go_on(failure, showed_a_frame=log.frame is not None):
                return FAILED
            # A journal that lay there before is of another session, and not to be gone on with.
            ours = self.resume or self.journal_identity() not in (None, before)
            words = ["--resume", *failure.words()] if ours else []
            if not self.ready_again(failure):
                return FAILED

    def journal_identity(self):
        try:
            return (self.out / JOURNAL).stat().st_ino
        except OSError:
            return None

    def one_try(self, words, log):
        """Runs the job until it ends, and the haptic server beside it."""
        command, environment = self.job_of(self.hosts.names, self.haptic, words, log is not None)
        self.job = Job(command, environment, log)
        self.input.job = self.job
        self.input.listen()
        while (status := self.job.look(self.stop)) is None:
            if self.supervised and self.server and not self.job.asked:
                self.look_after_server()
        if self.supervised:
            self.input.job = None
            self.job.clear()
        return status

    def look_after_server(self):
        """Starts the haptic server again, on its port, when it has died; the master links to it by itself."""
        status = self.server.process.poll()
        if status is None:
            self.end_hung_server()
        elif self.server_due is not None:
            if time.monotonic() >= self.server_due:
                self.server_due = None
                self.server.start()
                self.server_loads = True
                self.job.log.hand, self.job.log.refused = None, False  # they are the old server's
        else:
            hung = "was hung" if self.server_hung else how_ended(status)
            failure = Failure(f"the haptic server {hung}", how="hung" if self.server_hung else ending_of(status))
            failure.frame, failure.step = self.job.log.frame, self.job.log.step
            self.server_hung = False
            if self.may_go_on(failure, showed_a_frame=True):
                self.server_due = time.monotonic() + self.allowance.wait()
            else:
                self.gave_up = True
                self.job.stop()

    def end_hung_server(self):
        """Kills a server that runs and has had no link for long, because it will not recover by itself."""
        log = self.job.log
        if self.server_loads and self.server.listens():
            self.server_loads = False
            log.miss_hand()
        if log.hand is not None and time.monotonic() - log.hand > SERVER_HUNG_SECONDS and log.told > log.hand + SERVER_HUNG_SECONDS / 2:
            log.hand = None
            self.server_hung = True
            self.server.process.kill()

    def may_go_on(self, failure, showed_a_frame):
        """Says who failed, and whether what failed is started again; else reports."""
        self.failures.append(failure)
        if self.allowance.take(showed_a_frame):
            say(f"{failure.text}; starting again ({len(self.allowance.times)} of {self.limits})")
            events.emit("restart", what=failure.text, rank=failure.rank, how=failure.how,
                        count=len(self.allowance.times), limit=self.allowance.restarts)
            return True
        self.report(f"more failures than {self.limits} allows")
        return False

    def pause(self):
        """Waits a little before it is started again, longer each time; less when somebody wants the end."""
        until = time.monotonic() + self.allowance.wait()
        while time.monotonic() < until and self.stop.count == 0:
            time.sleep(0.05)

    def ready_again(self, failure):
        """Puts a spare in the place of a host that is lost; False when the session cannot go on, and it has been said."""
        self.pause()
        try:
            self.hosts.struck(failure)
            self.hosts.require_reachable(say)
        except BadInput as complaint:
            self.report(str(complaint))
            return False
        if self.stop.count > 0:
            say(f"stopped between two tries; what was shown is in {self.out / JOURNAL}, and `run --resume` goes on")
            return False
        return True

    def report(self, why):
        """Ends a session that nobody can help with who died, of what, where and when."""
        lines = [f"sandwall: the session is given up: {why}"]
        for failure in self.failures[-job_log.KEPT_TRIES:]:
            when = time.strftime("%H:%M:%S", time.localtime(failure.when))
            lines.append(f"  {when}  {failure.text}; shown: {failure.shown()}")
            lines += [f"            | {line}" for line in failure.last_lines]
        lines.append(f"  all that was said: {self.logs}; what was shown is in {self.out / JOURNAL}, and `run --resume` goes on")
        print("\n".join(lines), file=sys.stderr, flush=True)
        events.emit("given_up", why=why, failures=[{"what": failure.text, "rank": failure.rank, "how": failure.how, "frame": failure.frame,
                                                    "step": failure.step} for failure in self.failures])
        try:
            (self.logs / "report.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
        except OSError:
            pass  # it has been said
