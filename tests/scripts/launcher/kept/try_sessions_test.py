#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which sand `sandwall try` continues, and which sessions it keeps."""

import contextlib
import errno
import fcntl
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import journal_begin
from launcher_fixture import ROOT  # noqa: F401  (names the launcher's folder)
from base import journal_origin
from base.bad_input import BadInput
from kept import marks, try_choice, try_sessions

WRITING, DUNES = marks.Scene("writing", "1"), marks.Scene("dunes", "1")
STAYS = "; its sand stays there"


class SessionsTest(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory(prefix="sandwall-try-"))
        self.enterContext(contextlib.chdir(folder))
        self.lines = []
        self.enterContext(mock.patch.object(try_sessions, "print_line", self.lines.append))
        self.enterContext(mock.patch.object(journal_origin, "ours", lambda: journal_origin.Origin(10, 16, "0.2.0")))
        self.root = pathlib.Path("out/try")
        self.now = 1000

    def choose(self, scene=WRITING, new=False, running=False, journal=journal_begin.OURS):
        """Chooses as `try` does, and digs. Returns the Choice. `self.lines` has what was printed."""
        self.lines.clear()
        choice = try_choice.below_root(scene, new)
        if choice.begins:
            (pathlib.Path(choice.out) / "session.journal").write_bytes(journal)
        self.now += 1
        os.utime(pathlib.Path(choice.out) / "session.journal", (self.now, self.now))
        if not running:
            try_choice.give_up(choice)
        try_choice.make_room(choice)
        return choice

    def names(self):
        return {path.name for path in self.root.iterdir()}


class Continued(SessionsTest):
    def test_the_newest_sand_of_the_scene_is_continued(self):
        first = self.choose()
        second = self.choose(new=True)
        dunes = self.choose(DUNES)
        self.assertEqual(len({first.out, second.out, dunes.out}), 3)
        self.assertEqual(self.choose(), (second.out, False, mock.ANY))
        self.assertEqual(self.choose(DUNES).out, dunes.out)
        self.assertEqual(self.lines, [])
        (pathlib.Path(first.out) / "session.journal.2").write_bytes(b"")  # a later part of the journal is the newest file
        self.assertEqual(self.choose().out, first.out)

    def test_a_scene_that_has_changed_begins_with_new_sand(self):
        first = self.choose()
        second = self.choose(marks.Scene("writing", "2"))
        self.assertTrue(second.begins)
        self.assertRegex(self.lines.pop(), rf"^{first.out}: has the scene as it was before its file has changed; its sand stays there, and "
                         rf"`\S+ try --out {first.out}` continues it$")

    def test_a_session_that_runs_is_left_alone(self):
        for running in (True, False):
            first = self.choose(new=True, running=running)
            folder = os.open(first.out, os.O_RDONLY)
            if not running:
                fcntl.flock(folder, fcntl.LOCK_EX)  # as the launcher of `run --resume` does
            self.assertTrue(self.choose().begins)
            self.assertEqual(self.lines, [f"{first.out}: another session digs there now, so this one begins with new sand"])
            os.close(folder)
            if running:
                os.close(first.claim)

    def test_a_session_without_a_journal_is_not_continued(self):
        first = self.choose()
        (pathlib.Path(first.out) / "session.journal").unlink()
        self.assertTrue(self.choose().begins)

    def test_a_folder_that_a_person_has_made_is_not_continued(self):
        first = self.choose()
        (pathlib.Path(first.out) / "try.json").unlink()
        self.assertTrue(self.choose().begins)
        self.assertEqual(self.lines, [])


