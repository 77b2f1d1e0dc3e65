#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests how scripts/sandwall run starts the haptic server again after it has ended or hung."""

import json
import pathlib
import signal
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from supervisor_fixture import Supervised
from job import job_log, open_mpi
from watch import supervisor

# Reads its scene as the file `load` of the test says: with the functions `listens` and `ready`.
SERVER = """#!/bin/bash
folder=$(dirname "$0")/..
echo "$*" >> "$folder/servers"
while [ $# -gt 1 ]; do
    case $1 in --listen) listen=$2;; --listening-file) listening=$2;; --port-file) ready=$2;; --scene-error-file) error=$2;; esac
    shift
done
echo "$error" >> "$folder/errors"
port=${listen##*:}; [ "$port" = 0 ] && port=4711
echo $$ > "$folder/server.pid"
write() { echo "$2" > "$1.new"; mv "$1.new" "$1"; }
listens() { write "$listening" $port; }
ready() { write "$ready" $port; }
trap 'exit 0' TERM
if [ -e "$folder/load" ]; then . "$folder/load"; else listens; ready; fi
while :; do sleep 0.05; done
"""


class Server(Supervised):
    def setUp(self):
        super().setUp()
        self.script("sandwall-haptic-server", SERVER)

    def loads(self, script):
        (self.folder / "load").write_text(script + "\n")

    def servers(self):
        path = self.folder / "servers"
        return path.read_text().splitlines() if path.exists() else []

    def test_it_is_started_again_on_its_port_while_the_wall_goes_on(self):
        self.tries("""progress 1 1; kill -SEGV $(cat "$folder/server.pid")
until [ $(wc -l < "$folder/servers") = 2 ]; do sleep 0.05; done; exit 0""")
        status, _, error = self.ended(["-"], "--device", "script:gis", "--record", str(self.folder / "ticks.csv"))
        self.assertEqual((status, len(self.commands())), (0, 1), error)
        first, second = self.servers()
        self.assertIn("--listen 127.0.0.1:0 ", first)
        self.assertIn(" --die-with-parent", first)
        self.assertIn("--listen 127.0.0.1:4711 ", second)
        self.assertIn("/ticks.csv ", first)
        self.assertIn("/ticks_2.csv ", second)
        self.assertIn("sandwall: the haptic server was killed by SIGSEGV; starting again (1 of ", error)

    def test_its_restart_is_a_recovery_as_soon_as_the_hand_is_linked(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "recoveries.jsonl").write_text('{"torn": ')
        self.tries("""progress 1 1; kill -SEGV $(cat "$folder/server.pid")
until [ $(wc -l < "$folder/servers") = 2 ]; do sleep 0.05; done
cp "$folder/out/recoveries.jsonl" "$folder/before"; progress 31 30
event 0 '{"event":"link","state":"linked","epoch":3,"server":"x"}'
until [ $(wc -l < "$folder/out/recoveries.jsonl") = 2 ]; do sleep 0.05; done; exit 0""")
        status, _, error = self.ended(["-"], "--device", "script:gis", "--resume")
        self.assertEqual(status, 0, error)
        self.assertEqual((self.folder / "before").read_text(), '{"torn": ', "the hand is not linked yet")
        torn, line = (self.folder / "out" / "recoveries.jsonl").read_text().splitlines()
        self.assertEqual(torn, '{"torn": ')
        recovery = json.loads(line)
        self.assertGreaterEqual(recovery.pop("seconds_to_link"), 0)
        self.assertEqual(recovery, {"failure": "the haptic server was killed by SIGSEGV", "failed_rank": None, "failed_how": "SIGSEGV",
                                    "seconds_to_next_frame": None, "step": 30, "frame": 31, "state_hash": None,
                                    "checkpoint_step": None, "replayed_steps": None, "cut_bytes": None})

    def test_a_job_that_is_started_again_finds_the_same_server(self):
        self.tries("progress 1 1; dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"], "--device", "script:gis")[0], 0)
        self.assertEqual(len(self.servers()), 1)
        for command in self.commands():
            self.assertIn("--haptic 127.0.0.1:4711 ", command)

    def test_a_job_that_is_started_again_keeps_the_operators_share_of_the_force(self):
        self.tries("event 0 '{\"event\":\"force\",\"share\":0.25}'; event 0 '{\"event\":\"force\",\"share\":0}'; progress 1 1; dies 1 host 9",
                   "progress 2 2; dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"], "--device", "script:gis")[0], 0)
        first, second, third = self.commands()
        self.assertNotIn("--force-share", first)
        self.assertIn(" --force-share 0 ", second)
        self.assertIn(" --force-share 0 ", third)

    def test_an_option_of_resume_replaces_the_share_of_the_session_until_an_operator_sets_another(self):
        for words, share in ((["--force", "off"], "0"), (["--force-scale", "0.5"], "0.5"), (["--force", "on"], "1"),
                             (["--force", "off", "--force-scale", "0.5"], "0")):
            (self.folder / "tries").unlink(missing_ok=True)
            self.tries("progress 1 1; dies 1 host 9", "event 0 '{\"event\":\"force\",\"share\":0.125}'; progress 2 2; dies 1 host 9", "exit 0")
            self.assertEqual(self.ended(["-"], "--device", "script:gis", "--resume", *words)[0], 0)
            first, second, third = self.commands()[-3:]
            self.assertIn(f" --force-share {share} ", first)
            self.assertIn(f" --force-share {share} ", second)
            self.assertIn(" --force-share 0.125 ", third)

    def test_one_that_dies_too_often_ends_the_session_in_order(self):
        # mpirun reads without a time limit of its own, because it would lose a line that arrives in two parts. The first
        # server dies after the launcher has read of the frame.
        self.tries("""progress 5 4; until grep -qs '"frame":5,' "$folder"/out/log/*.err; do sleep 0.05; done
while sleep 0.1; do kill -KILL $(cat "$folder/server.pid"); done &
read -r line; kill $!; echo "told: $line"; exit 0""")
        status, printed, error = self.ended(["-"], "--device", "script:gis", "--restarts", "2", "--restart-window", "600")
        self.assertEqual((status, len(self.servers())), (1, 3), error)
        self.assertIn("told: stop\n", printed)
        self.assertIn("sandwall: the session is given up", error)
        self.assertEqual(error.count("the haptic server was killed by SIGKILL; shown: frame 5, step 4"), 3, error)

    def test_the_job_starts_beside_a_server_that_reads_a_large_scene(self):
        self.loads("listens")
        self.tries("progress 1 1; exit 0")
        status, _, error = self.ended(["-"], "--device", "script:gis")
        self.assertEqual((status, len(self.commands()), len(self.servers())), (0, 1, 1), error)
        self.assertIn("--haptic 127.0.0.1:4711 ", self.commands()[0])

    def test_a_scene_that_the_server_refuses_soon_is_one_line_and_no_job(self):
        self.loads('write "$error" "scene.toml:3: no"; listens; exit 2')
        self.tries("exit 0")
        self.assertEqual(self.ended(["-"], "--device", "script:gis"), (2, "", "sandwall: scene.toml:3: no\n"))
        self.assertFalse((self.folder / "commands").exists())

    def test_one_that_is_killed_before_it_listens_is_named(self):
        self.loads("kill -KILL $$")
        self.tries("exit 0")
        self.assertEqual(self.ended(["-"], "--device", "script:gis"),
                         (1, "", "sandwall: the haptic server was killed by signal 9 before it had read the scene\n"))

    def test_one_ctrl_c_ends_a_start_before_the_server_listens(self):
        self.loads("touch $folder/began; exec sleep 15")
        self.tries("exit 0")
        process = self.begin(["-"], "--device", "script:gis")
        self.wait_for("server", (self.folder / "began").exists)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.communicate(timeout=60), ("", "sandwall: stopped before the first frame\n"))
        self.assertEqual(process.returncode, 0)
        self.assertFalse((self.folder / "commands").exists(), "no job was started")

    def test_a_scene_that_both_refuse_is_the_masters_line_alone(self):
        self.loads('listens; sleep 1.5; write "$error" "scene.toml:3: no"; exit 2')
        self.tries("sleep 2; complain 0 'scene.toml:3: no'; exit 2")
        self.assertEqual(self.ended(["-"], "--device", "script:gis"), (2, "", "scene.toml:3: no\n"))
        self.assertEqual(len(self.servers()), 1)

    def test_without_restarts_the_line_comes_at_the_end_unless_the_master_has_printed_it(self):
        self.loads('listens; sleep 1.5; write "$error" "scene.toml:3: no"; exit 2')
        gone = 'until [ -e "$(tail -1 "$folder/errors")" ]; do sleep 0.05; done; sleep 0.5; '
        for end, printed in (("echo 'scene.toml:3: no' >&2; exit 2", "scene.toml:3: no\n"), ("exit 0", "sandwall: scene.toml:3: no\n")):
            (self.folder / "tries").unlink(missing_ok=True)
            self.tries(gone + end)
            status, _, error = self.ended(["-"], "--device", "script:gis", "--restarts", "0")
            self.assertEqual((status, error), (2 if "exit 2" in end else 0, printed))

    def test_a_scene_that_the_server_alone_refuses_ends_the_session(self):
        self.loads('listens; sleep 1.5; write "$error" "scene.toml: it needs more memory"; exit 2')
        self.tries("sleep 2; progress 1 1; read -r line; echo \"told: $line\"; exit 0")
        status, printed, error = self.ended(["-"], "--device", "script:gis")
        self.assertEqual((status, len(self.servers())), (2, 1), error)
        self.assertIn("told: stop\n", printed)
        self.assertEqual(error.count("sandwall: scene.toml: it needs more memory\n"), 1, error)

    def test_a_server_that_refuses_its_device_late_is_not_started_again(self):
        self.loads("listens; sleep 1.5; echo 'sandwall-haptic-server: --device: no' >&2; exit 2")
        self.tries("progress 1 1; read -r line; exit 0")
        status, _, error = self.ended(["-"], "--device", "script:gis")
        self.assertEqual((status, len(self.servers())), (2, 1), error)
        self.assertEqual(error.count("--device: no"), 1, error)


