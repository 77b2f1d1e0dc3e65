# SPDX-License-Identifier: Apache-2.0
"""Supervises a session: reports a failed process and restarts it from the end of the journal (docs/recovery.md)."""

import collections
import dataclasses
import json
import os
import pathlib
import shutil
import signal
import tempfile
import time

import checked_json
import console
import events
import failed_processes
import job_log
import session_control
import session_folder
from console import say
from processes import HapticServer, Input, Job, exit_status
from rank_hosts import BadInput

BAD_INPUT = 2
FAILED = 1
FIRST_WAIT, LONGEST_WAIT = 1, 8  # wait before the second restart in a row, and the longest wait [s]
ENDED_IN_ORDER = ("sand", "summary")  # `what` of failure.json, after which a restart would not help
SERVER_HUNG_SECONDS = 10  # time without a link, while the wall shows frames, after which the server counts as hung
JOURNAL = "session.journal"
RECOVERIES = "recoveries.jsonl"


def signal_name(number):
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def ending_of(status):
    """Returns the end of a process as a word for programs: "SIGKILL", or "status 3"."""
    return signal_name(-status) if status < 0 else f"status {status}"


def how_ended(status):
    """Returns the end of a process as words for messages: "was killed by SIGKILL", or "ended with status 3"."""
    return f"was killed by {ending_of(status)}" if status < 0 else f"ended with {ending_of(status)}"


@dataclasses.dataclass
class Failure:
    """A failure of a process: which process, how and when."""

    text: str  # for messages: "rank 3 on node02 was killed by SIGSEGV"
    rank: int = None  # the haptic server and mpirun have None
    how: str = ""  # for programs: SIGKILL, "status 3", "hung", "broken" or "disk"
    host_is_lost: bool = False  # the host must not draw any more
    when: float = dataclasses.field(default_factory=time.time)
    frame: int = None  # the last frame that was reported as shown
    step: int = None
    last_lines: list = dataclasses.field(default_factory=list)

    def shown(self):
        return f"frame {self.frame}, step {self.step}" if self.frame is not None else "no frame yet"

    def words(self):
        """Returns the options that give this failure to the master that continues the session."""
        rank = [] if self.rank is None else ["--failed-rank", str(self.rank)]
        # With an equals sign, because the text comes from another program and could begin with hyphens.
        return ["--failed-at", f"{self.when:.3f}", f"--failure={self.text}", *rank, "--failed-how", self.how]


def taken(path):
    """Returns the content of the master's failure.json, or {} if the file does not exist. Removes it, so that it is read once."""
    found = content_of(path)
    try:
        session_folder.forget(path)
    except OSError:
        pass  # it does not exist, or the folder is read-only
    return found


def content_of(path):
    """Returns the content of the master's failure.json, or {} if the file does not exist or is damaged."""
    try:
        return events.failure_in(checked_json.parse(session_folder.read_text(path)))
    except (OSError, ValueError):
        return {}


def told_name(told, hosts):
    """Returns the name of the rank in `told`, the content of failure.json or of the event `failure`."""
    if told["rank"] == 0:
        return "the master"
    tile = f" (tile {told['tile']})" if told.get("tile") else ""
    return f"rank {told['rank']}{tile} on {told.get('host') or hosts.host_of(told['rank'])}"


def failure_of_job(status, log, hosts, written):
    """Returns the failure that ended a job.

    Takes it from the master's failure.json or event, else from mpirun's lines, else from a rank's event.
    """
    told = written or log.failure or {}

    def name(rank):
        return "the master" if rank == 0 else f"rank {rank} on {hosts.host_of(rank)}"

    signalled, exited = log.signalled(), log.exited()
    rank = None
    lost = False
    if told.get("what") in ("broken", "hung", "disk"):
        how = told["what"]
        rank = told["rank"] if told.get("rank", -1) >= 0 else None
        lost = how == "broken"
        message = told.get("message") or f"{name(rank or 0)}: {how}"
        text = f"{told_name(told, hosts)} hung" if how == "hung" and rank is not None else message
    elif signalled:
        rank, how = signalled[0], signal_name(signalled[1])
        text = f"{name(rank)} was killed by {how}"
    elif log.ending:
        how = "hung"
        rank = next(iter(log.ending["ranks"]), None)
        text = f"{log.ending['names'] or name(rank or 0)} hung"
    elif exited:
        rank, how = exited[0], f"status {exited[1]}"
        text = f"{name(rank)} ended with {how}"
    else:
        how = ending_of(status)
        text = f"mpirun {how_ended(status)}"
    if rank in log.rank_logs:
        text += f" (its output: {log.rank_logs[rank]})"
    failure = Failure(text, rank, how, lost, frame=log.frame, step=log.step)
    failure.last_lines = list(log.said.get(rank) or log.said.get(0) or log.said.get(None) or [])
    return failure