class Refused(SessionsTest):
    def expect_stays(self, folder, why, **choose):
        """Expects that the session is left as it is, with one line."""
        before = {path: path.read_bytes() for path in pathlib.Path(folder).iterdir() if path.is_file()}
        choice = self.choose(**choose)
        self.assertNotEqual(choice.out, folder)
        self.assertEqual(self.lines, [f"{folder}: {why}{STAYS}"])
        self.assertEqual({path: path.read_bytes() for path in before}, before)
        return choice

    def test_a_session_of_another_algorithm_names_the_release_that_reads_it(self):
        first = self.choose(journal=journal_begin.of(11, 17, b"0.3.0"))
        self.expect_stays(first.out, "written by sandwall 0.3.0 (journal format 11, algorithm 17); this is 0.2.0 (format 10, algorithm 16): "
                                     "use sandwall 0.3.0")
        other = self.choose(DUNES, journal=journal_begin.of(10, 15, b"0.2.0"))
        self.expect_stays(other.out, "written by sandwall 0.2.0 (journal format 10, algorithm 15); this is 0.2.0 (format 10, algorithm 16): "
                                     "another build of 0.2.0 wrote it, or it is damaged", scene=DUNES)

    def test_a_damaged_session_is_passed_over_and_an_older_one_is_continued(self):
        good = self.choose()
        damaged = pathlib.Path(self.choose(new=True).out)
        for journal, why in ((b"", "it does not begin as a journal does"), (journal_begin.OURS[:9], "it is cut off in its first bytes"),
                             (journal_begin.OURS[:12] + b"\xff\xff\xff\xff0.2.0", "it names no release"),
                             (journal_begin.of(10, 16, b"0.2\x1b"), "it names no release")):
            (damaged / "session.journal").write_bytes(journal)
            self.assertEqual(self.expect_stays(str(damaged), f"its journal is damaged: {why}").out, good.out)
            os.utime(damaged / "session.journal", (9999, 9999))

    def test_a_damaged_mark_is_one_line(self):
        folder = self.choose().out
        for mark in ("", "[]", "{", '{"version": 1, "scene": 5, "digest": ""}', '{"version": 2, "scene": "writing", "digest": ""}', "[" * 9999):
            (pathlib.Path(folder) / "try.json").write_text(mark)
            os.utime(pathlib.Path(folder) / "session.journal", (9999, 9999))
            self.expect_stays(folder, "its try.json is damaged")

    def test_a_link_in_a_session_is_not_followed(self):
        folder = self.choose().out
        (pathlib.Path(folder) / "log").symlink_to("/tmp")
        self.expect_stays(folder, f"{folder}/log: is a link, and a session follows none in its folder; remove it, or choose another --out")

    @unittest.skipIf(os.geteuid() != 0, "only root can give a folder to another user")
    def test_a_session_of_another_user_stays_and_a_root_of_another_user_is_refused(self):
        folder = self.choose().out
        os.chown(folder, 12345, 12345)
        self.expect_stays(folder, "belongs to another user")
        os.chown(self.root, 12345, 12345)
        for new in (True, False):
            with self.assertRaisesRegex(BadInput, "^out/try: belongs to another user; choose another --out$"):
                self.choose(new=new)

    def test_a_folder_that_cannot_be_made_is_one_line(self):
        pathlib.Path("out").write_text("a file")
        for new, why in ((False, "^out/try: is not a folder, and --out must be one; choose another$"),
                         (True, r"^out/try/writing-\S+: cannot be made \(Not a directory\); make room, or choose another --out$")):
            with self.assertRaisesRegex(BadInput, why):
                self.choose(new=new)
        pathlib.Path("out").unlink()
        for refused, reason in (("mkdir", errno.EACCES), ("mkdir", errno.EROFS)):
            with mock.patch.object(pathlib.Path, refused, side_effect=OSError(reason, os.strerror(reason))), \
                    self.assertRaisesRegex(BadInput, rf"cannot be made \({os.strerror(reason)}\); make room, or choose another --out$"):
                self.choose()

    def test_a_full_disk_leaves_no_folder(self):
        self.choose()
        before = self.names()
        with mock.patch.object(marks, "write", side_effect=OSError(errno.ENOSPC, "No space left on device")), \
                self.assertRaisesRegex(BadInput, r"cannot be made \(No space left on device\); make room, or choose another --out$"):
            self.choose(new=True)
        self.assertEqual(self.names(), before)


