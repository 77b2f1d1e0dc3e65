#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the processes that scripts/sandwall film starts, and its film of their pictures."""

import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from launcher_fixture import ROOT, LauncherTest

# Writes three frames to the folder after --out. Then prints its own command line.
MPIRUN = """#!/bin/sh
all="$*"
while [ "$1" != --out ]; do shift; done
mkdir -p "$2"
for n in 1 2 3; do echo "frame $n" > "$2/frame_00000$n.png"; done
echo "mpirun $all"
"""
FFMPEG = """#!/bin/sh
for last; do :; done
echo "$*" > "$last"
"""


class Film(LauncherTest):
    def setUp(self):
        super().setUp()
        self.write("s.journal", "")
        self.script("mpirun", MPIRUN)
        # Only programs that the launcher itself needs are on the path, because this machine may have ffmpeg.
        for name in ("env", "python3", "sh", "mkdir", "grep", "cat"):
            for folder in os.environ["PATH"].split(":"):
                if os.path.exists(f"{folder}/{name}"):
                    os.symlink(f"{folder}/{name}", self.folder / "bin" / name)
                    break
        self.environment["PATH"] = str(self.folder / "bin")

    def film(self, *options, hosts=("-", "node1")):
        ended = subprocess.run([str(ROOT / "scripts" / "sandwall"), "film", "s.journal", "--wall",
                                self.write("wall", "\n".join(hosts) + "\n"), "--out", str(self.folder / "out %d"), *options],
                               cwd=self.folder, env=self.environment, text=True, capture_output=True, timeout=120, stdin=subprocess.DEVNULL)
        return (ended.returncode, ended.stdout.replace(str(self.folder) + "/", "").replace("bin/", ""),
                ended.stderr.replace(str(self.folder) + "/", ""))

    def test_every_rank_is_here_whatever_hosts_the_wall_names(self):
        status, printed, error = self.film("--stereo", "side_by_side", "--fps", "25")
        self.assertEqual((status, error), (0, ""))
        master, node = printed.split("\n")[0].split(" : ")
        self.assertTrue(master.endswith("-n 1 sandwall-master --replay s.journal --film --wall wall --out out %d --no-report "
                                        "--control-stdin --frame-timeout 60 --stereo side_by_side --track none --fps 25"), master)
        self.assertEqual(node, "-n 2 sandwall-render-node --gl osmesa")

    def test_without_ffmpeg_the_pictures_are_the_film(self):
        status, printed, error = self.film()
        self.assertEqual((status, error), (0, ""))
        self.assertEqual(printed.split("\n")[1],
                         "3 pictures in out %d; for film.mp4 ffmpeg is missing: run scripts/install_dependencies.sh --with-film, then this command again")
        self.assertFalse((self.folder / "out %d" / "film.mp4").exists())

    def test_with_ffmpeg_there_is_one_file_at_the_films_rate(self):
        self.script("ffmpeg", FFMPEG)
        status, printed, error = self.film("--fps", "24")
        self.assertEqual((status, error), (0, ""))
        self.assertEqual(printed.split("\n")[1], "out %d/film.mp4: 3 frames")
        words = (self.folder / "out %d" / "film.mp4").read_text()
        self.assertIn("-framerate 24 -i frame_%06d.png ", words)
        self.assertIn("-c:v libx264 -crf 18 -pix_fmt yuv420p film.mp4", words)

    def test_a_film_follows_no_link_and_replaces_no_pipe(self):
        self.script("ffmpeg", FFMPEG)
        self.write("other", "of another program")
        film = self.folder / "out %d" / "film.mp4"
        film.parent.mkdir()
        for make in (lambda: film.symlink_to(self.folder / "other"), lambda: os.mkfifo(film)):
            make()
            self.assertEqual(self.film()[::2], (2, "sandwall: out %d/film.mp4: is not a regular file; remove it; the 3 pictures are whole\n"))
            film.unlink()
        self.assertEqual((self.folder / "other").read_text(), "of another program")

    def test_a_film_takes_the_place_of_one_to_which_other_users_may_write(self):
        self.script("ffmpeg", FFMPEG)
        film = self.folder / "out %d" / "film.mp4"
        film.parent.mkdir()
        film.touch()
        film.chmod(0o666)
        self.assertEqual(self.film()[0], 0)
        self.assertEqual(film.stat().st_mode & 0o022, 0)

    def test_a_film_that_ffmpeg_cannot_write_is_one_line(self):
        self.script("ffmpeg", "#!/bin/sh\necho half > film.mp4; echo first >&2; echo No space left >&2; exit 1\n")
        status, _, error = self.film()
        self.assertEqual((status, error),
                         (2, "sandwall: out %d/film.mp4: ffmpeg failed: No space left; the 3 pictures are whole\n"))
        self.assertFalse((self.folder / "out %d" / "film.mp4").exists())

    def test_a_replay_that_fails_becomes_no_film(self):
        self.script("ffmpeg", FFMPEG)
        self.script("mpirun", MPIRUN + "exit 2\n")
        self.assertEqual(self.film()[0], 2)
        self.assertFalse((self.folder / "out %d" / "film.mp4").exists())

    def test_a_rate_of_no_frames_is_refused(self):
        self.assertEqual(self.film("--fps", "0"), (2, "", "sandwall film: argument --fps: 0 must be from 1 to 240; try --help\n"))

    def test_a_journal_that_is_missing_is_refused(self):
        (self.folder / "s.journal").unlink()
        refusal = (2, "", "sandwall: s.journal: cannot be read (No such file or directory); check the path\n")
        self.assertEqual(self.film(), refusal)
        self.assertFalse((self.folder / "out %d").exists())
        (self.folder / "s.journal").mkdir()  # a session's folder without a journal
        self.assertEqual(self.film(), (2, "", "sandwall: s.journal/session.journal: cannot be read (No such file or directory); check the path\n"))

    def test_a_link_in_a_sessions_folder_is_refused_and_a_named_one_is_taken(self):
        journal = self.folder / "s.journal"
        journal.rename(self.folder / "other")
        journal.symlink_to("other")
        self.assertEqual(self.film()[0], 0)
        journal.unlink()
        journal.mkdir()
        (self.folder / "other").rename(journal / "session.journal")
        status, printed, _ = self.film()
        self.assertEqual(status, 0)
        self.assertIn("--replay s.journal --film", printed, "the master must know that the folder was named")
        (journal / "session.journal").rename(self.folder / "other")
        (journal / "session.journal").symlink_to(self.folder / "other")
        self.assertEqual(self.film(), (2, "", "sandwall: s.journal/session.journal: is a link, which is not followed; name the journal itself\n"))

    def test_a_wall_that_does_not_pass_the_check_is_refused_in_its_words(self):
        self.script("sandwall-check", "#!/bin/sh\necho 'sandwall-check: wall.toml:3: no' >&2; exit 2\n")
        self.assertEqual(self.film(), (2, "", "sandwall: wall.toml:3: no\n"))


if __name__ == "__main__":
    unittest.main()
