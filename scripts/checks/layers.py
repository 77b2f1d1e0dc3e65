#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which folders of the project include which, and draws docs/layers.svg.

A file may include a header of its own folder, or of a library that its own library links in CMake. Other folders include
a header, so it may only include headers of libraries that its library links PUBLIC. Folders may not include each other in
a circle, and a folder's own files are above its subfolders: they may include these, and these never include them, not even
through other folders. This also holds in bench/ and tests/. A source is in the folder of the header that it implements.
A header with the line `// Private to this folder.` is only included from its folder and from its tests. A folder holds at
most 25 sources of one language. shapes/, which the web page compiles, includes base/, sand/ and GLM alone, and no OpenGL.
A header that declares one type, and no function, is named by it. A namespace is that of the top folder, with sand::grid,
sand::tin, sand::force and scene::relax.

usage: scripts/checks/layers.py BUILD [--svg FILE]   (BUILD: a configured build folder; drawing needs graphviz)
"""

import argparse
import collections
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_SOURCES = 25
OTHER_LANGUAGES = ("py", "sh", "mjs", "ts", "glsl")
PRIVATE = "// Private to this folder."
# Pure folders, and all that they may include besides their own files and the standard library.
PURE = {"shapes/": ("base/", "sand/", "glm/")}
OUTER = ("tests/", "bench/", "examples/", "haptic_bridge/examples/")  # folders that no other folder may include
# Folders of a module alone. It may include what the library that loads it may include.
LOADED_BY = {"scene/gdal": "scene_import"}
# Folders with a namespace of their own.
OWN_NAMESPACE = ("sand/grid", "sand/tin", "sand/force", "scene/relax")
# Headers in the namespace of the top folder although their folder has its own: values of a scene.
OF_THE_TOP = ("sand/force/force_constants.hpp",)


class Project:
    """The sources by path, and the targets that cmake/Layers.cmake has written."""

    def __init__(self, sources, targets, others=()):
        self.sources = sources  # {path: text}
        self.others = others  # paths of the sources in other languages
        self.includes = {path: [name for name in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE) if name in sources]
                         for path, text in sources.items()}
        objects = {name: target for name, target in targets.items() if target["type"] == "OBJECT_LIBRARY"}
        self.targets = {name: target for name, target in targets.items() if name not in objects}
        self.owner = {}
        for name, target in self.targets.items():
            compiled = list(target["sources"])
            for source in target["sources"]:
                compiled += objects.get(source, {"sources": []})["sources"]
            for source in compiled:
                if source in sources and not (source in self.owner and target["type"] != "STATIC_LIBRARY"):
                    self.owner[source] = name
        static = [(os.path.dirname(source), name) for source, name in sorted(self.owner.items())
                  if self.targets[name]["type"] == "STATIC_LIBRARY"]
        self.library = {}  # {folder: its library}: the library with the folder's name, or else the one with most of its sources
        for folder, name in static:
            best = self.library.setdefault(folder, name)
            if best != os.path.basename(folder) and (name == os.path.basename(folder) or static.count((folder, name)) > static.count((folder, best))):
                self.library[folder] = name

    @classmethod
    def of(cls, root, build):
        def listed(*patterns):
            return subprocess.run(["git", "ls-files", *patterns], cwd=root, capture_output=True, check=True, text=True).stdout.split()

        sources = {path: (root / path).read_text() for path in listed("*.cpp", "*.hpp")}
        others = listed(*(f"*.{ending}" for ending in OTHER_LANGUAGES))
        return cls(sources, json.loads((build / "layers.json").read_text()), others)

    def target_of(self, path):
        """Returns the library that a file is part of, or None if no folder above it has a library."""
        folder, stem = os.path.dirname(path), os.path.splitext(path)[0]
        own = self.owner.get(stem + ".cpp")
        if own and self.targets[own]["type"] != "MODULE_LIBRARY":
            return own
        while folder and folder not in self.library and folder not in LOADED_BY:
            folder = os.path.dirname(folder)
        return self.library.get(folder) or LOADED_BY.get(folder)

    def usable(self, target, public_only):
        """Returns the targets whose headers the sources of `target` may include; if `public_only`, its headers."""
        links = self.targets[target]["interface_link_libraries" if public_only else "link_libraries"]
        found, waiting = {target}, list(links)
        while waiting:
            name = waiting.pop()
            if name in self.targets and name not in found:
                found.add(name)
                waiting += self.targets[name]["interface_link_libraries"]
        return found

    def folder_edges(self):
        """Returns {(including folder, included folder): [(file, included header)]}."""
        edges = {}
        for path, names in self.includes.items():
            for name in names:
                ends = os.path.dirname(path), os.path.dirname(name)
                if ends[0] != ends[1]:
                    edges.setdefault(ends, []).append((path, name))
        return edges

    def drawn_edges(self):
        """Returns the edges of folder_edges() that are drawn: those of the product."""
        return {ends: reasons for ends, reasons in self.folder_edges().items() if not f"{ends[0]}/".startswith(OUTER)}

    def steps_down(self):
        """Returns {(folder, folder somewhere below it)} of all folders with files."""
        folders = {os.path.dirname(path) for path in self.sources}
        return {(above, folder) for folder in folders for above in folders if folder.startswith(above + "/")}


def wrong_links(project):
    for path, names in project.includes.items():
        if path.startswith(OUTER) and path.endswith(".hpp"):
            continue  # it belongs to the programs that include it
        target = project.target_of(path)
        if target is None:
            if not path.startswith(OUTER):
                yield f"{path}: no library of the project holds it; add it to a CMakeLists.txt"
            continue  # a test's own module
        usable = project.usable(target, public_only=path.endswith(".hpp"))
        for name in names:
            other = project.target_of(name)
            if os.path.dirname(name) == os.path.dirname(path) or name.startswith(OUTER) or other in usable:
                continue
            how = "PUBLIC, as a header needs" if path.endswith(".hpp") else "at all"
            yield f"{path}: includes {name} of {other}, which {target} does not link {how}"


def misplaced(project):
    for path, names in project.includes.items():
        stem = os.path.splitext(os.path.basename(path))[0]
        if path.endswith(".cpp") and not path.startswith(OUTER):
            for name in names[:1]:
                if os.path.basename(name) == stem + ".hpp" and os.path.dirname(name) != os.path.dirname(path):
                    yield f"{path}: implements {name} and is in another folder"
        for name in names:
            inside = os.path.dirname(name)
            if PRIVATE in project.sources[name] and os.path.dirname(path) != inside \
                    and not path.startswith(f"tests/{inside}/"):
                yield f"{path}: includes {name}, which is private to its folder"


def crowded(project):
    count = collections.Counter()
    for path in (*project.sources, *project.others):
        stem, ending = os.path.splitext(path)
        if ending != ".hpp" or stem + ".cpp" not in project.sources:  # a header and its source count once
            count[os.path.dirname(path), ending] += 1
    for (folder, ending), sources in sorted(count.items()):
        if sources > MOST_SOURCES:
            yield f"{folder}: holds {sources} sources *{ending}, more than {MOST_SOURCES}; divide it"


def circles(project):
    """Yields a message for every circle of folders, once. A folder counts as one that includes its subfolders."""
    edges, steps = project.folder_edges(), project.steps_down()
    below = {}
    for source, target in {*edges, *steps}:
        below.setdefault(source, []).append(target)
    done, way = set(), []

    def visit(folder):
        if folder in way:
            circle = way[way.index(folder):] + [folder]
            arrows = list(zip(circle, circle[1:]))
            path, name = edges[[arrow for arrow in arrows if arrow in edges][-1]][0]
            why = "" if all(arrow in edges for arrow in arrows) else "; a folder's own files are above its subfolders"
            yield f"{' -> '.join(circle)}: a circle of folders, closed by {path} that includes {name}{why}"
        elif folder not in done:
            way.append(folder)
            for target in sorted(below.get(folder, [])):
                yield from visit(target)
            way.pop()
            done.add(folder)

    for folder in sorted(below):
        yield from visit(folder)


def impure(project):
    """Yields a message for each header of another library, such as OpenGL, that a pure folder includes."""
    for path, text in project.sources.items():
        for folder, allowed in PURE.items():
            for name in re.findall(r'^ *# *include *[<"]([^>"]+)[>"]', text, re.MULTILINE) if path.startswith(folder) else ():
                standard = "/" not in name and "." not in name
                if not standard and not name.startswith((folder, *allowed)):
                    yield f"{path}: includes {name}; {folder} includes {', '.join(allowed)} and the standard library alone"


def snake_case(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


TYPE = re.compile(r"^(?:class|struct|enum class) (\w+)(?: final)?\s*(?::[^:;{][^;{]*)?\{", re.MULTILINE)
FUNCTION = re.compile(r"^(?!class|struct|enum|namespace|using|template|static_assert|extern|[ #/}])[^\n/]*\w\((?!.*valuesOf)[^\n]*", re.MULTILINE)


def misnamed(project):
    """Yields a message for each header of one type that has another name. The folder may be a part of the type's name."""
    for path, text in project.sources.items():
        if not path.endswith(".hpp") or path.startswith(OUTER) or FUNCTION.search(text):
            continue
        folder, stem = os.path.split(path[:-len(".hpp")])
        folder = os.path.basename(folder)
        types = TYPE.findall(text)
        if len(types) == 1 and snake_case(types[0]) not in {stem, f"{folder}_{stem}", f"{stem}_{folder}", f"{stem}_{folder.rstrip('s')}"}:
            yield f"{path}: declares {types[0]} alone; name the header by it"


