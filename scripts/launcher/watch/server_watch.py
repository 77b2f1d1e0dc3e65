# SPDX-License-Identifier: Apache-2.0
"""Watches the haptic server of a session, and starts it again if it has ended or hangs (docs/recovery.md)."""

import json
import time

from base import session_folder
from base.command_line import BAD_INPUT
from base.console import print_line
from watch import failed_processes
from watch.process_failure import Failure, ending_of, how_ended

HUNG_SECONDS = 10  # time without a link, while the wall shows frames, after which the server counts as hung
RECOVERIES = "recoveries.jsonl"


class ServerWatch:
    """Watches `server`, a processes.HapticServer.

    `may_go_on(failure)` prints a failure and returns whether the server may be started again. `wait()` returns how long to
    wait before that [s]. Both look functions take the job_log.JobLog of the running job.
    """

    def __init__(self, server, out, may_go_on, wait):
        self.server, self.out = server, out
        self.may_go_on, self.wait = may_go_on, wait
        self.due = None  # time at which the server is started again [s]
        self.hung = False
        self.missed = False  # without restarts: whether the server has ended
        self.loads = False  # whether the server was restarted and has not read its scene yet
        self.failure = None  # the failure after which the server is not linked yet
        self.untold = None  # without restarts: why the server has refused its scene, until tell() prints it
        self.refuses = False  # whether the server has refused its input, which a restart would not change

    def look(self, log):
        """Starts the server again on its port if it has ended. The master connects to it again by itself.

        Returns False if it must not be started again.
        """
        status = self.server.process.poll()
        if status == BAD_INPUT and self.server.starts == 1:
            return self.refused(log)
        if status is None:
            self.write_recovery(log)
            self.end_hung(log)
        elif self.due is not None:
            if time.monotonic() >= self.due:
                self.due = None
                self.server.start()
                self.loads = True
                log.hand, log.refused, log.linked, log.loaded = None, False, None, 0.0  # the values belong to the previous server
        else:
            if error := self.server.scene_error():
                print_line(error)
            how = "was hung" if self.hung else how_ended(status)
            failure = Failure(f"{failed_processes.SERVER} {how}", how="hung" if self.hung else ending_of(status))
            failure.frame, failure.step = log.frame, log.step
            self.hung = False
            if not self.may_go_on(failure):
                return False
            self.failure = failure
            self.due = time.monotonic() + self.wait()
        return True

    def refused(self, log):
        """Returns False if the session must end because its server has refused its input, after a line that says why.

        A master that still starts refuses the same scene, and prints the line.
        """
        error = self.server.scene_error()
        if error is not None and log.frame is None:
            return True
        if error is not None:
            print_line(error)
        self.refuses = True
        return False

    def look_without_restarts(self, failed):
        """Prints once that the server has ended, and adds it to `failed`, a failed_processes.FailedProcesses."""
        status = self.server.process.poll()
        if status is None or self.missed:
            return
        self.missed = True
        self.untold = self.server.scene_error()
        failure = Failure(f"{failed_processes.SERVER} {how_ended(status)}", how=ending_of(status))
        if self.untold is None:
            print_line(f"{failure.text}; the session continues without it, because of --restarts 0")
        failed.add(failure, restarted=False)

    def tell(self, job_status):
        """Prints why a server without restarts has refused its scene, at the end of the job. A master that refuses the scene has printed it."""
        if self.untold and job_status != BAD_INPUT:
            print_line(self.untold)
        self.untold = None

    def write_recovery(self, log):
        """Writes the recovery of a restarted server when its hand is linked. The master writes the recoveries of the job."""
        failure = self.failure
        if failure is None or log.linked is None:
            return
        self.failure = None
        # The wall has continued meanwhile, so the values about a replay are null.
        recovery = {"failure": failure.text, "failed_rank": None, "failed_how": failure.how, "seconds_to_next_frame": None,
                    "seconds_to_link": log.linked - failure.noticed, "step": log.step or failure.step or 0,
                    "frame": log.frame or failure.frame or 0, "state_hash": None,
                    "checkpoint_step": None, "replayed_steps": None, "cut_bytes": None}
        try:
            session_folder.append_line(self.out / RECOVERIES, json.dumps(recovery))
        except OSError as error:
            print_line(f"{self.out / RECOVERIES}: cannot be written ({error.strerror})")

    def end_hung(self, log):
        """Kills a running server without a link for HUNG_SECONDS, because it will not recover by itself."""
        if self.loads and self.server.is_ready():
            self.loads = False
            log.miss_hand()
        if log.hand is not None and time.monotonic() - log.hand > HUNG_SECONDS and log.shown_at > log.hand + HUNG_SECONDS / 2:
            log.hand = None
            self.hung = True
            self.server.process.kill()
