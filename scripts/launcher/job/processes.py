# SPDX-License-Identifier: Apache-2.0
"""The processes of a session, mpirun with its ranks and the haptic server, and the signals that end them."""

import contextlib
import os
import pathlib
import secrets
import signal
import subprocess
import sys
import threading
import time

from base import events
from base.bad_input import BadInput
from base.console import print_line
from base.process_marks import marked
from job import open_mpi
from job.job_stream import LIBC
from job.mpirun_end import EndWatch

SERVER_START_SECONDS = 20  # until the server listens, which it does before it reads its scene
SERVER_READY_SECONDS = 0.4  # after that the time that the server gets to read a small scene, so that its complaints come before the job
ORDERLY_END_SECONDS = 120  # pictures of a large wall take their time
START_END_SECONDS = 0.5  # before the first frame, when nothing must be kept; mpirun may take another second
KILL_SECONDS = 5
GUARD_SECONDS = 1  # the time that mpirun gets to end its processes if the launcher ends before the first frame
STOPPED_STATUS = 76  # of a master whose input ended before the first frame (master/operator/input_watch.hpp)
STUCK_STATUS = 1  # of a job whose mpirun had to be killed because it did not end after its last process
CRASHES = (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS)
CRASHED_STATUS = 1  # of a session whose mpirun has crashed; Open MPI 4.1 sometimes does when it ends after a failed rank
GONE_SECONDS = 2  # the time that mpirun may take after a process has reported that it ends the job
LOOK_SECONDS = 0.05
LONGEST_LINE = 1024  # bytes of a typed line; the master reads no longer lines
MARK = "SANDWALL_JOB"  # name of a variable in the environment of a job's processes


def die_with(parent):
    """Returns a function that runs in a child process before exec. The kernel kills the child when `parent` ends for any reason."""
    def ask():
        PR_SET_PDEATHSIG = 1
        LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        # The parent may have ended before prctl. The signal would then never come.
        if os.getppid() != parent:
            os.kill(os.getpid(), signal.SIGKILL)

    return ask


