# SPDX-License-Identifier: Apache-2.0
"""scripts/sandwall run with a made-up mpirun that fails as a test asks."""

import re
import socket
import subprocess
import time

from launcher_fixture import LauncherTest

# Records its command. Runs the script try_n at its n-th start.
MPIRUN = """#!/bin/bash
folder=$(dirname "$0")/..
n=$(($(cat "$folder/tries" 2>/dev/null || echo 0) + 1)); echo $n > "$folder/tries"
echo "$*" >> "$folder/commands"
say() { echo "[1,$1]<stdout>:$2"; }
complain() { echo "[1,$1]<stderr>:$2" >&2; }
event() { complain "$1" "@sandwall $2"; }
progress() {
    mkdir -p "$folder/out"; echo "$n" > "$folder/out/session.journal"; say 0 "a line of progress"
    event 0 '{"event":"progress","frame":'$1',"step":'$2',"fps":60.0,"skew_us":9.0,"hand":"no hand"}'
}
hung() { event $1 '{"event":"waiting","by":'$1',"frame":8,"ranks":['$2'],"names":"'"$3"'","seconds":3.0,"limit":3,"ends_job":true}'; }
line=--------------------------------------------------------------------------
banner() { printf '%s\\n' $line "$@" $line >&2; }
dies() { banner "Primary job  terminated normally"; banner "mpirun noticed that process rank $1 with PID 0 on node $2 exited on signal $3 (Made Up)."; exit $((128 + $3)); }
ends() { banner "mpirun detected that one or more processes exited" "" "  Process name: [[5156,1],$1]" "  Exit code:    $2"; exit $2; }
told() { mkdir -p "$folder/out"; echo "$1" > "$folder/out/failure.json"; }
. "$folder/try_$n"
"""
HOST = socket.gethostname()
CONTINUES = re.compile(r"sandwall: `\S*sandwall run --resume .*` continues with this sand\n\Z")


def without_command(error):
    """Returns the lines of a session without the last one, which names the command that continues it (resume_command_test.py)."""
    return CONTINUES.sub("", error)


class Supervised(LauncherTest):
    def setUp(self):
        super().setUp()
        self.script("mpirun", MPIRUN)

    def tries(self, *texts):
        """Sets the scripts that mpirun runs at its first, second and later starts."""
        for number, text in enumerate(texts, start=1):
            self.write(f"try_{number}", text)

    def commands(self):
        return (self.folder / "commands").read_text().splitlines()

    def ended(self, hosts, *options):
        ended = self.start(hosts, *options)
        return ended.returncode, ended.stdout, without_command(ended.stderr).replace(str(self.folder) + "/", "")

    def wait_for(self, what, condition):
        deadline = time.monotonic() + 60
        while not condition():
            self.assertLess(time.monotonic(), deadline, f"no {what}")
            time.sleep(0.01)

    def begin(self, hosts, *options):
        process = subprocess.Popen(self.command(hosts, *options), env=self.environment, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.kill)
        return process
