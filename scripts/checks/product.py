# SPDX-License-Identifier: Apache-2.0
"""The one list of the product's folders, for every check: those that the root's CMakeLists.txt adds."""

import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
AROUND = ("bench", "tests", "examples")  # folders that use the product
ENDINGS = (".cpp", ".hpp", ".glsl", ".py")


def folders(root=ROOT):
    """Returns the top folders of the product's programs and libraries."""
    added = re.findall(r"^ *add_subdirectory\((\w+)\)", (root / "CMakeLists.txt").read_text(), re.MULTILINE)
    return tuple(sorted(set(added) - set(AROUND)))


def tracked(root=ROOT):
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=root, capture_output=True, check=True, text=True).stdout
    return listed.split("\0")[:-1]


def sources(root=ROOT):
    """Returns the tracked sources of the product, in each language, and its scripts."""
    tops = {*folders(root), "scripts"}
    return [name for name in tracked(root) if name.partition("/")[0] in tops and (name.endswith(ENDINGS) or name == "scripts/launcher/sandwall")]
