# SPDX-License-Identifier: Apache-2.0
"""Supervises a session: reports a failed process and restarts it from the end of the journal (docs/recovery.md)."""

import collections
import os
import pathlib
import re
import shutil
import time

from ask import session_control
from base import console, events, marked_answer, session_folder
from base.bad_input import BadInput
from base.command_line import NOT_YET
from base.console import print_line
from base.temporary_folder import TemporaryFolder
from hosts import machine_needs
from job import job_log, open_mpi, rank_hosts
from job.processes import HapticServer, Input, Job, exit_status
from watch import failed_processes
from watch.patience import Patience, Stopped
from watch.process_failure import content_of, failure_of_job, failure_without_log, taken
from watch.server_watch import ServerWatch

BAD_INPUT = 2
FAILED = 1
FIRST_WAIT, LONGEST_WAIT = 1, 8  # wait before the second restart in a row, and the longest wait [s]
ENDED_IN_ORDER = ("sand", "summary")  # `what` of failure.json, after which a restart would not help
KILLS = ("SIGKILL", "SIGTERM")  # signals from outside, such as of a system without memory
JOURNAL = "session.journal"
STOPPED = "stopped before the first frame"
MASTERS = "sandwall-master: "  # begins a line of the master


def force_share(options):
    """Returns the share of the force that --force and --force-scale set, or None if neither is given."""
    if options.force is None and options.force_scale is None:
        return None
    return 0 if options.force == "off" else options.force_scale if options.force_scale is not None else 1


