# SPDX-License-Identifier: Apache-2.0
"""The schemas of docs/schemas, and sessions of the real programs to validate."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from sample_scene import SCENE
import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCHEMAS = ROOT / "docs" / "schemas"
sys.path.insert(0, str(ROOT / "scripts" / "launcher"))

from base import events

WALL = """[viewer]
eye = [0.0, 1.6, 2.0]
[stereo]
mode = "mono"
[grid]
rows = 1
columns = 2
tile_size = [1.024, 0.768]
tile_pixels = [64, 48]
lower_left = [-1.024, 0.9, 0.0]
[stage]
centre = [0.0, 1.25, -0.3]
width = 1.6
tilt_deg = 40
"""


def load(name):
    return json.loads((SCHEMAS / f"{name}.schema.json").read_text())


def validator(name):
    """Returns the validator of the schema with this name. The files that it references are in the same folder."""
    schema = load(name)
    return jsonschema.Draft7Validator(schema, resolver=jsonschema.RefResolver(f"{SCHEMAS.as_uri()}/{name}.schema.json", schema))


class SchemaTest(unittest.TestCase):
    def valid(self, name, value):
        faults = [f"{'/'.join(map(str, fault.absolute_path))}: {fault.message}" for fault in validator(name).iter_errors(value)]
        self.assertEqual(faults, [], f"{name}.schema.json does not describe {json.dumps(value)}")

    def invalid(self, name, value):
        self.assertFalse(validator(name).is_valid(value), f"{name}.schema.json accepts {json.dumps(value)}")


class SessionTest(SchemaTest):
    """Tests with sessions of two render ranks on this machine."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-schema-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "wall.toml").write_text(WALL)
        (self.folder / "scene.toml").write_text(SCENE)
        self.out, self.log = self.folder / "out", self.folder / "log.txt"

    def command(self, *options):
        return [ROOT / "scripts" / "sandwall", "run", "--wall", self.folder / "wall.toml", "--scene", self.folder / "scene.toml",
                "--out", self.out, "--gl", "osmesa", "--no-pictures", *options]

    def start(self, *options):
        with self.log.open("wb") as log:
            process = subprocess.Popen(self.command(*options), stdin=subprocess.PIPE, stdout=log, stderr=log,
                                       env={**os.environ, events.VARIABLE: "1"})
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        process.stdin.close()
        if process.poll() is None:
            process.terminate()
            process.wait(120)

    def await_event(self, process, name, **fields):
        event = events.wait_for(self.log, name, 120, lambda: process.poll() is None, **fields)
        self.assertIsNotNone(event, f"no event {name} {fields} in:\n{self.log.read_text(errors='replace')}")
        return event

    def in_order(self, session):
        """The session must end in order. On a busy machine the hand lacks force, so the line `force` alone may be BAD."""
        status = session.wait(120)
        bad = self.await_event(session, "report")["bad"]
        self.assertIn((status, bad), ((0, []), (1, ["force"])), self.log.read_text())

    def events_by_name(self):
        """Returns all events of the session by name, and checks each against its schema. They may come from several
        processes."""
        found = {}
        for line in self.log.read_text().splitlines():
            if events.TAG in line:
                self.assertTrue(line.startswith(events.TAG), line)
                event = events.parse(line)
                self.assertIsNotNone(event, line)
                self.valid("event", event)
                found.setdefault(event["event"], []).append(event)
        return found
