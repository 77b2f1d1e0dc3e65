# SPDX-License-Identifier: Apache-2.0
"""scripts/sandwall with made-up programs, which only print how they were started."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))
BIN = pathlib.Path(os.environ.get("SANDWALL_BIN", ROOT / "build" / "release" / "bin"))

CHECK = """#!/bin/sh
[ "$2" = --ranks ] && exec grep -c . "$1"
[ "$2" = --hosts ] && exec cat "$1"
[ "$2" = --outputs ] && { echo "${MADE_UP_OUTPUTS:-$(grep -c . "$1") 0}"; exit; }
echo "made-up sandwall-check: $*" >&2
exit 2
"""
SAY = """#!/bin/sh
echo "rank ${OMPI_COMM_WORLD_RANK:-none} on ${MADE_UP_HOST:-here} threads ${LP_NUM_THREADS:-none}: ${0##*/} $*"
"""
# Replaces ssh: the host is the first word. Open MPI's daemons would make the same folders and map the same files on one
# machine, and sometimes a daemon fails because of that. So each made-up host has a folder of its own.
AGENT = """#!/bin/sh
host=$1; shift
case $host in
    away*) echo "ssh: connect to host $host port 22: No route to host" >&2; exit 255 ;;
    bare*) exec sh -c "$(echo "$*" | sed 's,/bin/sandwall-,/bin/none-,g')" ;;
esac
export TMPDIR="${0%/*}/tmp-$host"
mkdir -p "$TMPDIR"
case $(mpirun --version) in # Open MPI 5 needs hosts with names of their own
    *"(Open MPI) 5"*) exec env MADE_UP_HOST="$host" unshare --uts sh -c "hostname $host; $*" ;;
esac
exec env MADE_UP_HOST="$host" sh -c "$*"
"""


class LauncherTest(unittest.TestCase):
    """Tests of the launcher. A wall file of these tests is the list of hosts that sandwall-check would print."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-launcher-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "bin").mkdir()
        self.script("sandwall-check", CHECK)
        for name in ("sandwall-master", "sandwall-render-node", "sandwall-haptic-server"):
            self.script(name, SAY)
        for options in BIN.glob("sandwall-*.json"):  # lists of options of the real programs
            shutil.copy(options, self.folder / "bin")
        self.agent = self.script("agent", AGENT)
        self.write("scene.toml", "")
        for variable in ("SANDWALL_EVENTS", "DISPLAY", "WAYLAND_DISPLAY"):
            os.environ.pop(variable, None)
        self.environment = {**os.environ, "SANDWALL_BIN": str(self.folder / "bin"),
                            "OMPI_MCA_plm_rsh_agent": self.agent,
                            "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return str(self.folder / name)

    def script(self, name, text):
        """Writes a made-up program and returns its path. Each mpirun also answers --version, as Open MPI 4.1 unless the test sets MADE_UP_MPI."""
        if name == "mpirun":
            first, rest = text.split("\n", 1)
            text = f'{first}\nif [ "$*" = --version ]; then echo "mpirun (Open MPI) ${{MADE_UP_MPI:-4.1.4}}"; exit 0; fi\n{rest}'
        path = self.folder / "bin" / name
        path.write_text(text)
        path.chmod(0o755)
        return str(path)

    def command(self, hosts, *options):
        return [str(ROOT / "scripts" / "sandwall"), "run", "--wall", self.write("wall", "\n".join(hosts) + "\n"),
                "--scene", str(self.folder / "scene.toml"), "--out", str(self.folder / "out"), *options]

    def start(self, hosts, *options, **popen):
        return subprocess.run(self.command(hosts, *options), env=self.environment, text=True, capture_output=True,
                              timeout=120, **{"stdin": subprocess.DEVNULL, **popen})

    def printed(self, hosts, *options):
        """Returns the commands that --print-command prints for a session, for Open MPI 4.1 unless a test says otherwise."""
        if not (self.folder / "bin" / "mpirun").exists():
            self.script("mpirun", "#!/bin/sh\n")
        ended = self.start(hosts, "--print-command", *options)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        return ended.stdout.replace(str(self.folder / "bin") + "/", "").replace(str(self.folder) + "/", "")

    def refused(self, hosts, *options, status=2):
        """Returns the error line with which a session is refused."""
        ended = self.start(hosts, *options)
        self.assertEqual((ended.returncode, ended.stdout), (status, ""), ended.stderr)
        self.assertEqual(ended.stderr.count("\n"), 1, ended.stderr)
        self.assertRegex(ended.stderr, "^sandwall( run)?: ")
        return ended.stderr.replace(str(self.folder) + "/", "")