def force_share(options):
    """Returns the share of the force that --force and --force-scale set, or None if neither is given."""
    if options.force is None and options.force_scale is None:
        return None
    return 0 if options.force == "off" else options.force_scale if options.force_scale is not None else 1


def failure_without_log(status, told, hosts):
    """Returns the failure that ended a job whose output is not kept. `told` is the content of the master's failure.json."""
    rank = told["rank"] if told.get("rank", -1) >= 0 else None
    how = told.get("what") or ending_of(status)
    text = told.get("message") or (f"{told_name(told, hosts)}: {how}" if rank is not None else f"mpirun {how_ended(status)}")
    return Failure(text, rank, how)


class Allowance:
    """The limit of restarts: at most `restarts` in `window` seconds, and at most `restarts` in a row without a frame."""

    def __init__(self, restarts, window):
        self.restarts, self.window = restarts, window
        self.times = collections.deque()
        self.in_vain = 0

    def take(self, showed_a_frame):
        """Counts a restart. Returns whether it is allowed."""
        now = time.monotonic()
        while self.times and now - self.times[0] > self.window:
            self.times.popleft()
        self.in_vain = 0 if showed_a_frame else self.in_vain + 1
        self.times.append(now)
        return max(len(self.times), self.in_vain) <= self.restarts

    def wait(self):
        """Returns the wait before the restart that take() has counted last [s]: 0 before the first."""
        row = max(len(self.times), self.in_vain)
        return 0 if row <= 1 else min(LONGEST_WAIT, FIRST_WAIT * 2 ** (row - 2))


