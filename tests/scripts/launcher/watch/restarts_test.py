#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests how scripts/sandwall run names a rank or mpirun that has ended, starts the session again, and finally gives
up."""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from supervisor_fixture import HOST, Supervised
from base import events
from hosts import reachable
from job import job_log, open_mpi
from watch import supervisor


class Restarts(Supervised):
    def test_a_rank_that_dies_is_named_and_the_session_goes_on(self):
        self.tries("progress 7 6; complain 2 'last words'; dies 2 host 11", "progress 9 8; exit 0")
        before = time.monotonic()
        status, printed, error = self.ended(["-", "-"])
        self.assertEqual((status, printed), (0, "a line of progress\n" * 2))
        self.assertEqual(error, f"last words\nsandwall: rank 2 on {HOST} was killed by SIGSEGV; "
                         "starting again (1 of --restarts 3 in --restart-window 60)\n")
        first, second = self.commands()
        self.assertNotIn("--resume", first)
        found = re.search(rf" --resume --failed-at (\S+) --failed-on=(\S+) --failed-before (\S+) --failure=rank 2 on {HOST} was killed by SIGSEGV "
                          "--failed-rank 2 --failed-how SIGSEGV : -n 2 ", second)
        self.assertTrue(before - 0.001 <= float(found[1]) <= time.monotonic(), second)
        self.assertEqual(found[2], reachable.identity_here(), "the machine of this clock")
        self.assertGreaterEqual(float(found[3]), 0)

    def test_the_master_is_called_so(self):
        self.tries("progress 7 6; dies 0 host 9", "exit 0")
        self.assertIn("sandwall: the master was killed by SIGKILL; starting again", self.ended(["-"])[2])

    def test_a_rank_that_ends_by_itself_is_named_with_its_status(self):
        self.tries("progress 7 6; ends 1 3", "exit 0")
        self.assertIn(f"sandwall: rank 1 on {HOST} ended with status 3; starting again", self.ended(["-"])[2])

    def test_who_hung_is_told_by_the_last_words_of_the_watchdog(self):
        self.tries("progress 7 6; hung 0 2 'rank 2 (tile b) on x'; ends 0 1",
                   "progress 9 8; hung 1 0 'the master'; ends 1 1", "exit 0")
        error = self.ended(["-", "-"])[2]
        self.assertIn("sandwall: rank 2 (tile b) on x hung; starting again", error)
        self.assertIn("sandwall: the master hung; starting again", error)

    def test_an_mpirun_that_waits_for_a_host_that_has_gone_is_killed(self):
        self.tries("""progress 7 6; trap '' TERM; hung 0 2 'rank 2 (tile b) on x'; while :; do sleep 0.1; done""", "exit 0")
        status, _, error = self.ended(["-", "-"])
        self.assertEqual(status, 0, error)
        self.assertIn("sandwall: rank 2 (tile b) on x hung; starting again", error)

    def test_what_the_master_has_written_down_goes_before_what_mpirun_noticed(self):
        self.tries("""progress 7 6; told '{"what": "hung", "rank": 1, "host": "x", "tile": "a", "message": "in other words"}'; ends 0 1""", "exit 0")
        self.assertIn("sandwall: rank 1 (tile a) on x hung; starting again", self.ended(["-"])[2])
        self.assertFalse((self.folder / "out" / "failure.json").exists(), "the next try would find it again")

    def test_a_failure_that_could_not_be_written_is_read_from_its_event(self):
        failure = '{"what":"broken","rank":1,"host":"x","tile":"a","message":"rank 1 sent garbage"}'
        self.tries(f"""progress 7 6; event 0 '{{"event":"failure","failure":{failure}}}'; ends 0 1""", "exit 0")
        self.assertIn("sandwall: rank 1 sent garbage; starting again", self.ended(["-"])[2])
        self.assertIn(" --failed-rank 1 --failed-how broken ", self.commands()[1])

    def test_a_session_that_ended_in_order_is_not_started_again(self):
        failure = '{"what":"%s","rank":-1,"host":"","tile":"","message":"so"}'
        end = """progress 7 6; event 0 '{"event":"failure","failure":%s}'; ends 0 1"""
        self.tries(*(end % (failure % what) for what in ("sand", "summary")), "exit 0")
        for started in (1, 2):
            status, _, error = self.ended(["-"])
            self.assertEqual((status, len(self.commands())), (1, started), error)
            self.assertNotIn("starting again", error)

    def test_a_damaged_failure_file_does_not_stop_the_launcher(self):
        nested = "[" * 60000
        self.tries(f"progress 7 6; told '{nested}'; dies 1 host 9", """progress 9 8; told '{"what": "broken", "rank": 1e400}'; dies 1 host 9""",
                   """progress 9 8; event 0 '{"event":"failure","failure":[3]}'; event 0 '{"event":"progress"}'; dies 1 host 9""", "exit 0")
        status, _, error = self.ended(["-"])
        self.assertEqual((status, len(self.commands())), (0, 4), error)

    def test_the_text_of_a_failure_is_one_word_for_the_master(self):
        self.tries(r"""progress 7 6; told '{"what": "disk", "rank": -1, "message": "--help\u0000\n\ud800 me"}'; ends 0 1""", "exit 0")
        status, _, error = self.ended(["-"])
        self.assertEqual(status, 0, error)
        self.assertIn(" --failure=--help? ? me --failed-how disk ", self.commands()[1])

    def test_events_are_shown_to_whom_asks_for_them_alone(self):
        self.tries("progress 7 6; dies 1 host 9", "exit 0")
        self.environment["SANDWALL_EVENTS"] = "1"
        found = [found for line in self.ended(["-"])[2].splitlines() if (found := events.parse(line))]
        self.assertEqual([event["event"] for event in found], ["progress", "restart"])
        self.assertEqual((found[1]["rank"], found[1]["how"], found[1]["count"], found[1]["limit"]), (1, "SIGKILL", 1, 3))

    def test_a_killed_mpirun_is_named(self):
        self.tries("progress 7 6; kill -KILL $$", "exit 0")
        self.assertIn("sandwall: mpirun was killed by SIGKILL; starting again", self.ended(["-"])[2])

    def test_an_orderly_end_and_bad_input_are_ends(self):
        for status in (0, 2):
            self.tries(f"complain 0 'that was it'; exit {status}")
            self.assertEqual(self.ended(["-"]), (status, "", "that was it\n"))
            (self.folder / "tries").unlink()

    def test_without_restarts_the_first_failure_is_the_end(self):
        self.tries("echo said; dies 1 host 11")
        status, printed, _ = self.ended(["-"], "--restarts", "0")
        self.assertEqual((status, printed.splitlines()[0]), (139, "said"))
        self.assertIn("-q --oversubscribe", self.commands()[0])
        self.assertFalse((self.folder / "out" / "log").exists())

    def test_a_journal_of_another_session_is_not_gone_on_with(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "session.journal").write_text("yesterday's")
        self.tries("dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"])[0], 0)
        self.assertNotIn("--resume", self.commands()[1])

    def test_a_session_is_resumed_by_hand(self):
        self.tries("dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"], "--resume")[0], 0)
        first, second = self.commands()
        self.assertRegex(first, r"--resume : ")
        self.assertRegex(second, r"--resume --failed-at ")

    def test_a_scene_is_needed_but_for_what_the_journal_tells(self):
        self.tries("exit 0")
        command = self.command(["-"], "--resume")
        at = command.index("--scene")
        command[at:at + 2] = []
        self.assertEqual(subprocess.run(command, env=self.environment, timeout=120, stdin=subprocess.DEVNULL).returncode, 0)
        self.assertNotIn("--scene", self.commands()[0])
        refused = subprocess.run([*command, "--device", "script:gis"], env=self.environment, timeout=120, text=True,
                                 capture_output=True, stdin=subprocess.DEVNULL)
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (2, 1), refused.stderr)
        self.assertTrue(refused.stderr.startswith("sandwall: --scene: "), refused.stderr)


class GivenUp(Supervised):
    def test_the_report_names_who_died_of_what_where_and_when_with_last_words(self):
        text = "progress {0}7 {0}6; complain 1 'words of try {0}'; dies 1 host 6"
        self.tries(*(text.format(number) for number in (1, 2, 3)))
        status, _, error = self.ended(["-"], "--restarts", "2", "--restart-window", "600")
        self.assertEqual((status, len(self.commands())), (1, 3))
        report = error[error.index("sandwall: the session is given up"):]
        self.assertIn("more failures than --restarts 2 in --restart-window 600 allows", report)
        for number in (1, 2, 3):
            self.assertRegex(report, rf"\d\d:\d\d:\d\d  rank 1 on {HOST} was killed by SIGABRT; shown: frame {number}7, step {number}6\n"
                             rf" +\| words of try {number}\n")
        self.assertEqual(report, (self.folder / "out/log/report.txt").read_text().replace(str(self.folder) + "/", ""))
        self.assertIn("words of try 2", (self.folder / "out/log/try_2.err").read_text())

    def test_tries_without_a_frame_are_counted_whatever_the_window(self):
        self.tries(*["sleep 0.3; dies 1 host 6"] * 3)
        status, _, error = self.ended(["-"], "--restarts", "1", "--restart-window", "0.1")
        self.assertEqual((status, len(self.commands())), (1, 2), error)

    def test_the_same_failure_twice_before_a_frame_is_the_end(self):
        self.tries(*["complain 1 'process 4711 has no room'; dies 1 host 6"] * 9)
        status, _, error = self.ended(["-"], "--restarts", "5")
        self.assertEqual((status, len(self.commands())), (1, 2), error)
        self.assertIn("sandwall: the session is given up: the same failure twice before the first frame", error)
        found = [json.loads(line)["restarted"] for line in (self.folder / "out/failures.jsonl").read_text().splitlines()]
        self.assertEqual(found, [True, False])

    def test_mpirun_that_refuses_twice_is_the_end(self):
        self.tries(*["banner 'There is no room for process 4711'; exit 213"] * 9)
        status, _, error = self.ended(["-"], "--restarts", "5")
        self.assertEqual((status, len(self.commands())), (1, 2), error)
        self.assertIn("There is no room for process 4711", error)

    def test_failures_that_differ_or_come_from_outside_are_not_the_same(self):
        for number, texts in enumerate((["complain 1 one; dies 1 host 6", "complain 1 two; dies 1 host 6"], ["dies 1 host 6", "dies 2 host 6"],
                                        ["dies 1 host 9", "dies 1 host 9"], ["dies 1 host 6", "progress 2 1; dies 1 host 6"])):
            with self.subTest(number):
                (self.folder / "tries").unlink(missing_ok=True)
                self.tries(*texts, "exit 0")
                self.assertEqual(self.ended(["-", "-"])[0], 0)

    def test_failures_far_apart_are_not_counted_together(self):
        self.tries(*["progress 2 1; sleep 0.3; dies 1 host 6"] * 3, "exit 0")
        status, _, error = self.ended(["-"], "--restarts", "1", "--restart-window", "0.1")
        self.assertEqual((status, len(self.commands())), (0, 4), error)

    def test_only_so_many_logs_are_kept(self):
        self.tries(*["progress 2 1; dies 1 host 6"] * 11, "exit 0")
        self.assertEqual(self.ended(["-"], "--restarts", "20", "--restart-window", "0.001")[0], 0)
        kept = sorted(int(path.stem[4:]) for path in (self.folder / "out/log").glob("try_*.err"))
        self.assertEqual(kept, list(range(5, 13)))


class Waits(unittest.TestCase):
    """The waits before restarts that docs/recovery.md names, on a clock that only sleep() and the test move."""

    def setUp(self):
        self.now, self.stop = 1000.0, mock.Mock(count=0)
        for name, fake in (("monotonic", lambda: self.now), ("sleep", self.sleep)):
            patched = mock.patch(f"time.{name}", fake)
            patched.start()
            self.addCleanup(patched.stop)

    def sleep(self, seconds):
        self.now += seconds

    def supervisor(self, restarts=20, window=60):
        return supervisor.Supervisor("", None, None, None, None, None, mock.Mock(restarts=restarts, restart_window=window), self.stop)

    def test_the_first_restart_comes_at_once_and_each_further_one_later(self):
        allowance = supervisor.Allowance(20, 60)
        waits = []
        for _ in range(7):
            self.assertTrue(allowance.take(showed_a_frame=True))
            waits.append(allowance.wait())
        self.assertEqual(waits, [0, 1, 2, 4, 8, 8, 8])
        self.now += 60
        self.assertTrue(allowance.take(showed_a_frame=True))
        self.assertEqual(allowance.wait(), 8, "a restart counts for the whole window")
        self.now += 60.5
        self.assertTrue(allowance.take(showed_a_frame=True))
        self.assertEqual(allowance.wait(), 0, "the window has passed")

    def test_restarts_without_a_frame_count_whatever_the_window(self):
        allowance = supervisor.Allowance(20, 60)
        waits = []
        for showed_a_frame in (True, False, False, False, True, False):
            allowance.take(showed_a_frame)
            waits.append(allowance.wait())
            self.now += 1000
        self.assertEqual(waits, [0, 0, 1, 2, 0, 0])

    def test_as_many_restarts_as_the_option_says_are_allowed(self):
        for restarts in (1, 3):
            for showed_a_frame in (True, False):
                allowance = supervisor.Allowance(restarts, 60)
                self.assertEqual([allowance.take(showed_a_frame) for _ in range(restarts + 2)], [True] * restarts + [False] * 2)

    def test_the_launcher_waits_so_long_before_it_starts_the_job_again(self):
        watched = self.supervisor()
        for seconds in (0, 1, 2, 4, 8, 8):
            watched.allowance.take(showed_a_frame=True)
            before = self.now
            watched.pause()
            self.assertAlmostEqual(self.now - before, seconds, delta=0.1, msg="it looks for signals twenty times in a second")
        self.stop.count = 1
        before = self.now
        watched.pause()
        self.assertEqual(self.now, before, "a signal ends the wait")

    def test_the_haptic_server_is_started_again_after_the_same_waits(self):
        with tempfile.TemporaryDirectory(prefix="sandwall-waits-") as folder:
            log = job_log.JobLog(folder, 1, open_mpi.OpenMpi4("4.1.4"))
            self.addCleanup(log.close)
            watched = self.supervisor()
            watched.failed = mock.Mock()
            server = mock.Mock(**{"process.poll.return_value": -11})
            watched.watch = watched.watch_of(server)
            for seconds in (0, 1, 2, 4, 8, 8):
                server.start.reset_mock()
                watched.look_after_server(log)  # finds that the server has ended
                if seconds > 0:
                    self.now += seconds - 0.01
                    watched.look_after_server(log)
                    self.assertFalse(server.start.called, f"too early for {seconds} s")
                    self.now += 0.01
                watched.look_after_server(log)
                server.start.assert_called_once()


if __name__ == "__main__":
    unittest.main()
