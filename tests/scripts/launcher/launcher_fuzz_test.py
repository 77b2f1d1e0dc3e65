#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Feeds the launcher thousands of changed files and lines of its programs. It may refuse them only in one line.

usage: launcher_fuzz_test.py [SECONDS]     (default: a fixed number of inputs for each reader)

The inputs are the same in every run, unless SANDWALL_SEED gives another seed. A failure prints the seed with which the
next run begins with the same input.
"""

import argparse
import contextlib
import io
import json
import os
import pathlib
import random
import socket
import sys
import tempfile
import time
import traceback
import zlib
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from json_mutator import changed_bytes, changed_json, changed_value  # noqa: E402
from sample_summary import SUMMARY  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))
sys.dont_write_bytecode = True

import programs  # noqa: E402
from ask import session_control, session_report, session_results  # noqa: E402
from base import console, events, journal_origin, session_folder  # noqa: E402
from base.bad_input import BadInput  # noqa: E402
from hosts import doctor, examined_host  # noqa: E402
from job import job_log, open_mpi, rank_hosts  # noqa: E402
from kept import marks, try_sessions  # noqa: E402
from terrain import kinds, made_scene  # noqa: E402
from watch import process_failure, spare_hosts, supervisor  # noqa: E402

SEED = 20261125
INPUTS = 1000  # for each reader
FAILURE = {"what": "hung", "rank": 2, "host": "node02", "tile": "r1c2", "message": "rank 2 (tile r1c2) hung"}
EVENTS = (
    {"event": "progress", "frame": 61, "step": 60, "fps": 60.0, "skew_us": 310.2, "hand": "hand linked"},
    {"event": "link", "state": "linked", "epoch": 2, "server": "node01"},
    {"event": "link", "state": "refused", "epoch": 2, "server": "node01"},
    {"event": "without_hand", "reason": "no_server", "epoch": 1},
    {"event": "waiting", "by": 0, "frame": 8, "ranks": [2], "names": "rank 2", "seconds": 3.0, "limit": 3, "ends_job": True},
    {"event": "failure", "failure": FAILURE},
)
MPIRUN = (b"mpirun noticed that process rank 2 with PID 0 on node node02 exited on signal 9 (Killed).",
          b"  Process name: [[5156,1],2]\n  Exit code:    3", b"-" * 74, b"[node02:12345] *** Process received signal ***")
STATUS = {"ok": True, "step": 12, "material": {"talus": 34.0}}
VERSION = {"program": "sandwall-master", "version": "0.2.0", "build": "0123456789abcdef", "protocol": 8}
PROBE = {"backend": "egl", "renderer": "llvmpipe", "shortcomings": ["the screen has 60 Hz"], "version": "4.5"}
JOURNAL = b"SWJL" + b"".join(number.to_bytes(4, "little") for number in (10, 16, 5)) + b"0.2.0" + bytes(8)
TERRAINS = (b"ncols 2\nnrows 1\ncellsize 1\n1 2\n", b"x,y,z\n1,2,3\n", b'[terrain]\nkind = "dem"\nfile = "v.tif"\n', b"II*\0" + bytes(40),
            b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\2\0\0\0\1\x08\2\0\0\0", "ncols 2\n".encode("utf-16"), b"\xff\xd8\xff\xe0")
HOSTS = b"node01 slots=2\nnode02 slots=1 # the left one\nnode03 slots=4 spare\n"


class Wrong(Exception):
    """The launcher did something else than to accept or to refuse in one line."""


def require_line(text):
    """Throws Wrong unless `text` is one line that can be printed, written to a file, and given to a program."""
    if any(ord(character) < 32 for character in text):
        raise Wrong(f"not one line: {text!r}")
    text.encode()  # throws if a file would not take it


@contextlib.contextmanager
def refused():
    """Accepts BadInput of one line."""
    try:
        yield
    except BadInput as complaint:
        require_line(str(complaint))


class Folder:
    """A session's folder, and a supervisor of two ranks that never starts a process."""

    def __init__(self, path):
        self.path = path
        self.log = path / "log"
        self.log.mkdir(parents=True)
        self.tries = 0

    def supervisor(self):
        options = argparse.Namespace(restarts=1000, restart_window=60, resume=False)
        hosts = spare_hosts.SessionHosts(["node01", "node02"], [], "node", "4.1.4")
        with mock.patch("watch.supervisor.Input"):
            one = supervisor.Supervisor(self.path, hosts, open_mpi.OpenMpi4("4.1.4"), None, None, "none", options, mock.Mock(count=0))
        one.logs = self.log
        return one

    def job_log(self, mpi=open_mpi.OpenMpi4("4.1.4")):
        self.tries += 1
        job_log.forget_tries(self.log, 2)
        return job_log.JobLog(self.log, self.tries, mpi, [0, 1])

    def end(self, log, told):
        """Does what the launcher does after a job has failed: prints, writes and passes on the failure."""
        one = self.supervisor()
        failure = process_failure.failure_of_job(1, log, one.hosts, told)
        for word in failure.words():
            require_line(word)
        require_line(failure.shown())
        one.may_go_on(failure, showed_a_frame=log.frame is not None)
        one.mark_restart(failure)
        with session_folder.held(self.path):
            require_line(session_control.why_silent(self.path))
        one.hosts.struck(failure)
        one.report("too many failures")
        watch = one.watch_of(mock.Mock())
        watch.failure, watch.loads = failure, True
        watch.write_recovery(log)
        watch.end_hung(log)
        one.mark_restart(None)
        log.close()