def last_words(failure):
    """Returns the last line of a failed process without its numbers, which may be those of processes."""
    return re.sub("[0-9]+", "0", next((line for line in reversed(failure.last_lines) if line.strip()), ""))


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
    """Runs a session to its end, through failures, and makes the films that people mark in it.

    `mpi` is one of open_mpi.py. `start_of(hosts, haptic, words, log)` returns command and environment of the job; `words` are
    more options for the master, and `log` keeps the output, unless it is None. `server_at(address, start)` returns the haptic server's command; it is None for a session without a device.
    """

    def __init__(self, out, hosts, mpi, start_of, server_at, haptic, options, stop, patience=None, films=None):
        self.out, self.hosts = pathlib.Path(out), hosts
        self.mpi, self.start_of, self.server_at, self.haptic = mpi, start_of, server_at, haptic
        self.stop = stop
        self.films = films  # a FilmQueue, or None
        self.patience = patience or Patience(None, stop)
        self.shown = False  # whether a try has shown a frame
        self.supervised = options.restarts > 0
        self.allowance = Allowance(options.restarts, options.restart_window)
        self.limits = f"--restarts {options.restarts} in --restart-window {options.restart_window:g}"
        self.resume = options.resume
        self.force = force_share(options) if options.resume else None  # share of the force that an operator has set
        self.input = Input(stop)
        self.failures = []
        self.failed = failed_processes.FailedProcesses(self.out, self.resume and (self.out / JOURNAL).exists())
        self.watch = self.job = None  # watch: the ServerWatch of a session with a haptic server
        self.restarting = False  # whether the job has failed and has not shown a frame since then
        self.before_frame = None  # the failure of the last try, if that try has shown no frame
        self.gave_up = False
        self.logs = None  # folder of the logs; without --restarts a temporary one, or None if the output is not kept

    def run(self):
        with TemporaryFolder() as folder:
            server = None
            try:
                if self.server_at:
                    server = HapticServer(self.server_at, folder, self.stop)
                    server.start()
                    self.haptic = server.address()
                    if self.haptic is None:
                        print_line(STOPPED)
                        return 0
                    self.watch = self.watch_of(server)
                if self.supervised:
                    self.logs = self.prepare_logs(folder)
                elif self.mpi.keeps_output or self.waits():
                    self.logs = pathlib.Path(folder)
                return self.tries()
            finally:
                self.mark_restart(None)
                if server:
                    server.stop()

    def waits(self):
        """Returns whether the session may wait for its wall."""
        return self.patience.seconds is not None

    def watch_of(self, server):
        return ServerWatch(server, self.out, lambda failure: self.may_go_on(failure, showed_a_frame=True), self.allowance.wait)

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
                log = job_log.JobLog(self.logs, number, self.mpi, self.hosts.ranks_here(), held=self.waits())
            status = self.one_try(words, log)
            self.shown = self.shown or (log is not None and log.frame is not None)
            if status == NOT_YET and self.stop.count == 0 and (self.waits() or not self.shown):
                if not self.waits():
                    log and log.close()
                    return NOT_YET  # the master has printed what is missing
                missing = marked_answer.own_line("\n".join(log.last_by_rank[0]), MASTERS).removeprefix(MASTERS)
                log.close()
                self.patience.wait(missing or "the wall")
                continue
            if log:
                log.release()
            if log and log.force is not None:
                self.force = log.force
            self.patience.renew()
            if status in (0, BAD_INPUT) or not self.supervised or self.stop.count > 0 or self.gave_up:
                self.note_last_failure(status, log)
                if self.gave_up:
                    return BAD_INPUT if self.watch.refuses else FAILED
                if self.job.ended_before_its_first_frame():
                    print_line(STOPPED)
                    return 0
                return exit_status(status)
            if (content_of(self.out / "failure.json") or log.failure or {}).get("what") in ENDED_IN_ORDER:
                log.close()
                return FAILED  # the master has printed why the session is not good
            failure = failure_of_job(status, log, self.hosts, taken(self.out / "failure.json"))
            log.close()
            if self.same_again(failure):
                return FAILED
            if not self.may_go_on(failure, showed_a_frame=log.frame is not None):
                return FAILED
            self.mark_restart(failure)
            if not self.ready_again(failure):
                return FAILED
            # A journal that was there before belongs to another session, which must not be continued.
            ours = self.resume or self.journal_identity() not in (None, before)
            words = ["--resume", *failure.words()] if ours else []
            words += self.force_words()

    def note_last_failure(self, status, log):
        """Writes down the failure of a job that is not started again. A job that the user has killed has not failed."""
        told = content_of(self.out / "failure.json")
        if self.job.ended_before_its_first_frame() or status in (0, BAD_INPUT) or self.stop.count > 1 or self.gave_up or told.get("what") in ENDED_IN_ORDER:
            return
        failure = failure_of_job(status, log, self.hosts, told) if log else failure_without_log(status, told, self.hosts)
        self.failed.add(failure, restarted=False)

    def force_words(self):
        """Returns the options that keep the operator's share of the force, even if the session has no journal."""
        return [] if self.force is None else ["--force-share", f"{self.force:g}"]

    def journal_identity(self):
        try:
            return (self.out / JOURNAL).lstat().st_ino
        except OSError:
            return None

    def one_try(self, words, log):
        """Runs the job until it ends, and supervises the haptic server meanwhile. Returns the exit status of the job."""
        command, environment = self.start_of(self.hosts.names, self.haptic, words, log)
        here = all(host == rank_hosts.HERE for host in self.hosts.names)
        self.job = Job(command, environment, log, fresh=not (self.shown or "--resume" in words), here=here)
        self.input.job = self.job
        self.input.listen()
        while (status := self.job.look(self.stop)) is None:
            if log and log.frame is not None:
                self.mark_restart(None)
            if self.watch and not self.job.asked:
                self.look_after_server(log)
            self.look_after_films(log)
        self.look_after_films(log)
        if self.watch:
            self.watch.tell(status)
        if self.supervised:
            self.input.job = None
            self.job.clear()
        self.mpi.tidy(self.job.process.pid)
        open_mpi.forget_memory(self.job.job_id)
        return status

    def look_after_films(self, log):
        """Makes the films that people have marked."""
        if self.films and log:
            for event in log.films:
                self.films.add(event)
            log.films.clear()
            self.films.look()

    def look_after_server(self, log):
        """Starts the haptic server again if it has ended. Ends the session if the server may not be started again."""
        if not self.supervised:
            self.watch.look_without_restarts(self.failed)
        elif not self.watch.look(log):
            self.gave_up = True
            self.job.stop()

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

    def may_go_on(self, failure, showed_a_frame):
        """Prints the failure and returns whether the process is started again. If not, prints the report."""
        self.failures.append(failure)
        goes_on = self.allowance.take(showed_a_frame)
        self.failed.add(failure, restarted=goes_on)
        if goes_on:
            print_line(f"{failure.text}; starting again ({len(self.allowance.times)} of {self.limits})")
            events.emit("restart", what=failure.text, rank=failure.rank, how=failure.how,
                        count=len(self.allowance.times), limit=self.allowance.restarts)
            return True
        self.report(f"more failures than {self.limits} allows")
        return False

    def same_again(self, failure):
        """Ends the session if a try has failed before its first frame exactly as the try before. Another try would not help.

        Returns whether it has. A kill from outside does not count, and neither does a failure on a host that a spare may replace.
        """
        before, self.before_frame = self.before_frame, failure if failure.frame is None else None
        if before is None or failure.frame is not None or failure.how in KILLS or (failure.rank and self.hosts.spares):
            return False
        if before.text != failure.text or last_words(before) != last_words(failure):
            return False
        self.failures.append(failure)
        self.failed.add(failure, restarted=False)
        self.report("the same failure twice before the first frame, so that another try would not help")
        return True

    def pause(self):
        """Waits before a restart, longer each time. Returns at once when a signal asks the session to end."""
        until = time.monotonic() + self.allowance.wait()
        while time.monotonic() < until and self.stop.count == 0:
            time.sleep(0.05)

    def require_ready(self):
        machine_needs.require(len(self.hosts.ranks_here()))
        self.hosts.require_reachable(print_line)

    def ready_again(self, failure):
        """Waits, and replaces a lost host by a spare. Prints why and returns False if the session cannot continue."""
        self.pause()
        try:
            self.hosts.struck(failure)
            self.patience.until_there(self.require_ready) if self.waits() else self.require_ready()
        except Stopped:
            pass
        except BadInput as complaint:
            if self.stop.count == 0:
                self.report(str(complaint))
                return False
        if self.stop.count > 0:
            print_line(f"stopped between two tries; all shown steps: {self.out / JOURNAL}; `run --resume` continues the session")
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
