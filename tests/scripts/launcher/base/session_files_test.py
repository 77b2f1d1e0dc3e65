#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which folders and files the launcher uses for a session, and that its programs do not survive it."""

import os
import pathlib
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from launcher_fixture import ROOT
from supervisor_fixture import Supervised
from ask import session_results
from base import process_marks, session_folder
from base.bad_input import BadInput
from job import processes


NOBODY = 65534


class Summary(unittest.TestCase):
    """The summary of a session, read by session_results.summary_of()."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "summary.json"

    def refusal(self, path):
        with self.assertRaises(BadInput) as refused:
            session_results.summary_of(path)
        return str(refused.exception).replace(str(self.folder) + "/", "")

    def test_a_link_to_another_summary_is_not_followed(self):
        (self.folder / "other").write_text("{}")
        self.file.symlink_to("other")
        for named in (self.folder, self.folder / "session.journal"):
            self.assertEqual(self.refusal(named), "summary.json: is a link, which is not followed; name the summary.json of a session itself")
        self.assertIn("the summary has version 0", self.refusal(self.file))  # a user has named the link itself

    def test_pipes_and_folders_are_no_summary(self):
        line = "summary.json: is not a regular file; name the summary.json of a session itself"
        os.mkfifo(self.file)
        self.assertEqual((self.refusal(self.folder), self.refusal(self.file)), (line, line))
        self.file.unlink()
        self.file.mkdir()
        self.assertEqual(self.refusal(self.folder), line)
        self.file.rmdir()
        self.assertEqual(self.refusal(self.folder), "summary.json: cannot be read (No such file or directory); the session has not ended in order")


class Folder(Supervised):
    def setUp(self):
        super().setUp()
        self.tries("exit 0")
        self.out = self.folder / "out"
        self.out.mkdir()

    def test_a_folder_that_others_may_write_to_is_refused(self):
        for mode in (0o775, 0o757, 0o777):
            self.out.chmod(mode)
            self.assertEqual(self.refused(["-"]), "sandwall: out: other users may write to it; run chmod go-w on it, or choose another --out\n")
        self.out.chmod(0o755)
        self.assertEqual(self.ended(["-"])[0], 0)

    def test_a_link_to_such_a_folder_is_refused(self):
        self.out.rename(self.folder / "real")
        self.out.symlink_to(self.folder / "real")
        self.assertEqual(self.ended(["-"])[0], 0)
        (self.folder / "real").chmod(0o777)
        self.assertIn("out: other users may write to it", self.refused(["-"]))

    @unittest.skipIf(os.geteuid() != 0, "only root can give a folder to another user")
    def test_a_folder_or_link_of_another_user_is_refused(self):
        os.chown(self.out, 1, 1)
        self.assertEqual(self.refused(["-"]), "sandwall: out: belongs to another user; choose another --out\n")
        self.out.rename(self.folder / "real")
        self.out.symlink_to(self.folder / "real")
        self.assertEqual(self.refused(["-"]), "sandwall: out: leads to a folder of another user; choose another --out\n")
        os.chown(self.folder / "real", 0, 0)
        os.lchown(self.out, 1, 1)
        self.assertEqual(self.refused(["-"]), "sandwall: out: is a link of another user; choose another --out\n")

    def test_a_folder_that_cannot_be_written_is_refused(self):
        for resume, advice in ((False, "choose another --out"), (True, "a resumed session writes its journal there, so make it writable")):
            with mock.patch("os.access", return_value=False), self.assertRaises(BadInput) as refused, session_folder.held(self.out, resume):
                pass
            self.assertEqual(str(refused.exception), f"{self.out}: cannot be written; {advice}")

    def test_a_film_is_refused_too(self):
        self.out.chmod(0o777)
        journal = self.write("session.journal", "")
        command = [str(ROOT / "scripts" / "sandwall"), "film", journal, "--wall", self.write("wall", "-\n"), "--out", str(self.out)]
        ended = subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
        self.assertEqual((ended.returncode, ended.stderr.count("\n")), (2, 1), ended.stderr)
        self.assertIn("out: other users may write to it", ended.stderr)

    def test_new_folders_survive_a_power_loss_and_are_writable_for_this_user_alone(self):
        synced = []
        made = self.folder / "a" / "b" / "c"
        with mock.patch("os.fsync", lambda descriptor: synced.append(os.readlink(f"/proc/self/fd/{descriptor}"))):
            before = os.umask(0o002)
            self.addCleanup(os.umask, before)
            with session_folder.held(made):
                pass
        self.assertEqual(synced, [str(self.folder), str(self.folder / "a"), str(self.folder / "a" / "b")])
        for folder in (made, made.parent, made.parent.parent):
            self.assertEqual(stat.S_IMODE(folder.stat().st_mode), 0o755, folder)

    def test_a_pipe_in_the_folder_does_not_stop_the_launcher(self):
        self.tries("progress 7 6; dies 1 host 9", "exit 0")
        os.mkfifo(self.out / "failure.json")
        (self.out / "log").mkdir()
        os.mkfifo(self.out / "log" / "report.txt")
        status, printed, error = self.ended(["-"], "--resume")
        self.assertEqual((status, printed), (0, "a line of progress\n"), error)
        self.tries("dies 1 host 9", "dies 1 host 9")
        (self.folder / "tries").unlink()
        self.assertEqual(self.ended(["-"], "--resume", "--restarts", "1")[0], 1)

    def test_a_new_session_replaces_no_pipe(self):
        self.tries("exit 0")
        pipes = [self.out / name for name in ("log", "failure.json", "failures.jsonl")]
        for pipe in pipes:
            os.mkfifo(pipe)
        self.assertEqual(self.ended(["-"], "--restarts", "1")[0], 0)
        for pipe in pipes:
            self.assertTrue(pipe.is_fifo(), pipe)


    def complaint(self):
        """Returns the line about what an earlier session left in the folder. It is the same as that of the launcher."""
        with self.assertRaises(BadInput) as refused, session_folder.held(self.out, resume=True):
            pass
        return str(refused.exception).replace(str(self.folder) + "/", "")

    def test_what_an_earlier_session_left_is_refused_if_others_may_change_it(self):
        for name in ("log", "checkpoints", "saves"):
            (self.out / name).mkdir()
            (self.out / name / "file").write_text("x")
        for name in ("session.journal.2", *session_folder.CONTINUED):
            (self.out / name).write_text("x")
        for entry in ["session.journal.2", *session_folder.CONTINUED, *(f"{name}{end}" for name in ("log", "checkpoints", "saves") for end in ("", "/file"))]:
            path = self.out / entry
            mode = stat.S_IMODE(path.stat().st_mode)
            for bit in (stat.S_IWGRP, stat.S_IWOTH):
                path.chmod(mode | bit)
                self.assertEqual(self.complaint(), f"out/{entry}: other users may write to it; run chmod -R go-w on the session's folder, "
                                 "or choose another --out")
            path.chmod(mode)
            if os.geteuid() == 0:
                os.chown(path, NOBODY, NOBODY)
                self.assertEqual(self.complaint(), f"out/{entry}: belongs to another user; remove it, or choose another --out")
                os.chown(path, 0, 0)
            path.rename(self.folder / "real")
            path.symlink_to(self.folder / "real")
            if entry not in session_folder.CONTINUED:  # such a link is never followed, and may stay
                self.assertEqual(self.complaint(), f"out/{entry}: is a link, and a session follows none in its folder; remove it, or choose another --out")
            path.unlink()
            (self.folder / "real").rename(path)
        with session_folder.held(self.out):
            pass

    def test_a_session_that_is_refused_for_what_is_in_its_folder_has_written_nothing(self):
        (self.out / "log").mkdir()
        (self.out / "log").chmod(0o777)
        (self.out / "log" / "try_1.out").write_text("of an earlier session")
        for options in ([], ["--resume"]):
            self.assertEqual(self.refused(["-"], *options), f"sandwall: {self.complaint()}\n")
        self.assertEqual([str(path.relative_to(self.out)) for path in sorted(self.out.rglob("*"))], ["log", "log/try_1.out"])
        self.assertEqual((self.out / "log" / "try_1.out").read_text(), "of an earlier session")
        self.assertFalse((self.folder / "tries").exists(), "mpirun was started")


class Umasks(Supervised):
    def test_no_file_of_the_launcher_is_writable_for_others_whatever_the_umask(self):
        for umask, file_mode, folder_mode in ((0o000, 0o644, 0o755), (0o022, 0o644, 0o755), (0o077, 0o600, 0o700)):
            out = self.folder / "out"
            shutil.rmtree(out, ignore_errors=True)
            (self.folder / "tries").unlink(missing_ok=True)
            self.tries("progress 7 6; dies 1 host 9", 'cat "$folder/out/log/restarting" > "$folder/why"; stat -c %a "$folder/out/log/restarting" >> "$folder/why"; dies 1 host 9')
            ended = self.start(["-"], "--restarts", "1", umask=umask)
            self.assertEqual(ended.returncode, 1, ended.stderr)
            self.assertEqual((self.folder / "why").read_text().split("\n")[1], f"{file_mode:o}")
            for folder in (out, out / "log"):
                self.assertEqual(stat.S_IMODE(folder.stat().st_mode), folder_mode, folder)
            files = list((out / "log").iterdir())
            self.assertEqual({file.name for file in files}, {"report.txt", "try_1.err", "try_1.out", "try_2.err", "try_2.out"})
            for file in [*files, out / "session.journal"]:  # mpirun inherits the umask, and so do the ranks
                self.assertEqual(stat.S_IMODE(file.stat().st_mode), file_mode, file)

    @unittest.skipIf(os.geteuid() != 0, "only root can become another user")
    def test_another_user_can_neither_write_to_a_session_nor_put_a_link_into_it(self):
        self.folder.chmod(0o755)  # so that the other user reaches the session's folder
        self.tries(f'setpriv --reuid={NOBODY} --regid={NOBODY} --clear-groups sh -c "cd $folder/out && for place in . log; do '
                   'ln -s /etc/passwd \\$place/restarting; ln -s /etc/passwd \\$place/made; done; echo x >> log/try_1.err; echo x >> log/try_1.out; echo ended > /dev/null; '
                   'id -u" > "$folder/user" 2>/dev/null; ls -A "$folder/out" "$folder/out/log" > "$folder/listed"; exit 0')
        ended = self.start(["-"], umask=0)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual((self.folder / "user").read_text().strip(), str(NOBODY), "the other user did nothing")
        listed = (self.folder / "listed").read_text()
        self.assertNotIn("made", listed)
        self.assertNotIn("restarting", listed)
        self.assertEqual((self.folder / "out" / "log" / "try_1.out").read_text(), "")


class Others(unittest.TestCase):
    MARK = "1-1-0123456789abcdef"

    def begin(self, mark, **options):
        process = subprocess.Popen(["sleep", "100"], env={"PATH": os.environ["PATH"], processes.MARK: mark}, **options)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_only_processes_of_this_session_are_ended(self):
        ours, longer = self.begin(self.MARK), self.begin(self.MARK + "0")
        self.assertEqual(process_marks.marked(f"{processes.MARK}={self.MARK}".encode()), [ours.pid])
        self.end_all()
        self.assertEqual((ours.wait(60), longer.poll()), (-signal.SIGKILL, None))

    @unittest.skipIf(os.geteuid() != 0, "only root can become another user")
    def test_a_process_of_another_user_with_the_mark_of_the_session_is_not_ended(self):
        ours, theirs = self.begin(self.MARK), self.begin(self.MARK, user=NOBODY, group=NOBODY, extra_groups=[])
        self.end_all()
        self.assertEqual((ours.wait(60), theirs.poll()), (-signal.SIGKILL, None))

    def end_all(self):
        """Ends what is left of a job with the mark, at once."""
        job = object.__new__(processes.Job)
        job.mark = self.MARK
        with mock.patch.object(processes, "KILL_SECONDS", 0):
            job.clear()  # the environment of an ended process is empty


class Orphans(Supervised):
    def test_a_child_whose_parent_ended_before_it_could_ask_for_the_signal_ends(self):
        read, write = os.pipe()
        parent = os.fork()
        if parent == 0:  # the launcher, which ends while its child begins
            dying = os.getpid()
            if os.fork() == 0:
                while os.getppid() == dying:
                    pass
                try:
                    processes.die_with(dying)()
                finally:
                    os.write(write, b"survived")
                    os._exit(0)
            os._exit(0)
        os.close(write)
        os.waitpid(parent, 0)
        self.assertEqual(os.read(read, 100), b"")
        os.close(read)

    def test_an_mpirun_whose_launcher_ends_at_once_gets_the_end_of_its_input(self):
        self.tries('kill -KILL $PPID; cat > "$folder/input"; echo ended > "$folder/end"')
        launcher = self.begin(["-"])
        launcher.wait(60)
        self.wait_for("end", (self.folder / "end").exists)
        self.assertEqual((self.folder / "input").read_text(), "")


class ReadText(unittest.TestCase):
    def test_only_regular_files_are_read(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "text").write_text("sand")
            self.assertEqual(session_folder.read_text(folder / "text"), "sand")
            os.mkfifo(folder / "pipe")
            session_folder.write_text(folder / "text", "a name: \udcff")  # a file's name need not be UTF-8
            self.assertEqual((folder / "text").read_bytes(), b"a name: \xff")
            for other in (folder / "pipe", folder, folder / "none"):
                with self.assertRaises(OSError):
                    session_folder.read_text(other)


if __name__ == "__main__":
    unittest.main()