def failure_file(folder, text):
    (folder.path / "failure.json").write_bytes(text)
    process_failure.content_of(folder.path / "failure.json").get("what")
    folder.end(folder.job_log(), process_failure.taken(folder.path / "failure.json"))


def output_of_job(folder, text):
    log = folder.job_log()
    half = len(text) // 2
    for piece, ended in ((text[:half], False), (text[half:], True)):
        os.write(log.err.file, piece)
        os.write(log.out.file, piece[-100:])
        log.follow(ended)
    folder.end(log, {})


def output_of_open_mpi_5(folder, text):
    """A third of the output is in the file of a rank on this machine, and the rest comes through mpirun."""
    log = folder.job_log(open_mpi.OpenMpi5("5.0.7"))
    third = len(text) // 3
    for piece, stream, ended in ((text[:third], log.err, False), (text[third:2 * third], log.streams[-1], False), (text[2 * third:], log.err, True)):
        os.write(stream.file, piece)
        log.follow(ended)
    for text in log.rank_logs.values():
        require_line(text)
    folder.end(log, {})


def summary(folder, text):
    (folder.path / "summary.json").write_bytes(text)
    with refused():
        session_results.summary_of(folder.path)
    for as_json in (False, True):
        report = session_report.Report(folder.path, as_json)
        report.before = None  # the summary counts as one of this session
        report.after(0)


def restarting(folder, text):
    (folder.log / session_control.RESTARTING).write_bytes(text)
    with session_folder.held(folder.path), refused():
        require_line(session_control.why_silent(folder.path))


def answer_of_master(folder, text):
    ours, theirs = socket.socketpair()
    theirs.sendall(text[:1 << 15])
    theirs.shutdown(socket.SHUT_WR)
    with mock.patch("ask.session_control.connect", lambda *_: ours), theirs, refused():
        session_control.ctl(argparse.Namespace(session=str(folder.path), words=["status"]))


def answers_to_doctor(_, text):
    said = text.decode(errors="replace")
    host = examined_host.Host("node01")
    host.probes = [1]
    host.ask = mock.Mock(run=lambda *_: (0, said, ""))
    one = doctor.Doctor("node", "0123456789abcdef", "", "auto")
    one.check_programs(host, {"build": said, "mpi": said, "memory": said})
    one.check_memory(host, {"memory": said})
    one.check_gl(host)
    examined_host.report([host], False)
    examined_host.report_json([host])
    for _, _, words, _ in host.findings:
        require_line(words)


def versions(_, text):
    ended = mock.Mock(stdout=text.decode(errors="replace"))
    with mock.patch.object(programs, "program", lambda name: __file__), mock.patch("pathlib.Path.is_file", lambda _: True), \
            mock.patch("subprocess.run", lambda *_, **__: ended), refused():
        programs.versions(False)
        programs.versions(True)


def hosts_file(folder, text):
    path = folder.path / "hosts"
    path.write_bytes(text)
    with mock.patch("job.rank_hosts.addresses", return_value=[]), refused():  # a name that no server knows takes a second
        rank_hosts.hosts_of_file(path, 2)
        rank_hosts.spares_of_file(path)
        rank_hosts.slots_of_file(path)
    with mock.patch("job.rank_hosts.addresses", return_value=[]), refused():
        rank_hosts.hosts_of_wall(text.decode(errors="replace"), "wall.toml")


def session_of_try(folder, text):
    """Half of the text is the mark of a session of `try`, and half its journal."""
    session = folder.path / "try" / "one"
    session.mkdir(parents=True, exist_ok=True)
    mark, _, journal = text.partition(b"\n\n")
    (session / "try.json").write_bytes(mark)
    (session / "session.journal").write_bytes(journal)
    lines = []
    ours = journal_origin.Origin(10, 16, "0.2.0")
    with mock.patch.object(try_sessions, "print_line", lines.append), mock.patch.object(journal_origin, "ours", lambda: ours), refused():
        _, claim = try_sessions.claimed_of(session.parent, marks.Scene("dunes", "0"))
        if claim is not None:
            os.close(claim)
    for line in lines:
        require_line(line)


