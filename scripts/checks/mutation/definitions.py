# SPDX-License-Identifier: Apache-2.0
"""Finds functions, classes and constants of the sources by name. Needs Debian's universal-ctags."""

import collections
import dataclasses
import json
import pathlib
import subprocess

# Shaders have the syntax of C, and the launcher's program has no ending.
LANGUAGES = ["--languages=C++,Python", "--map-C++=+.glsl", "--map-Python=+(sandwall)"]
DEFINED = {"class", "enum", "function", "macro", "member", "struct", "union", "variable"}


@dataclasses.dataclass(frozen=True)
class Definition:
    """The lines from `first` to `last` of the source `file` define `scope` + (`name`,). Lines count from 1."""

    scope: tuple
    name: str
    kind: str
    file: str
    first: int
    last: int

    def matches(self, words):
        """Returns whether `words` end its full name, as ["Replica", "apply"] end sand::Replica::apply."""
        return [*self.scope, self.name][-len(words):] == words

    def is_constructor(self):
        return self.scope[-1:] == (self.name,) or self.name == "__init__"


class Definitions:
    """All definitions in the sources `files`, which are paths relative to `root`."""

    def __init__(self, root, files):
        self.by_name = collections.defaultdict(list)
        for definition in read(root, files):
            self.by_name[definition.name].append(definition)

    def named(self, name):
        """Returns the definitions whose full name ends with `name`: a class, apply, Replica::apply, session_lines.force."""
        words = name.replace("::", ".").split(".")
        found = [one for one in self.by_name.get(words[-1], ()) if one.matches(words)]
        return [one for one in found if not one.is_constructor()] or found  # `Gate` names the class, and Gate::Gate its constructor


def scope_of(tag):
    """Returns the namespaces and classes around a definition. In Python and in shaders, the file is the outermost one."""
    parts = tag.get("scope", "").replace("::", ".").split(".")
    file = pathlib.PurePath(tag["path"])
    module = file.name.split(".")[:-1] if file.suffix in (".py", ".glsl") else []
    return (*module, *(part for part in parts if part and not part.startswith("__anon")))


def read(root, files):
    command = ["ctags", *LANGUAGES, "--fields=+neKs", "--output-format=json", "--sort=no", "-f", "-", "-L", "-"]
    listed = subprocess.run(command, cwd=root, input="\n".join(files), text=True, capture_output=True, check=True).stdout
    tags = [json.loads(line) for line in listed.splitlines()]
    by_file = collections.defaultdict(list)
    for tag in tags:
        if tag["kind"] in DEFINED or tag["kind"] == "namespace":
            by_file[tag["path"]].append(tag)
    for file, found in by_file.items():
        found.sort(key=lambda tag: tag["line"])
        for i, tag in enumerate(found):
            # ctags gives no end if it does not understand a definition. It then ends before the next one.
            last = tag.get("end") or next((later["line"] - 1 for later in found[i + 1:] if later["line"] > tag["line"]), 1 << 30)
            if tag["kind"] in DEFINED and not tag["name"].startswith("__anon"):
                yield Definition(scope_of(tag), tag["name"], tag["kind"], file, tag["line"], last)
