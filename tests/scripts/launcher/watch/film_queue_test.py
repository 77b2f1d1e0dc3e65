#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the queue of films that people mark in a session, with a made-up launcher."""

import pathlib
import sys
import tempfile
import time
import types
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))
from watch import film_queue

EVENT = {"event": "film", "folder": "film_001", "from": 3, "to": 63, "seconds": 1.0, "view": "1,0,0,0,0,0"}
# Notes its words and its priority, and does what the file `plan` says.
LAUNCHER = """#!/bin/sh
for out; do :; done
echo "$* nice=$(nice)" >> "$(dirname "$0")/started"
. "$(dirname "$0")/plan"
"""


class Queue(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
        script = self.folder / "sandwall"
        script.write_text(LAUNCHER)
        script.chmod(0o755)
        self.plan("echo '2 pictures in there; for film.mp4 ffmpeg is missing: run apt-get, then this command again'")
        for patch in (mock.patch.object(film_queue, "launcher", lambda: str(script)),
                      mock.patch.object(film_queue, "print_line", lambda line: self.lines.append(line))):
            patch.start()
            self.addCleanup(patch.stop)
        self.lines = []
        self.stop = types.SimpleNamespace(count=0)
        self.queue = film_queue.FilmQueue(self.folder, "small.toml")
        self.addCleanup(self.queue.leave)

    def plan(self, words):
        (self.folder / "plan").write_text(words + "\n")

    def started(self):
        file = self.folder / "started"
        return file.read_text().splitlines() if file.exists() else []

    def await_started(self, count):
        deadline = time.monotonic() + 60
        while len(self.started()) < count and time.monotonic() < deadline:
            time.sleep(0.02)
        self.assertEqual(len(self.started()), count)

    def test_films_are_made_one_after_the_other_at_low_priority(self):
        self.queue.add(EVENT)
        self.queue.add({**EVENT, "folder": "film_002", "view": None})
        self.await_started(1)
        self.queue.finish(self.stop)
        first, second = self.started()
        self.assertTrue(first.startswith(f"film {self.folder} --wall small.toml --from 3 --to 63 --view 1,0,0,0,0,0 --out {self.folder}/film_001 "), first)
        self.assertNotIn("--view", second)
        for line in (first, second):
            self.assertIn("--gl-threads 1 --sand-threads 1", line)
            self.assertGreaterEqual(int(line.rpartition("nice=")[2]), 19)
        command = f"{self.folder}/sandwall film {self.folder} --wall small.toml --from 3 --to 63 --view 1,0,0,0,0,0 --out {self.folder}/film_001"
        made = f"film of 1.0 s: 2 pictures in there; for film.mp4 ffmpeg is missing: run apt-get, then `{command}`"
        self.assertIn(made, self.lines)
        # The first film may be ready before the session ends.
        still = "film_002" if self.lines[0] == made else "film_001, film_002"
        self.assertIn(f"films are still being made: {still}; Ctrl-C leaves them", self.lines)
        self.assertFalse(self.queue.busy())

    def test_a_video_takes_the_place_of_its_pictures(self):
        made = self.folder / "film_001"
        made.mkdir()
        (made / "frame_000001.png").touch()
        self.plan(f"touch '{made}/film.mp4'; echo '{made}/film.mp4: 1 frames'")
        self.queue.add(EVENT)
        self.queue.finish(self.stop)
        self.assertEqual([path.name for path in made.iterdir()], ["film.mp4"])
        self.assertEqual(self.lines[-1], f"film of 1.0 s: {made}/film.mp4: 1 frames")

    def test_a_film_that_fails_is_one_line(self):
        self.plan("echo 'sandwall: the disk is full' >&2; exit 2")
        self.queue.add(EVENT)
        self.queue.finish(self.stop)
        self.assertRegex(self.lines[-1], f"^{self.folder}/film_001: the film failed: the disk is full; `.*` makes it again$")

    def test_a_signal_leaves_the_films_and_ends_their_process(self):
        self.plan("echo $$ > \"$(dirname \"$0\")/process\"; exec sleep 1000")
        self.queue.add(EVENT)
        self.queue.add({**EVENT, "folder": "film_002"})
        self.await_started(1)
        process = self.queue.process
        self.stop.count = 1
        self.queue.finish(self.stop)
        self.assertIsNotNone(process.poll())
        self.assertEqual(len(self.lines), 2)
        for line, name in zip(self.lines, ("film_001", "film_002")):
            self.assertRegex(line, f"^{self.folder}/{name}: the film is not ready; `.*` makes it$")

    def test_no_more_than_eight_films_wait(self):
        self.plan("exec sleep 1000")
        for number in range(10):
            self.queue.add({**EVENT, "folder": f"film_{number:03}"})
        self.assertEqual(len(self.queue.waiting), 8)
        self.assertRegex(self.lines[-1], f"^{self.folder}/film_009: 8 films wait already; `.*` makes this one$")

    def test_an_event_that_is_not_as_the_schema_says_is_no_film(self):
        for change in ({"folder": "../other"}, {"folder": "film_1/.."}, {"from": -1}, {"from": 63}, {"to": "63"}, {"seconds": None},
                       {"view": "--help"}, {"view": "1; rm"}, {"view": 3}):
            self.queue.add({**EVENT, **change})
        self.assertFalse(self.queue.busy())


if __name__ == "__main__":
    unittest.main()