class Supervisor:
    """Runs a session to its end, through failures.

    `mpi` is one of open_mpi.py. `start_of(hosts, haptic, words, log)` returns command and environment of the job; `words` are
    more options for the master, and `log` keeps the output, unless it is None. `server_at(address, start)` returns the haptic server's command; it is None for a session without a device.
    """

    def __init__(self, out, hosts, mpi, start_of, server_at, haptic, options, stop):
        self.out, self.hosts = pathlib.Path(out), hosts
        self.mpi, self.start_of, self.server_at, self.haptic = mpi, start_of, server_at, haptic
        self.stop = stop
        self.supervised = options.restarts > 0
        self.allowance = Allowance(options.restarts, options.restart_window)
        self.limits = f"--restarts {options.restarts} in --restart-window {options.restart_window:g}"
        self.resume = options.resume
        self.force = force_share(options) if options.resume else None  # share of the force that an operator has set
        self.input = Input(stop)
        self.failures = []
        self.failed = failed_processes.FailedProcesses(self.out, self.resume and (self.out / JOURNAL).exists())
        self.server = self.job = None
        self.server_due = None  # time at which the server is started again [s]
        self.server_hung = False
        self.server_missed = False  # without restarts: whether the server has ended
        self.server_loads = False  # whether the server was restarted and does not listen yet
        self.server_failure = None  # the failure after which the server is not linked yet
        self.restarting = False  # whether the job has failed and has not shown a frame since then
        self.gave_up = False
        self.logs = None  # folder of the logs; without --restarts a temporary one, or None if the output is not kept

    def run(self):
        with tempfile.TemporaryDirectory(prefix="sandwall-") as folder:
            try:
                if self.server_at:
                    self.server = HapticServer(self.server_at, folder)
                    self.server.start()
                    self.haptic = self.server.address()
                if self.supervised:
                    self.logs = self.prepare_logs(folder)
                elif self.mpi.keeps_output:
                    self.logs = pathlib.Path(folder)
                return self.tries()
            finally:
                self.mark_restart(None)
                if self.server:
                    self.server.stop()

    def prepare_logs(self, otherwise):
        """Returns OUT/log, or the temporary folder `otherwise` if OUT/log cannot be written. The master reports the latter."""
        folder = self.out / "log"
        try:
            if not self.resume and folder.is_dir():  # rmtree would wait for the writer of a pipe
                shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(mode=0o755, parents=True, exist_ok=True)
        except OSError:
            return pathlib.Path(otherwise)
        return folder if os.access(folder, os.W_OK | os.X_OK) else pathlib.Path(otherwise)

    def tries(self):
        before = self.journal_identity()
        if self.supervised:
            taken(self.out / "failure.json")  # removes the file of another session
        words = ["--resume"] if self.resume else []
        words += self.force_words()
        number = (job_log.earlier_tries(self.logs) or [0])[-1] if self.logs else 0
        while True:
            log = None
            if self.logs:
                number += 1
                job_log.forget_tries(self.logs, job_log.KEPT_TRIES - 1)
                log = job_log.JobLog(self.logs, number, self.mpi, self.hosts.ranks_here())
            status = self.one_try(words, log)
            if log and log.force is not None:
                self.force = log.force
            if status in (0, BAD_INPUT) or not self.supervised or self.stop.count > 0 or self.gave_up:
                self.note_last_failure(status, log)
                return FAILED if self.gave_up else exit_status(status)
            if (content_of(self.out / "failure.json") or log.failure or {}).get("what") in ENDED_IN_ORDER:
                log.close()
                return FAILED  # the master has printed why the session is not good
            failure = failure_of_job(status, log, self.hosts, taken(self.out / "failure.json"))
            log.close()
            if not self.may_go_on(failure, showed_a_frame=log.frame is not None):
                return FAILED
            self.mark_restart(failure)
            # A journal that was there before belongs to another session, which must not be continued.
            ours = self.resume or self.journal_identity() not in (None, before)
            words = ["--resume", *failure.words()] if ours else []
            words += self.force_words()
            if not self.ready_again(failure):
                return FAILED

    def note_last_failure(self, status, log):
        """Writes down the failure of a job that is not started again. A job that the user has killed has not failed."""
        told = content_of(self.out / "failure.json")
        if status in (0, BAD_INPUT) or self.stop.count > 1 or self.gave_up or told.get("what") in ENDED_IN_ORDER:
            return
        failure = failure_of_job(status, log, self.hosts, told) if log else failure_without_log(status, told, self.hosts)
        self.failed.add(failure, restarted=False)

    def force_words(self):
        """Returns the options that keep the operator's share of the force, even if the session has no journal."""
        return [] if self.force is None else ["--force-share", f"{self.force:g}"]

    def journal_identity(self):
        try:
            return (self.out / JOURNAL).stat().st_ino
        except OSError:
            return None

    def one_try(self, words, log):
        """Runs the job until it ends, and supervises the haptic server meanwhile. Returns the exit status of the job."""
        command, environment = self.start_of(self.hosts.names, self.haptic, words, log)
        self.job = Job(command, environment, log)
        self.input.job = self.job
        self.input.listen()
        while (status := self.job.look(self.stop)) is None:
            if log and log.frame is not None:
                self.mark_restart(None)
            if self.server and not self.job.asked:
                self.look_after_server() if self.supervised else self.miss_server()
        if self.supervised:
            self.input.job = None
            self.job.clear()
        self.mpi.tidy(self.job.process.pid)
        return status

    def look_after_server(self):
        """Starts the haptic server again on its port if it has ended. The master connects to it again by itself."""
        status = self.server.process.poll()
        if status is None:
            self.tell_linked_server()
            self.end_hung_server()
        elif self.server_due is not None:
            if time.monotonic() >= self.server_due:
                self.server_due = None
                self.server.start()
                self.server_loads = True
                log = self.job.log
                log.hand, log.refused, log.linked = None, False, None  # the values belong to the previous server
        else:
            hung = "was hung" if self.server_hung else how_ended(status)
            failure = Failure(f"{failed_processes.SERVER} {hung}", how="hung" if self.server_hung else ending_of(status))
            failure.frame, failure.step = self.job.log.frame, self.job.log.step
            self.server_hung = False
            if self.may_go_on(failure, showed_a_frame=True):
                self.server_failure = failure
                self.server_due = time.monotonic() + self.allowance.wait()
            else:
                self.gave_up = True
                self.job.stop()

    def miss_server(self):
        """Prints and writes down once that the haptic server has ended, in a session without restarts."""
        status = self.server.process.poll()
        if status is None or self.server_missed:
            return
        self.server_missed = True
        failure = Failure(f"{failed_processes.SERVER} {how_ended(status)}", how=ending_of(status))
        say(f"{failure.text}; the session continues without it, because of --restarts 0")
        self.failed.add(failure, restarted=False)

    def tell_linked_server(self):
        """Writes the recovery of a restarted server when its hand is linked. The master writes the recoveries of the job."""
        failure, log = self.server_failure, self.job.log
        if failure is None or log.linked is None:
            return
        self.server_failure = None
        # The wall has continued meanwhile, so the values about a replay are null.
        recovery = {"failure": failure.text, "failed_rank": None, "failed_how": failure.how, "seconds_to_next_frame": None,
                    "seconds_to_link": log.linked - failure.when, "step": log.step or failure.step or 0,
                    "frame": log.frame or failure.frame or 0, "state_hash": None,
                    "checkpoint_step": None, "replayed_steps": None, "cut_bytes": None}
        try:
            session_folder.append_line(self.out / RECOVERIES, json.dumps(recovery))
        except OSError as error:
            say(f"{self.out / RECOVERIES}: cannot be written ({error.strerror})")

    def mark_restart(self, failure):
        """Leaves the failure for `sandwall ctl` until the job has shown a frame again, when `failure` is None."""
        marker = self.logs / session_control.RESTARTING if self.logs else None
        if marker is None or (failure is None and not self.restarting):
            return
        self.restarting = failure is not None
        try:
            if failure:
                session_folder.write_text(marker, failure.text + "\n")
            else:
                marker.unlink(missing_ok=True)
        except OSError:
            pass  # ctl then reports a start without the reason

    def end_hung_server(self):
        """Kills a running server without a link for SERVER_HUNG_SECONDS, because it will not recover by itself."""
        log = self.job.log
        if self.server_loads and self.server.listens():
            self.server_loads = False
            log.miss_hand()
        if log.hand is not None and time.monotonic() - log.hand > SERVER_HUNG_SECONDS and log.told > log.hand + SERVER_HUNG_SECONDS / 2:
            log.hand = None
            self.server_hung = True
            self.server.process.kill()

    def may_go_on(self, failure, showed_a_frame):
        """Prints the failure and returns whether the process is started again. If not, prints the report."""
        self.failures.append(failure)
        goes_on = self.allowance.take(showed_a_frame)
        self.failed.add(failure, restarted=goes_on)
        if goes_on:
            say(f"{failure.text}; starting again ({len(self.allowance.times)} of {self.limits})")
            events.emit("restart", what=failure.text, rank=failure.rank, how=failure.how,
                        count=len(self.allowance.times), limit=self.allowance.restarts)
            return True
        self.report(f"more failures than {self.limits} allows")
        return False

    def pause(self):
        """Waits before a restart, longer each time. Returns at once when a signal asks the session to end."""
        until = time.monotonic() + self.allowance.wait()
        while time.monotonic() < until and self.stop.count == 0:
            time.sleep(0.05)

    def ready_again(self, failure):
        """Waits, and replaces a lost host by a spare. Prints why and returns False if the session cannot continue."""
        self.pause()
        try:
            self.hosts.struck(failure)
            self.hosts.require_reachable(say)
        except BadInput as complaint:
            self.report(str(complaint))
            return False
        if self.stop.count > 0:
            say(f"stopped between two tries; all shown steps: {self.out / JOURNAL}; `run --resume` continues the session")
            return False
        return True

    def report(self, why):
        """Prints the report of a session that is given up: each failed process, how, where and when it failed."""
        lines = [f"sandwall: the session is given up: {why}"]
        for failure in self.failures[-job_log.KEPT_TRIES:]:
            when = time.strftime("%H:%M:%S", time.localtime(failure.when))
            lines.append(f"  {when}  {failure.text}; shown: {failure.shown()}")
            lines += [f"            | {line}" for line in failure.last_lines]
        lines.append(f"  output of all tries: {self.logs}; all shown steps: {self.out / JOURNAL}; `run --resume` continues the session")
        console.ERROR.line("\n".join(lines))
        events.emit("given_up", why=why, failures=[{"what": failure.text, "rank": failure.rank, "how": failure.how, "frame": failure.frame,
                                                    "step": failure.step} for failure in self.failures])
        try:
            session_folder.write_text(self.logs / "report.txt", "\n".join(lines) + "\n")
        except OSError:
            pass  # the report is on standard error already