class HungServer(unittest.TestCase):
    """A server that runs but is not linked, with a clock that the test moves."""

    def setUp(self):
        self.now = 1000.0
        patched = mock.patch("time.monotonic", lambda: self.now)
        patched.start()
        self.addCleanup(patched.stop)
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-hung-")
        self.addCleanup(temporary.cleanup)
        self.log = job_log.JobLog(temporary.name, 1, open_mpi.OpenMpi4("4.1.4"))
        self.addCleanup(self.log.close)
        self.server = mock.Mock(**{"process.poll.return_value": None, "is_ready.return_value": True, "scene_error.return_value": None, "starts": 1})
        self.watched = supervisor.Supervisor(temporary.name, None, open_mpi.OpenMpi4("4.1.4"), None, None, None, mock.Mock(restarts=3, restart_window=60), mock.Mock())
        self.watched.watch = self.watched.watch_of(self.server)

    def event(self, name, **fields):
        self.log.read_event({"event": name, **fields})

    def wall_goes_on(self, seconds, hand="no hand"):
        """Lets the wall run for `seconds` seconds: each has a progress event and one look of the launcher. Returns
        true if the server was killed."""
        for _ in range(seconds):
            self.now += 1
            self.event("progress", frame=1, step=1, fps=60.0, skew_us=0.0, hand=hand)
            self.watched.look_after_server(self.log)
        return self.server.process.kill.called

    def end(self):
        """Lets the killed process end, and starts the server again after the wait for it."""
        self.server.process.kill.reset_mock()
        self.server.process.poll.return_value = -9
        self.watched.look_after_server(self.log)
        self.assertTrue(self.watched.failures[-1].text.endswith("was hung"))
        self.now = self.watched.watch.due
        self.watched.look_after_server(self.log)  # starts the server
        self.server.start.assert_called_once()
        self.server.process.poll.return_value = None

    def test_one_that_was_linked_is_killed_ten_seconds_after_its_link(self):
        self.assertFalse(self.wall_goes_on(30, "hand linked"))
        self.assertFalse(self.wall_goes_on(10))
        self.assertTrue(self.wall_goes_on(1))

    def test_one_that_never_answers_is_killed_ten_seconds_after_the_wall_has_gone_on(self):
        self.assertFalse(self.wall_goes_on(60, "waiting for a hand"))
        self.event("without_hand", reason="no_server", epoch=1)
        self.assertFalse(self.wall_goes_on(10))
        self.assertTrue(self.wall_goes_on(1))

    def test_one_that_refuses_is_not_hung(self):
        self.event("link", state="refused", epoch=0, server="x")
        self.event("without_hand", reason="refused", epoch=1)
        self.event("without_hand", reason="no_server", epoch=2)
        self.assertFalse(self.wall_goes_on(60))

    def test_one_that_reads_its_scene_is_not_hung(self):
        self.wall_goes_on(5, "hand linked")
        self.assertTrue(self.wall_goes_on(11))
        self.server.is_ready.return_value = False
        self.end()
        self.event("link", state="loading", epoch=2, server="x", share=0.1)
        self.assertFalse(self.wall_goes_on(300))
        self.event("link", state="lost", epoch=2, server="x")
        self.assertFalse(self.wall_goes_on(5))
        self.event("link", state="loading", epoch=2, server="x", share=0.2)
        self.assertFalse(self.wall_goes_on(300), "it has got further")
        self.event("link", state="lost", epoch=2, server="x")
        self.event("link", state="loading", epoch=2, server="x", share=0.2)
        self.assertFalse(self.wall_goes_on(10))
        self.assertTrue(self.wall_goes_on(1), "it gets no further")

    def test_one_whose_progress_goes_back_gets_no_further(self):
        self.wall_goes_on(5, "hand linked")
        self.event("link", state="loading", epoch=2, server="x", share=0.5)
        self.event("link", state="lost", epoch=2, server="x")
        self.assertFalse(self.wall_goes_on(5))
        for share in (0.1, 0.4, 0.5, -1, 2, "all", None):
            self.event("link", state="loading", epoch=2, server="x", share=share)
            self.event("link", state="lost", epoch=2, server="x")
        self.assertFalse(self.wall_goes_on(5))
        self.assertTrue(self.wall_goes_on(1))

    def test_while_the_wall_stands_nobody_is_hung(self):
        self.wall_goes_on(5, "hand linked")
        self.now += 60
        self.watched.look_after_server(self.log)
        self.assertFalse(self.server.process.kill.called)

    def test_one_that_was_started_again_and_never_answers_is_killed_too(self):
        self.wall_goes_on(5, "hand linked")
        self.assertTrue(self.wall_goes_on(11))
        self.server.is_ready.return_value = False
        self.end()
        self.assertFalse(self.wall_goes_on(120), "a server may need a long time to read a large scene")
        self.server.is_ready.return_value = True
        self.assertFalse(self.wall_goes_on(11))
        self.assertTrue(self.wall_goes_on(1))

    def test_one_that_was_started_again_and_refuses_is_left_alone(self):
        self.wall_goes_on(5, "hand linked")
        self.assertTrue(self.wall_goes_on(11))
        self.end()
        self.event("link", state="refused", epoch=2, server="x")
        self.assertFalse(self.wall_goes_on(60))


if __name__ == "__main__":
    unittest.main()
