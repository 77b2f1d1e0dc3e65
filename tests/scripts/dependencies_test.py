#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which packages scripts/install_dependencies.sh installs, with made-up programs of dpkg and apt."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from launcher_fixture import ROOT

# `installed` has lines PACKAGE ARCHITECTURE, and `known` the packages of this Debian.
PROGRAMS = {
    "dpkg": '[ "$1" = --print-architecture ] && echo amd64\n[ "$1" = --add-architecture ] && echo "$2" >>"$MADE_UP/added"\ntrue\n',
    "dpkg-query": 'for package; do :; done\nsed -n "s/^$package \\(.*\\)/\\1 installed/p" "$MADE_UP/installed"\n',
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


if __name__ == "__main__":
    unittest.main()
