#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What scripts/sandwall run does when the haptic server dies."""

import unittest

from supervisor_fixture import Supervised

SERVER = """#!/bin/bash
folder=$(dirname "$0")/..
echo "$*" >> "$folder/servers"
while [ "$1" != --port-file ]; do [ "$1" = --listen ] && listen=$2; shift; done
port=${listen##*:}; [ "$port" = 0 ] && port=4711
echo $$ > "$folder/server.pid"
echo $port > "$2.new"; mv "$2.new" "$2"
trap 'exit 0' TERM
while :; do sleep 0.05; done
"""


class Server(Supervised):
    def setUp(self):
        super().setUp()
        self.script("sandwall-haptic-server", SERVER)

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
        self.assertIn("--listen 127.0.0.1:4711 ", second)
        self.assertIn("/ticks.csv ", first)
        self.assertIn("/ticks_2.csv ", second)
        self.assertIn("sandwall: the haptic server died of SIGSEGV; starting again (1 of ", error)

    def test_a_job_that_is_started_again_finds_the_same_server(self):
        self.tries("progress 1 1; dies 1 host 9", "exit 0")
        self.assertEqual(self.ended(["-"], "--device", "script:gis")[0], 0)
        self.assertEqual(len(self.servers()), 1)
        for command in self.commands():
            self.assertIn("--haptic 127.0.0.1:4711 ", command)

    def test_one_that_dies_too_often_ends_the_session_in_order(self):
        # A read with a time limit of its own would lose a word that arrives in two parts.
        self.tries("""progress 5 4; while sleep 0.1; do kill -KILL $(cat "$folder/server.pid"); done &
read -r line; kill $!; echo "told: $line"; exit 0""")
        status, printed, error = self.ended(["-"], "--device", "script:gis", "--restarts", "2", "--restart-window", "600")
        self.assertEqual((status, len(self.servers()), printed.splitlines()[-1]), (1, 3, "told: stop"), error)
        self.assertIn("sandwall: the session is given up", error)
        self.assertEqual(error.count("the haptic server died of SIGKILL; shown: frame 5, step 4"), 3, error)


if __name__ == "__main__":
    unittest.main()
