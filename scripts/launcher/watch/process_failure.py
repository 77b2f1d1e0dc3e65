# SPDX-License-Identifier: Apache-2.0
"""Tells which process of a session has failed, and how: from the master's failure.json, from events and from mpirun's lines."""

import dataclasses
import signal
import time

from base import checked_json, events, session_folder
from hosts import reachable


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
    when: float = dataclasses.field(default_factory=time.time)  # time of day, to be printed
    noticed: float = dataclasses.field(default_factory=time.monotonic)
    frame: int = None  # the last frame that was reported as shown
    step: int = None
    last_lines: list = dataclasses.field(default_factory=list)

    def shown(self):
        return f"frame {self.frame}, step {self.step}" if self.frame is not None else "no frame yet"

    def words(self):
        """Returns the options that give this failure to the master that continues the session and starts now."""
        rank = [] if self.rank is None else ["--failed-rank", str(self.rank)]
        # With an equals sign, because the text comes from another program and could begin with hyphens.
        return ["--failed-at", f"{self.noticed:.3f}", f"--failed-on={reachable.identity_here()}",
                "--failed-before", f"{time.monotonic() - self.noticed:.3f}", f"--failure={self.text}", *rank, "--failed-how", self.how]


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


def name_of_rank(told, hosts):
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
        text = f"{name_of_rank(told, hosts)} hung" if how == "hung" and rank is not None else message
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
    failure.last_lines = list(log.last_by_rank.get(rank) or log.last_by_rank.get(0) or log.last_by_rank.get(None) or [])
    return failure


def failure_without_log(status, told, hosts):
    """Returns the failure that ended a job whose output is not kept. `told` is the content of the master's failure.json."""
    rank = told["rank"] if told.get("rank", -1) >= 0 else None
    how = told.get("what") or ending_of(status)
    text = told.get("message") or (f"{name_of_rank(told, hosts)}: {how}" if rank is not None else f"mpirun {how_ended(status)}")
    return Failure(text, rank, how)