def terrain(folder, text):
    path = folder.path / "terrain"
    path.write_bytes(text)
    with refused():
        kind = kinds.kind_of(path)
        made_scene.text_of(kind, str(path), 0)
    marks.files_of(text, folder.path)


def changed_session_of_try(generator):
    mark = changed_json({"version": 1, "scene": "dunes", "digest": "0"}, generator) if generator.random() < 0.5 else \
        b'{"version": 1, "scene": "dunes", "digest": "0"}'
    return mark + b"\n\n" + changed_bytes(JOURNAL, generator)


def changed_output(generator):
    """Returns lines of a job's standard error: events, mpirun's explanations, and others. Some of them are changed."""
    text = b""
    for _ in range(generator.randint(1, 12)):
        kind = generator.randrange(4)
        if kind == 0:
            line = generator.choice(MPIRUN)
        else:
            event = generator.choice(EVENTS)
            changed = changed_value(event, generator) if kind > 1 else event
            if kind > 1 and isinstance(changed, dict) and generator.random() < 0.8:
                changed["event"] = event["event"]
            line = events.TAG.encode() + json.dumps(changed).encode()
        text += generator.choice((b"", b"[1,2]<stderr>:", b"[1,0]<stderr>:")) + line + b"\n"
    return changed_bytes(text, generator) if generator.random() < 0.3 else text


def changed_output_of_5(generator):
    """Returns the same for Open MPI 5. Lines of ranks on other hosts have rank, length and checksum."""
    text = b""
    for line in changed_output(generator).split(b"\n"):
        if generator.random() < 0.8:
            rank = b"%d" % generator.choice((0, 2, 2, 2, 999999999))
            line = generator.choice((b"@log node02:/tmp/sandwall-rank-2.x", line, line, line))
            line = b"[1,2]<stderr>: @rank %s %d %08x %s" % (rank, len(line), zlib.crc32(rank + b" " + line), line)
        text += line + b"\n"
    return changed_bytes(text, generator) if generator.random() < 0.3 else text


def changed_line(generator):
    return changed_bytes(b"rank 2 on node02 was killed by SIGSEGV\n", generator)


READERS = {
    "failure_file": (failure_file, lambda generator: changed_json(FAILURE, generator)),
    "output_of_job": (output_of_job, changed_output),
    "output_of_open_mpi_5": (output_of_open_mpi_5, changed_output_of_5),
    "summary": (summary, lambda generator: changed_json(SUMMARY, generator)),
    "restarting": (restarting, changed_line),
    "answer_of_master": (answer_of_master, lambda generator: changed_json(generator.choice((STATUS, {"ok": False, "error": "no"})), generator) + b"\n"),
    "answers_to_doctor": (answers_to_doctor, lambda generator: changed_json(generator.choice((VERSION, PROBE)), generator)),
    "versions": (versions, lambda generator: changed_json(VERSION, generator)),
    "session_of_try": (session_of_try, changed_session_of_try),
    "terrain": (terrain, lambda generator: changed_bytes(generator.choice(TERRAINS), generator)),
    "hosts_file": (hosts_file, lambda generator: changed_bytes(HOSTS, generator)),
}


def run(name, seeds):
    """Feeds a reader one input for each seed. Returns the number of inputs, or None after a failure, which it prints."""
    read, make = READERS[name]
    count = 0
    with tempfile.TemporaryDirectory(prefix="sandwall-launcher-") as temporary:
        folder = Folder(pathlib.Path(temporary) / "out")
        for seed in seeds:
            text = make(random.Random(f"{name} {seed}"))
            shown = io.StringIO()
            try:
                with contextlib.redirect_stdout(shown), contextlib.redirect_stderr(shown):
                    read(folder, text)
            except BaseException as failure:  # SystemExit would end the launcher, too
                if isinstance(failure, KeyboardInterrupt):
                    raise
                print(f"{name} failed with the input {text[:400]!r}")
                traceback.print_exc(limit=-6, file=sys.stdout)
                print(f"SANDWALL_SEED={seed} python3 {__file__} begins with it")
                return None
            count += 1
    return count


def seeds_until(first, until):
    seed = first
    while time.monotonic() < until:
        yield seed
        seed += 1


def main():
    first = int(os.environ.get("SANDWALL_SEED", SEED))
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else None
    os.environ[events.VARIABLE] = "1"  # events are written, too
    nowhere = os.open(os.devnull, os.O_WRONLY)
    console.OUT.descriptor = console.ERROR.descriptor = nowhere
    good = True
    for name in READERS:
        seeds = range(first, first + INPUTS) if seconds is None else seeds_until(first, time.monotonic() + seconds / len(READERS))
        count = run(name, seeds)
        good = good and count is not None
        if count is not None:
            print(f"{name}: {count} inputs; SANDWALL_SEED={first}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
