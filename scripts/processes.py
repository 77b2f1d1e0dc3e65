# SPDX-License-Identifier: Apache-2.0
"""The processes of a session: mpirun with its ranks, the haptic server, and who wants them to end."""

import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import events
from job_log import LIBC
from rank_hosts import BadInput

SERVER_START_SECONDS = 20
ORDERLY_END_SECONDS = 120  # pictures of a large wall take their time
KILL_SECONDS = 5
GONE_SECONDS = 2  # that mpirun may take when a process has said that it ends the job
LOOK_SECONDS = 0.05
LONGEST_LINE = 1024  # of what is typed; the master reads no longer ones
MARK = "SANDWALL_JOB"  # in the environment of a job's processes


def die_with_parent():
    """In a child, before exec: the kernel kills it when the launcher dies, however that happens."""
    PR_SET_PDEATHSIG = 1
    LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


class StopSignals:
    """Counts how often somebody wants the session to end, from before its first process is started."""

    def __init__(self):
        self.count = 0
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, self.add)

    def add(self, *_):
        self.count += 1


class HapticServer:
    """The haptic server of a session on this machine, on one port from its first start on.

    `command_at` gives its command for an address to listen at and the number of the start. Only the main thread may
    start it: it dies with the thread that did.
    """

    def __init__(self, command_at, folder):
        self.command_at = command_at
        self.port_file = pathlib.Path(folder) / "port"
        self.port = 0
        self.starts = 0
        self.process = None

    def start(self):
        self.starts += 1
        self.port_file.unlink(missing_ok=True)
        command = [*self.command_at(f"127.0.0.1:{self.port}", self.starts), "--port-file", str(self.port_file)]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        start_new_session=True, preexec_fn=die_with_parent)

    def listens(self):
        """Whether the server listens since it was started last."""
        return self.port_file.exists()

    def address(self):
        """HOST:PORT, once it listens."""
        deadline = time.monotonic() + SERVER_START_SECONDS
        while time.monotonic() < deadline:
            if self.process.poll() is not None:
                raise SystemExit(self.process.returncode if self.process.returncode > 0 else 1)  # it has said why
            if self.listens():
                self.port = int(self.port_file.read_text())
                return f"127.0.0.1:{self.port}"
            time.sleep(0.01)
        raise BadInput(f"the haptic server did not listen within {SERVER_START_SECONDS} s")

    def stop(self):
        """Asks it to end, and does not take no for an answer."""
        if self.process is None:
            return
        self.process.terminate()
        self.process.send_signal(signal.SIGCONT)
        try:
            self.process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class Job:
    """The mpirun of a session, in a process group of its own, asked to stop over its standard input.

    With a log its output goes there, else where ours goes. Never into a pipe: the death of this launcher would kill the
    job with SIGPIPE before the journal is whole. The end of its input is enough to end it.
    """

    started = 0

    def __init__(self, command, environment, log=None):
        Job.started += 1
        self.mark = f"{os.getpid()}-{Job.started}"
        self.log = log
        output = {"stdout": log.out.file, "stderr": log.err.file} if log else {}
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, env={**environment, MARK: self.mark},
                                        start_new_session=True, bufsize=0, **output)
        self.deadline = None
        self.asked = self.terminated = False

    def ask(self, command):
        """Hands a line to the master: what `ctl` can say, too."""
        try:
            self.process.stdin.write(command.encode() + b"\n")
        except (BrokenPipeError, ValueError):
            pass  # already over

    def signal(self, number):
        try:
            os.killpg(self.process.pid, number)
        except ProcessLookupError:
            pass

    def stop(self):
        """Asks it to end in order; at once when order takes too long."""
        if not self.asked:
            self.asked = True
            self.deadline = time.monotonic() + ORDERLY_END_SECONDS
            self.ask("stop")

    def look(self, stop):
        """Its exit status, or None while it runs. Ends it in order when `stop` asks once, at once when it asks twice."""
        try:
            status = self.process.wait(timeout=LOOK_SECONDS)
        except subprocess.TimeoutExpired:
            status = None
        if self.log:
            self.log.follow(ended=status is not None)
        if status is not None:
            return status
        now = time.monotonic()
        if stop.count > 0 and not self.asked:
            print("sandwall: stopping; journal and pictures are being finished, once more to kill",
                  file=sys.stderr, flush=True)
            events.emit("stopping")
            self.stop()
        if self.deadline is None and self.log and self.log.ending:
            self.deadline = now + GONE_SECONDS  # mpirun waits for a host that has gone
        if self.deadline is not None and not self.terminated and (stop.count > 1 or now > self.deadline):
            self.signal(signal.SIGTERM)
            self.terminated = True
            self.deadline = now + (KILL_SECONDS if self.asked else GONE_SECONDS)
        elif self.terminated and now > self.deadline:
            self.signal(signal.SIGKILL)
        return None

    def wait(self, stop):
        while (status := self.look(stop)) is None:
            pass
        return status

    def clear(self):
        """Waits until no process of it is left on this machine; the next master needs the journal for itself."""
        mark = f"{MARK}={self.mark}".encode()
        deadline = time.monotonic() + KILL_SECONDS
        while left := marked(mark):
            if time.monotonic() > deadline:
                for process in left:
                    try:
                        os.kill(process, signal.SIGKILL)
                    except ProcessLookupError:
                        pass
            time.sleep(LOOK_SECONDS)


def marked(mark):
    """The processes that were started with this in their environment."""
    found = []
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                if mark in pathlib.Path("/proc", entry, "environ").read_bytes().split(b"\0"):
                    found.append(int(entry))
            except OSError:
                pass  # gone, or somebody else's
    return found


class Input:
    """Hands on what is typed to the job that runs; the end of our own input means nothing."""

    def __init__(self, stop):
        self.job = None
        self.stop = stop
        self.thread = None
        # In the background of a terminal a read would stop us; this way it fails, and nobody types there anyway.
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)

    def listen(self):
        if self.thread is None:
            self.thread = threading.Thread(target=self.read, daemon=True)
            self.thread.start()

    def read(self):
        # Not by sys.stdin: Python ends with a fatal error when a thread still waits in there.
        text = b""
        while True:
            try:
                piece = os.read(0, LONGEST_LINE)
            except OSError:
                return
            *lines, text = (text + (piece or b"\n")).split(b"\n")
            for line in filter(None, lines):
                self.hand_on(line[:LONGEST_LINE].decode(errors="replace").strip())
            text = text[:LONGEST_LINE]
            if not piece:
                return

    def hand_on(self, line):
        if self.job is not None:
            self.job.ask(line)
        elif line == "stop":
            self.stop.add()
        else:
            print(f"sandwall: '{line}' comes to nobody: the session is being started again", file=sys.stderr, flush=True)