def foreign_namespaces(project):
    """Yields a message for each header that is in the namespace of another folder."""
    for path, text in project.sources.items():
        if not path.endswith(".hpp") or path.startswith(OUTER):
            continue
        own = next((folder for folder in OWN_NAMESPACE if path.startswith(folder + "/")), path.split("/")[0]).replace("/", "::")
        if path in OF_THE_TOP:
            own = path.split("/")[0]
        if not any(name == own or name.startswith(own + "::") for name in re.findall(r"^(?:inline )?namespace ([\w:]+)", text, re.MULTILINE)):
            yield f"{path}: is in another namespace than {own}"


CHECKS = (wrong_links, misplaced, crowded, circles, impure, misnamed, foreign_namespaces)


def faults(project):
    return [fault for check in CHECKS for fault in check(project)]


def reduced(edges):
    """Returns the edges between folders, except edges that a longer way replaces."""
    below = {}
    for source, target in edges:
        below.setdefault(source, set()).add(target)

    def reachable(folder, seen):
        for target in below.get(folder, ()):
            if target not in seen:
                seen.add(target)
                reachable(target, seen)
        return seen

    return sorted((source, target) for source, target in edges
                  if not any(target in reachable(other, set()) for other in below[source] - {target}))


def fingerprint(project):
    return hashlib.sha256(repr(sorted(project.drawn_edges())).encode()).hexdigest()[:16]


