#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a Debian package of the build, checks it with lintian, and runs a session from the unpacked package.

usage: package_test.py BUILD
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from sample_scene import SCENE

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = ROOT / "build" / "release"


def called(*words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL, **options)


def osmesa():
    """Returns whether the build has the backend osmesa."""
    return (BUILD / "bin" / "sandwall-gl-osmesa.so").exists()


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="sandwall-package-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        made = called(ROOT / "scripts" / "package.sh", "--build", BUILD, "--out", cls.folder / "made")
        if made.returncode != 0:
            raise AssertionError(made.stdout + made.stderr)
        cls.package = pathlib.Path(made.stdout.strip())
        cls.tree = cls.folder / "another root"  # the tree must work in any folder
        unpacked = called("dpkg-deb", "-x", cls.package, cls.tree)
        if unpacked.returncode != 0:
            raise AssertionError(unpacked.stderr)
        cls.prefix = cls.tree / "usr"
        # The unpacked programs must not find those of the build, or a display.
        cls.environment = {key: value for key, value in os.environ.items() if key not in ("SANDWALL_BIN", "DISPLAY", "WAYLAND_DISPLAY")}

    def sandwall(self, *words):
        return called(self.prefix / "bin" / "sandwall", *words, cwd=self.folder, env=self.environment)

    def test_lintian_finds_no_error(self):
        ended = called("lintian", "--allow-root", "--fail-on", "error", self.package)
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)

    def test_it_depends_on_what_the_launcher_starts_and_the_programs_load(self):
        depends = called("dpkg-deb", "-f", self.package, "Depends").stdout
        # The numbers of libraries are those of the Debian that built the package.
        in_memory = "libosmesa6" if osmesa() else "libegl-mesa0"
        for package in (r"python3 ", r"openmpi-bin\b", r"libopenmpi\d+ ", in_memory, r"libgdal\d+ "):
            self.assertRegex(depends, package)

    def test_it_holds_only_what_a_session_needs(self):
        found = sorted(path.name for path in (self.prefix / "lib" / "sandwall").iterdir() if path.suffix != ".json")
        lists = sorted(path.stem for path in (self.prefix / "lib" / "sandwall").glob("*.json"))
        self.assertEqual(lists, [name for name in found if name.startswith("sandwall-") and "." not in name], "options of each program")
        self.assertEqual(found, ["python", *sorted(
            f"sandwall-{name}" for name in ("check", "compare", "gl-egl.so", "gl-glfw.so", *(["gl-osmesa.so"] if osmesa() else []), "haptic-server", "import.so",
                                            "master", "relax", "render-node", "replay", "security.so", "track", "watch"))])
        self.assertFalse([path for path in self.tree.rglob("*") if path.suffix in (".pyc", ".hpp", ".cpp")])

    def test_it_has_the_page_if_it_was_built(self):
        built, packed = ROOT / "build" / "web" / "page", self.prefix / "share" / "sandwall" / "web"
        self.assertEqual({path.name: path.read_bytes() for path in packed.glob("*")}, {path.name: path.read_bytes() for path in built.glob("*")})
        if not built.is_dir():
            ended = self.sandwall("web")
            self.assertEqual((ended.returncode, ended.stdout), (2, ""))
            self.assertIn("the page is not there; install a package that has it", ended.stderr)
            return
        with subprocess.Popen([self.prefix / "bin" / "sandwall", "web"], stdout=subprocess.PIPE, text=True, env=self.environment) as server:
            self.addCleanup(server.kill)
            address = server.stdout.readline().strip()
            for name in ("", "page.js", "worker.js", "replica.wasm", "licences.txt"):
                with urllib.request.urlopen(address + name, timeout=20) as answer:
                    self.assertEqual(answer.read(), (built / (name or "index.html")).read_bytes())
            server.kill()

    def test_the_copyright_names_the_works_of_others_in_the_page(self):
        for page in (False, True):
            tree = self.folder / f"tree {page}"
            (tree / "usr" / "share" / "doc" / "sandwall").mkdir(parents=True)
            if page:
                (tree / "usr" / "share" / "sandwall" / "web").mkdir(parents=True)
            ended = called("cmake", f"-DCPACK_TEMPORARY_INSTALL_DIRECTORY={tree}", "-P", ROOT / "cmake" / "finish_package.cmake")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            text = (tree / "usr" / "share" / "doc" / "sandwall" / "copyright").read_text()
            self.assertEqual("Files: usr/share/sandwall/web/*" in text, page)

    def test_every_command_has_a_man_page(self):
        pages = self.prefix / "share" / "man" / "man1"
        for name in ("sandwall", "sandwall-run", "sandwall-try", "sandwall-ctl", "sandwall-film", "sandwall-doctor", "sandwall-web", "sandwall-replay", "sandwall-master"):
            text = called("gzip", "-dc", pages / f"{name}.1.gz").stdout
            for part in (".SH NAME", "SYNOPSIS", "--help"):
                self.assertIn(part, text.replace("\\-", "-"), name)
            self.assertNotIn(str(ROOT), text, name)
            self.assertIn(f"\n.TH {name.upper()} ", text)
            self.assertIn(f"\n.SH NAME\n{name} - ", text.replace("\\-", "-"))

    def test_it_runs_a_session_with_names_and_its_replay(self):
        (self.folder / "small.toml").write_text(SCENE)
        versions = self.sandwall("--version", "--json")
        self.assertEqual(versions.returncode, 0, versions.stderr)
        self.assertEqual(len({entry["build"] for entry in json.loads(versions.stdout)["programs"]}), 1)
        ended = self.sandwall("run", "--wall", "desktop", "--scene", "small.toml", "--device", "script:stroke", "--pace", "fast", "--steps", "30",
                              "--gl", "osmesa" if osmesa() else "egl", "--no-pictures", "--json")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        report = json.loads(ended.stdout)
        self.assertTrue(report["good"], report)
        self.assertEqual(self.sandwall("replay", report["out"], "--hash").stdout.split(), [report["session"]["state_hash"]])

    def test_mixed_builds_are_refused_in_one_line(self):
        known = self.prefix / "lib" / "sandwall" / "python" / "build.json"
        ours = known.read_text()
        self.addCleanup(known.write_text, ours)
        known.write_text('{"build": "00000000000000ff"}')
        ended = self.sandwall("run", "--wall", "desktop", "--scene", "dunes", "--gl", "osmesa", "--frames", "1")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr.count("\n")), (2, "", 1), ended.stderr)
        self.assertIn(f"is of build {json.loads(ours)['build']}, and this launcher of 00000000000000ff", ended.stderr)

    def test_a_prefix_that_cannot_be_written_is_refused_before_anything_is_installed(self):
        for prefix in ("/proc/sandwall", "/dev/null/sandwall"):
            ended = called("cmake", "--install", BUILD, "--prefix", prefix)
            self.assertNotEqual(ended.returncode, 0)
            self.assertIn(f"{prefix}: cannot be written; choose a folder of yours", " ".join(ended.stderr.split()))
            self.assertNotIn("-- Installing", ended.stdout)

    def test_a_folder_that_cannot_be_written_is_refused_in_one_line(self):
        for folder in ("/proc/sandwall", "/dev/null/sandwall", str(self.package)):
            ended = called(ROOT / "scripts" / "package.sh", "--build", BUILD, "--out", folder)
            self.assertEqual((ended.returncode, ended.stdout), (2, ""))
            self.assertEqual(ended.stderr, f"package.sh: {folder}: cannot be written; choose another --out\n")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        BUILD = pathlib.Path(sys.argv.pop(1))
    unittest.main()