class Room(SessionsTest):
    def many(self, count, **choose):
        """Digs in this number of new sessions. Returns their folders, the oldest first, as long as they all stay."""
        with mock.patch.object(try_sessions, "MOST_SESSIONS", 1000):
            return [self.choose(DUNES, new=True, **choose).out for _ in range(count)]

    def test_the_ten_newest_stay_and_each_one_that_goes_is_named(self):
        folders = self.many(12)
        new = self.choose(new=True).out
        self.assertEqual(self.names(), {os.path.basename(path) for path in [*folders[3:], new]})
        self.assertEqual(sorted(self.lines), sorted(f"{path}: is removed, because only the 10 newest sessions stay; a session that you move to another "
                                                    "folder is kept" for path in folders[:3]))

    def test_the_oldest_go_when_all_together_are_too_large(self):
        folders = self.many(3)
        for folder in folders:
            (pathlib.Path(folder) / "wall.png").write_bytes(bytes(1 << 20))
        size = try_sessions.Kept(folders[0], DUNES).bytes()
        self.assertGreaterEqual(size, 1 << 20)
        with mock.patch.object(try_sessions, "MOST_BYTES", 2 * size + 4096):
            self.choose(DUNES)
        self.assertEqual(self.lines, [f"{folders[0]}: is removed, because the sessions may have 2 GB together; a session that you move to another folder "
                                      "is kept"])
        with mock.patch.object(try_sessions, "MOST_BYTES", 1):
            self.assertEqual(self.choose(DUNES).out, folders[2], "the newest stays, however large it is")
        self.assertEqual(self.names(), {os.path.basename(folders[2])})

    def test_starts_that_have_failed_push_no_sand_out(self):
        sand = self.many(2)
        for _ in range(12):
            failed = pathlib.Path(self.many(1)[0])
            (failed / "session.journal").unlink()
            (failed / "log").mkdir()
        self.choose(new=True)
        self.assertEqual(self.lines, [])
        self.assertTrue(all(os.path.exists(path) for path in sand))

    def test_without_locks_nothing_is_removed_and_the_newest_sand_is_continued(self):
        folders = self.many(11)
        with mock.patch.object(marks.fcntl, "flock", side_effect=OSError(errno.ENOLCK, "No locks available")):
            self.assertEqual(self.choose(DUNES).out, folders[-1])
        self.assertEqual(self.lines, [])
        self.assertTrue(all(os.path.exists(path) for path in folders))

    def test_the_session_that_is_continued_and_one_that_runs_never_go(self):
        old = self.choose().out
        running = self.choose(marks.Scene("ripples", "1"), running=True)
        self.many(12)
        self.assertEqual(self.choose().out, old)
        self.assertTrue(os.path.exists(running.out))
        os.close(running.claim)

    def test_what_is_not_a_session_of_this_release_stays_and_does_not_count(self):
        other, = self.many(1, journal=journal_begin.of(11, 17, b"0.3.0"))
        mine, linked = self.many(2)
        (pathlib.Path(mine) / "try.json").unlink()
        pathlib.Path(linked).rename("elsewhere")
        pathlib.Path(linked).symlink_to(os.path.abspath("elsewhere"))
        folders = self.many(9)
        self.choose()
        self.assertEqual(self.lines, [f"{other}: written by sandwall 0.3.0 (journal format 11, algorithm 17); this is 0.2.0 (format 10, algorithm 16): "
                                      "use sandwall 0.3.0; it stays, although only the 10 newest sessions stay"])
        self.assertTrue(all(os.path.exists(path) for path in (other, mine, "elsewhere/session.journal", *folders)))

    def test_links_in_a_session_lead_to_no_removal(self):
        pathlib.Path("victim").mkdir()
        pathlib.Path("victim/file").write_text("of a person")
        folders = self.many(11)
        (pathlib.Path(folders[0]) / "pictures").symlink_to(os.path.abspath("victim"))
        self.choose(DUNES)
        self.assertFalse(os.path.exists(folders[0]))
        self.assertEqual(pathlib.Path("victim/file").read_text(), "of a person")

    def test_a_session_that_cannot_be_removed_is_one_line_and_is_tried_again(self):
        folders = self.many(11)
        with mock.patch.object(pathlib.Path, "unlink", side_effect=PermissionError(errno.EACCES, "Permission denied")):
            self.choose(DUNES)
        self.assertEqual(self.lines, [f"{folders[0]}: cannot be removed (Permission denied); only the 10 newest sessions stay"])
        self.choose(DUNES)
        self.assertFalse(os.path.exists(folders[0]))


class Marks(SessionsTest):
    def test_a_scene_has_changed_if_its_text_or_a_file_of_its_terrain_has(self):
        text = '[terrain]\nkind = "dem"\nfile = "valley.asc"\n'
        digests = set()
        for scene, valley in ((text, "1"), (text + "#", "1"), (text, "12"), (text, None), ("not = toml =", "1")):
            pathlib.Path("scene.toml").write_text(scene)
            pathlib.Path("valley.asc").unlink(missing_ok=True)
            if valley:
                pathlib.Path("valley.asc").write_text(valley)
                os.utime("valley.asc", (1, 1))
            found = marks.scene_of("scene.toml")
            self.assertEqual(found, marks.scene_of(os.path.abspath("scene.toml")))
            digests.add(found.digest)
        self.assertEqual(len(digests), 5)

    def test_terrain_is_known_by_its_size_and_time_and_a_photo_by_its_option(self):
        pathlib.Path("valley.tif").write_text("1")
        digests = {marks.scene_of("valley.tif", made).digest for made in (("dem", False), ("photo", True))}
        os.utime("valley.tif", (1, 1))
        digests.add(marks.scene_of("valley.tif", ("dem", False)).digest)
        self.assertEqual(len(digests), 3)

    def test_a_sample_has_its_name_wherever_the_sources_are(self):
        self.assertEqual(marks.scene_of(ROOT / "scenes" / "dunes.toml").name, "dunes")

    def test_a_scene_that_cannot_be_read_is_one_line(self):
        with self.assertRaisesRegex(BadInput, "^none.toml: cannot be read .*; check the path$"):
            marks.scene_of("none.toml")


if __name__ == "__main__":
    unittest.main()
