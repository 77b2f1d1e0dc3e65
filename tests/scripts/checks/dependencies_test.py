#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which packages scripts/install_dependencies.sh installs, with made-up programs of dpkg and apt."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from launcher_fixture import ROOT

# `installed` has lines PACKAGE ARCHITECTURE, and `known` the packages of this Debian.
PROGRAMS = {
    "dpkg": '[ "$1" = --print-architecture ] && echo amd64\n[ "$1" = --add-architecture ] && echo "$2" >>"$MADE_UP/added"\ntrue\n',
    "dpkg-query": '[ "$2" = "-f=\\${Conflicts}" ] && exec sed "" "$MADE_UP/conflicts"\nsed "s/ /:/; s/$/ installed/" "$MADE_UP/installed"\n',
    "apt-cache": 'echo "$2:"\ngrep -qx "$2" "$MADE_UP/known" && echo "  Candidate: 1:14.0-1" || echo "  Candidate: (none)"\n',
    "apt-get": '[ "$1" = install ] && echo "$*" >>"$MADE_UP/asked"\ntrue\n',
}


class Dependencies(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sandwall-dependencies-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        for name, text in {**PROGRAMS, "sudo": 'exec "$@"\n'}.items():
            (self.folder / name).write_text("#!/bin/sh\n" + text)
            (self.folder / name).chmod(0o755)
        self.write("known", "")
        self.everything = self.asked("--with-tests", installed="").split()

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def asked(self, *options, installed):
        """Returns the packages that apt-get is asked for, as one line for each call."""
        self.write("installed", installed)
        (self.folder / "asked").unlink(missing_ok=True)
        ended = subprocess.run([ROOT / "scripts" / "install_dependencies.sh", *options], capture_output=True, text=True, timeout=60,
                               env={**os.environ, "MADE_UP": str(self.folder), "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        try:
            lines = (self.folder / "asked").read_text().splitlines()
        except FileNotFoundError:
            return ""
        return "\n".join(" ".join(word for word in line.split() if not word.startswith("-") and word != "install") for line in lines)

    def all_installed(self, architecture):
        return "".join(f"{package} {architecture}\n" for package in self.everything)

    def test_nothing_is_asked_for_if_everything_is_installed(self):
        self.assertIn("libfmt-dev", self.everything)
        self.assertEqual(self.asked("--with-tests", installed=self.all_installed("amd64")), "")

    def test_a_package_of_two_architectures_counts_once(self):
        self.assertEqual(self.asked("--with-tests", installed=self.all_installed("amd64") + "libfmt-dev arm64\n"), "")

    def test_a_package_of_another_architecture_alone_is_missing(self):
        installed = self.all_installed("amd64").replace("libfmt-dev amd64", "libfmt-dev arm64")
        self.assertEqual(self.asked("--with-tests", installed=installed), "libfmt-dev")

    def test_the_compiler_is_the_first_that_this_debian_has(self):
        others = "".join(line + "\n" for line in self.all_installed("all").splitlines() if not line.startswith("clang"))
        for known, compiler in (("clang-14\nclang-19\n", "clang-14"), ("clang-19\n", "clang-19")):
            self.write("known", known)
            self.assertEqual(self.asked("--with-tests", installed=others), compiler)
            self.assertEqual(self.asked("--with-tests", installed=others + "clang-19 amd64\n"), "")

    def test_for_arm64_the_tools_are_of_this_machine_and_come_first(self):
        self.write("known", "libfmt-dev:arm64\n")
        tools, libraries = self.asked("--for-arm64", installed="").splitlines()
        self.assertIn("g++-aarch64-linux-gnu", tools.split())
        self.assertNotIn(":", tools)
        self.assertEqual(libraries, "libfmt-dev:arm64", "apt knows packages for all architectures without a colon alone")
        self.assertIn("libglm-dev", tools.split())
        self.assertEqual((self.folder / "added").read_text(), "arm64\n")

    def test_a_film_and_a_second_build_need_an_option_each(self):
        plain = self.asked(installed="").split()
        for package, option in (("ffmpeg", "--with-film"), ("ccache", "--with-tests")):
            self.assertNotIn(package, plain)
            self.assertIn(package, self.asked(option, installed="").split())

    def web(self, conflicts="", **versions):
        """Runs --with-web where only these programs of node are there. Returns its status, its line, and what it asks for."""
        path = self.folder / "path"
        shutil.rmtree(path, ignore_errors=True)
        path.mkdir()
        for name in ("bash", "sh", "env", "sed", "grep", "sudo"):
            (path / name).symlink_to(self.folder / name if name == "sudo" else shutil.which(name))
        for name, version in versions.items():
            (path / name).write_text(f"#!/bin/sh\necho {version}\n")
            (path / name).chmod(0o755)
        for name in PROGRAMS:
            (path / name).symlink_to(self.folder / name)
        self.write("conflicts", conflicts)
        self.write("installed", self.all_installed("amd64") + "emscripten amd64\n")
        (self.folder / "asked").unlink(missing_ok=True)
        ended = subprocess.run([ROOT / "scripts" / "install_dependencies.sh", "--with-web"], capture_output=True, text=True, timeout=60,
                               env={**os.environ, "MADE_UP": str(self.folder), "PATH": str(path)})
        asked = self.folder / "asked"
        words = asked.read_text().split() if asked.exists() else []
        return ended.returncode, ended.stderr, [word for word in words if word in ("nodejs", "npm", "emscripten")]

    def test_node_and_npm_are_installed_where_they_are_missing(self):
        self.assertEqual(self.web(), (0, "", ["nodejs", "npm"]))
        self.assertEqual(self.web(node="v18.19.0"), (0, "", ["npm"]))
        self.assertEqual(self.web(npm="9"), (0, "", ["nodejs"]))
        self.assertEqual(self.web(node="v20.1.0", npm="10"), (0, "", []))

    def test_node_of_another_source_without_its_npm_is_one_line(self):
        line = "install_dependencies.sh: node has another source; install its own npm\n"
        self.assertEqual(self.web(node="v20.1.0", conflicts="nodejs-doc, nodejs-legacy, npm"), (2, line, []))
        self.assertEqual(self.web(node="v20.1.0", conflicts="nodejs-doc, npm-tools"), (0, "", ["npm"]))

    def test_an_old_node_is_one_line(self):
        line = "install_dependencies.sh: node is v16.20.2; the web page needs node 18 or later\n"
        self.assertEqual(self.web(node="v16.20.2", npm="8"), (2, line, []))


if __name__ == "__main__":
    unittest.main()
