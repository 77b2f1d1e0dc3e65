# SPDX-License-Identifier: Apache-2.0
"""Makes the films that people mark in a running session, beside it and one at a time (docs/film.md)."""

import collections
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import time

from ask.session_report import launcher
from base import checked_json
from base.console import print_line
from job.processes import die_with

MOST_WAITING = 8
NICE = 19
LOOK_SECONDS = 0.05
END_SECONDS = 10  # in which a film ends in order when it is left
FOLDER = re.compile(r"film_\d{3,9}")
MOST_STEPS = 1 << 62
RESULT = re.compile(r".*: \d+ frames$|\d+ pictures? in .*")  # a line of film.py


class Film:
    """A marked film: its folder, and the command that makes it."""

    def __init__(self, event, out, wall, stereo):
        self.folder = pathlib.Path(out) / event["folder"]
        self.seconds = event["seconds"]
        self.words = [launcher(), "film", str(out), "--wall", str(wall), "--from", str(event["from"]), "--to", str(event["to"])]
        self.words += ["--view", event["view"]] if event["view"] else []
        self.words += ["--stereo", stereo] if stereo else []
        self.words += ["--out", str(self.folder)]

    def command(self):
        return shlex.join(self.words)


def event_is_valid(event):
    """Returns whether an event `film` is as docs/schemas/event.schema.json says."""
    steps = [checked_json.whole(event.get(key), 0, MOST_STEPS) for key in ("from", "to")]
    view, folder, seconds = (event.get(key) for key in ("view", "folder", "seconds"))
    return (None not in steps and steps[0] < steps[1] and isinstance(folder, str) and FOLDER.fullmatch(folder) is not None
            and isinstance(seconds, (int, float)) and seconds >= 0
            and (view is None or (isinstance(view, str) and re.fullmatch(r"[0-9][-+.,e0-9]{0,200}", view) is not None)))


class FilmQueue:
    """The films of one session.

    A film is a process of its own at the lowest priority, whose ranks have one thread each. It ends with this process.
    """

    def __init__(self, out, wall, stereo=None):
        self.out, self.wall, self.stereo = out, wall, stereo
        self.waiting = collections.deque()
        self.film = self.process = self.output = None

    def add(self, event):
        """Takes an event `film` of the master. Ignores one that is not valid."""
        if not event_is_valid(event):
            return
        film = Film(event, self.out, self.wall, self.stereo)
        if len(self.waiting) >= MOST_WAITING:
            print_line(f"{film.folder}: {MOST_WAITING} films wait already; `{film.command()}` makes this one")
            return
        self.waiting.append(film)
        self.look()

    def busy(self):
        return self.film is not None or bool(self.waiting)

    def look(self):
        """Reports a film that is ready, and starts the next one."""
        if self.process is not None and self.process.poll() is not None:
            self.report(self.process.returncode)
        if self.process is None and self.waiting:
            self.start(self.waiting.popleft())

    def start(self, film):
        lowest = ["ionice", "-c", "3"] if shutil.which("ionice") else []
        command = [*lowest, *film.words, "--gl-threads", "1", "--sand-threads", "1"]
        self.film, self.output = film, tempfile.TemporaryFile("w+", errors="replace")
        parent_dies = die_with(os.getpid())

        def prepare():
            parent_dies()
            os.nice(NICE)

        # A session of its own, because Ctrl-C in a terminal asks the session to end and not the film.
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self.output, stderr=subprocess.STDOUT,
                                        start_new_session=True, preexec_fn=prepare)

    def lines(self):
        self.output.seek(0)
        return [line for line in self.output.read().splitlines() if line.strip()]

    def report(self, status):
        """Prints how the film ended, and forgets it."""
        lines, film = self.lines(), self.film
        self.output.close()
        self.film = self.process = self.output = None
        result = [line for line in lines if RESULT.fullmatch(line)]
        if status == 0 and result:
            print_line(f"film of {film.seconds:.1f} s: {self.shown(result[-1], film)}")
            if (film.folder / "film.mp4").is_file():
                for picture in film.folder.glob("frame_[0-9]*.png"):
                    picture.unlink(missing_ok=True)
            return
        said = checked_json.one_line(lines[-1], 300) if lines else f"exit status {status}"
        print_line(f"{film.folder}: the film failed: {said.removeprefix('sandwall: ')}; `{film.command()}` makes it again")

    def shown(self, line, film):
        """Returns the result of a film. If a video needs ffmpeg, names the whole command."""
        return line.replace("then this command again", f"then `{film.command()}`")

    def finish(self, stop):
        """Finishes all films after the session. A signal leaves them, each with a line that names its command."""
        if self.busy() and stop.count == 0:
            print_line(f"films are still being made: {', '.join(film.folder.name for film in self.all())}; Ctrl-C leaves them")
        while self.busy() and stop.count == 0:
            self.look()
            time.sleep(LOOK_SECONDS)
        self.leave()

    def all(self):
        return [*([self.film] if self.film else []), *self.waiting]

    def leave(self):
        """Ends the film that is being made, and prints the command of each one that is left."""
        if self.process is not None and self.process.poll() is not None:
            self.report(self.process.returncode)
        for film in self.all():
            print_line(f"{film.folder}: the film is not ready; `{film.command()}` makes it")
        if self.process is not None:
            self.process.terminate()  # the film asks its own job to end
            try:
                self.process.wait(END_SECONDS)
            except subprocess.TimeoutExpired:
                self.process.kill()  # job_guard.py then ends the job of the film
                self.process.wait()
            self.output.close()
        self.film = self.process = self.output = None
        self.waiting.clear()