COLOURS = {"base": "#e9e4d8", "host": "#e9e4d8", "sand": "#f3dfb0", "shapes": "#f6ebcf", "scene": "#dfe8c6", "journal": "#e6dce0", "web": "#c9e4e4", "haptic_bridge": "#f2cfc4",
           "lockstep": "#cfdcef", "master": "#d9d0ea", "render_node": "#c9e4e4"}


def draw(project, file):
    edges = reduced(project.drawn_edges())
    folders = sorted({folder for edge in edges for folder in edge})
    lines = ["digraph layers {", "rankdir=TB; nodesep=0.18; ranksep=0.38; bgcolor=white;",
             'node [shape=box, style="rounded,filled", color="#8a8578", fontname="Helvetica", fontsize=11, height=0.3];',
             'edge [color="#6b675d", arrowsize=0.6];']
    for folder in folders:
        colour = COLOURS.get(folder.split("/")[0], "#eeeeee")
        lines.append(f'"{folder}" [fillcolor="{colour}"];')
    lines += [f'"{source}" -> "{target}";' for source, target in edges] + ["}"]
    svg = subprocess.run(["dot", "-Tsvg"], input="\n".join(lines), capture_output=True, check=True, text=True).stdout
    svg = re.sub(r"<!--.*?-->\n?", "", svg, flags=re.DOTALL)
    note = f"<!-- scripts/checks/layers.py {fingerprint(project)}: an arrow points to an included folder; arrows that follow from others are left out -->\n"
    file.write_text(re.sub(r"(<svg)", note + r"\1", svg, count=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--svg", type=pathlib.Path)
    options = parser.parse_args()
    project = Project.of(ROOT, options.build)
    found = faults(project)
    print("\n".join(found) or f"{len(project.folder_edges())} arrows between folders, all correct")
    if options.svg:
        draw(project, options.svg)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