def kill_group(process):
    """Kills a process that leads a session, with its children. A child that stays would hold the output open."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def is_terminal(descriptor):
    try:
        return os.isatty(descriptor)
    except OSError:
        return False  # it is closed


class StopSignals:
    """Counts the signals that ask the session to end. Create it before the first process is started.

    SIGHUP stays ignored if the launcher was started so, as nohup does. It is ignored too if no stream of the launcher is a
    terminal, because the end of a terminal then changes nothing for it. `nohup timeout 8h sandwall run` needs this:
    timeout sets SIGHUP back. A shell without job control starts a command in the background with SIGINT ignored, so that
    SIGINT counts in any case.
    """

    def __init__(self):
        self.count = 0
        ignored = signal.getsignal(signal.SIGHUP) == signal.SIG_IGN or not any(map(is_terminal, (0, 1, 2)))
        signal.signal(signal.SIGHUP, signal.SIG_IGN if ignored else self.add)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self.add)

    def add(self, *_):
        self.count += 1


class HapticServer:
    """The haptic server of a session on this machine. All its starts listen on the same port.

    An error in the scene is not printed by the server, because the master reads the same scene and prints it:
    scene_error() has it.

    `command_at(address, start)` returns the command for an address to listen at and the number of the start. Only the main
    thread may start the server, because the kernel kills a server that still begins when the thread that started it ends.
    `stop` counts signals, as StopSignals does.
    """

    def __init__(self, command_at, folder, stop):
        self.stop_signals = stop
        self.command_at = command_at
        self.port_file = pathlib.Path(folder) / "port"
        self.ready_file = pathlib.Path(folder) / "ready"
        self.error_file = pathlib.Path(folder) / "scene_error"
        self.port = 0
        self.starts = 0
        self.process = None

    def start(self):
        self.starts += 1
        for file in (self.port_file, self.ready_file, self.error_file):
            file.unlink(missing_ok=True)
        command = [*self.command_at(f"127.0.0.1:{self.port}", self.starts), "--listening-file", str(self.port_file),
                   "--port-file", str(self.ready_file), "--scene-error-file", str(self.error_file), "--die-with-parent"]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                        start_new_session=True, preexec_fn=die_with(os.getpid()))

    def listens(self):
        """Returns whether the server listens since its last start."""
        return self.port_file.exists()

    def is_ready(self):
        """Returns whether the server has read its scene since its last start."""
        return self.ready_file.exists()

    def scene_error(self):
        """Returns the line with which the server has refused the scene, or None."""
        try:
            return self.error_file.read_text(errors="replace").strip() or None
        except FileNotFoundError:
            return None

    def wait(self, done, seconds):
        """Waits until done() or a signal, at most `seconds`. Throws BadInput or SystemExit if the server has ended or refused its input."""
        deadline = time.monotonic() + seconds
        while not done() and time.monotonic() < deadline and self.stop_signals.count == 0:
            if error := self.scene_error():
                raise BadInput(error)
            status = self.process.poll()
            if status is not None:
                if status < 0:  # else the server has printed the reason
                    print_line(f"the haptic server was killed by signal {-status} before it had read the scene")
                raise SystemExit(status if status > 0 else 1)
            time.sleep(0.01)

    def address(self):
        """Waits until the server listens and has had the time for a small scene, and returns HOST:PORT.

        Returns None after a signal that asks the session to end. Throws BadInput after SERVER_START_SECONDS, or if the
        server has refused the scene.
        """
        self.wait(self.listens, SERVER_START_SECONDS)
        if self.listens():
            self.wait(self.is_ready, SERVER_READY_SECONDS)
        if self.stop_signals.count > 0:
            return None
        if not self.listens():
            raise BadInput(f"the haptic server did not listen within {SERVER_START_SECONDS} s")
        self.port = int(self.port_file.read_text())
        return f"127.0.0.1:{self.port}"

    def stop(self):
        """Asks the server to end, and kills it after 5 s."""
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
    """The mpirun of a session, in its own process group. It is asked to stop over its standard input.

    The output of the job goes to the log if there is one, else to the launcher's output. The job ends when its input ends: at
    once before its first frame, and in order after it. A guard (job_guard.py) sees to that if the launcher ends. `here` tells
    whether all ranks run on this machine.
    """

    started = 0

    def __init__(self, command, environment, log=None, fresh=False, here=False):
        Job.started += 1
        self.fresh = fresh  # whether the session has shown no frame before this job
        self.mark = f"{os.getpid()}-{Job.started}-{secrets.token_hex(8)}"  # no other session has it, also in another container
        self.log = log
        output = {"stdout": log.out.file, "stderr": log.err.file} if log else {}
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, env={**environment, MARK: self.mark},
                                        start_new_session=True, bufsize=0, **output)
        self.guard = Guard(self.process.pid, self.mark, log.outlets() if log else [])
        self.deadline = None
        self.asked = self.terminated = self.stuck = False
        self.brief = False  # whether the job was asked to stop before its first frame
        self.close_at = None  # time at which the input is closed [s]; only a job that starts ends then
        self.ended_at_start = False  # whether the master has ended because its input was closed
        self.end_watch = EndWatch(self.process.pid, here=here)
        self.job_id = None  # of Open MPI, as soon as a rank on this machine tells it

    def ask(self, command):
        """Sends a line to the master: a command as of `sandwall ctl`."""
        try:
            self.process.stdin.write(command.encode() + b"\n")
        except (BrokenPipeError, ValueError):
            pass  # the job has ended

    def signal(self, number):
        try:
            os.killpg(self.process.pid, number)
        except ProcessLookupError:
            pass

    def stop(self):
        """Asks the job to end in order. look() ends it by signals after ORDERLY_END_SECONDS, or sooner before the first frame."""
        if not self.asked:
            self.asked = True
            self.brief = self.starts()
            now = time.monotonic()
            self.deadline = now + (START_END_SECONDS if self.brief else ORDERLY_END_SECONDS)
            if self.fresh and self.log is None:  # without a log, only the master knows whether there was a frame
                self.close_at = now + START_END_SECONDS
            self.ask("stop")

    def ended_before_its_first_frame(self):
        """Returns whether the job was ended at once because it was asked to stop before its first frame."""
        return (self.brief and self.terminated) or self.ended_at_start

    def starts(self):
        """Returns whether the session has shown no frame yet, as far as the log of this job tells."""
        return self.fresh and self.log is not None and self.log.frame is None

    def look(self, stop):
        """Returns the exit status, or None while the job runs. Ends the job in order after one signal, at once after two."""
        try:
            status = self.process.wait(timeout=LOOK_SECONDS)
        except subprocess.TimeoutExpired:
            status = None
        if self.log:
            self.log.follow(ended=status is not None)
        if status is not None:
            self.guard.end()
            self.ended_at_start = self.asked and status == STOPPED_STATUS
            return STUCK_STATUS if self.stuck else status
        if self.log is None or self.log.frame is not None:
            self.guard.end_in_order()
        now = time.monotonic()
        if self.close_at is not None and now > self.close_at:
            self.process.stdin.close()
        if not self.stuck and self.end_watch.stuck(now):
            self.stuck = True
            print_line("mpirun does not end after its last process; killing it")
            self.signal(signal.SIGKILL)
        if self.job_id is None and self.end_watch.child:
            self.job_id = open_mpi.job_id_of(self.end_watch.child)
        if stop.count > 0 and not self.asked:
            print_line("stopping; finishing journal and pictures; press Ctrl-C again to kill")
            events.emit("stopping")
            self.stop()
        if self.brief and not self.terminated and not self.starts():  # the first frame was shown meanwhile, so that there is something to keep
            self.brief = False
            self.deadline = max(self.deadline, now + ORDERLY_END_SECONDS)
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
        """Waits until no process of the job is left on this machine, because the next master needs the journal alone."""
        clear(f"{MARK}={self.mark}".encode())


class Guard:
    """The process that ends a job if the launcher ends: at once, or in order after end_in_order().

    `outputs` are the pipes of the job's output, which it then empties.
    """

    def __init__(self, mpirun, mark, outputs):
        self.in_order = False
        life, self.life = os.pipe2(os.O_CLOEXEC)
        command = [sys.executable, "-S", str(pathlib.Path(__file__).with_name("job_guard.py")), str(life), str(mpirun), f"{MARK}={mark}",
                   *map(str, outputs)]
        try:
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                            pass_fds=[life, *outputs], start_new_session=True)
        finally:
            os.close(life)

    def end_in_order(self):
        """Lets the job end in order if the launcher ends, because it has shown a frame, or because no log tells whether it has."""
        if not self.in_order:
            self.in_order = True
            with contextlib.suppress(OSError):  # the guard has ended, and the job needs none to go on
                os.write(self.life, b"\n")

    def end(self):
        """Ends the guard. Call it after the end of the job."""
        if self.life is not None:
            self.process.kill()
            self.process.wait()
            os.close(self.life)
            self.life = None


def clear(mark, meanwhile=lambda: None, seconds=None):
    """Waits until no process has `mark` in its environment, and kills those that do not end in `seconds`. Calls meanwhile() again and again."""
    deadline = time.monotonic() + (KILL_SECONDS if seconds is None else seconds)
    while left := marked(mark):
        if time.monotonic() > deadline:
            for process in left:
                try:
                    os.kill(process, signal.SIGKILL)
                except (ProcessLookupError, PermissionError):
                    pass  # it has ended
        meanwhile()
        time.sleep(LOOK_SECONDS)


def exit_status(status):
    """Returns the launcher's exit status for that of a job. A signal is negative, as subprocess reports it."""
    if -status in CRASHES:
        return CRASHED_STATUS
    return status if status >= 0 else 128 - status


class Input:
    """Sends typed lines to the running job. The end of the launcher's own input has no effect."""

    def __init__(self, stop):
        self.job = None
        self.stop = stop
        self.thread = None
        # A read from the background of a terminal would stop this process. With the signal ignored the read fails.
        signal.signal(signal.SIGTTIN, signal.SIG_IGN)

    def listen(self):
        if self.thread is None:
            self.thread = threading.Thread(target=self.read, daemon=True)
            self.thread.start()

    def read(self):
        # os.read, because Python ends with a fatal error if a thread still waits in sys.stdin.
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
            print_line(f"'{line}' is ignored, because the session is being started again")
