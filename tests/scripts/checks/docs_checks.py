# SPDX-License-Identifier: Apache-2.0
"""The checks of docs_test.py: each returns what is wrong in the documents of a Repository."""

import fnmatch
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAPERS = "docs/papers.md"
RECIPES = "CONTRIBUTING.md"
NOT_HERE = re.compile(r"(https?|mailto):")
CODE = re.compile(r"`([^`\n]+)`")
FENCE = re.compile(r"^ *(```|~~~).*?^ *\1[^\n]*$", re.MULTILINE | re.DOTALL)
GTEST = re.compile(r"^(?:TEST|TEST_F|TEST_P)\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
TEST_NAME = re.compile(r"^[A-Z]\w+\.[A-Z]\w+$")
# A path of the repository: it begins with a top folder. <name>, or NAME as a part of it, is the reader's own name.
SOURCE = re.compile(r"^(?:{folders})/[\w./<>-]*$")
OWN_NAME = re.compile(r"<name>|\bNAME\b")
# A name of C++ code that is more than a word: a function, a member, a constant.
CPP_NAME = re.compile(r"^(?:\w+::)*\w+\(\)$|^\w+(?:::\w+)+$|^k[A-Z]\w*$")


def tracked(*patterns):
    listed = subprocess.run(["git", "ls-files", "-z", *patterns], cwd=ROOT, capture_output=True, check=True, text=True)
    return [name for name in listed.stdout.split("\0") if name]


class Repository:
    """The files of a project, its tests by file, and the texts of its documents. `read` returns the text of a source."""

    def __init__(self, files, tests, documents, read=lambda file: (ROOT / file).read_text()):
        self.files = set(files)
        self.folders = {str(parent) for file in files for parent in pathlib.PurePosixPath(file).parents}
        top = sorted({file.split("/")[0] for file in files if "/" in file})
        self.source = re.compile(SOURCE.pattern.replace("{folders}", "|".join(map(re.escape, top))))
        self.tests = tests
        self.read = read
        self.documents = documents

    @classmethod
    def of_the_project(cls):
        files = tracked()
        tests = {file: {".".join(found) for found in GTEST.findall((ROOT / file).read_text())}
                 for file in files if re.match(r"tests/.*\.cpp$", file)}
        return cls(files, tests, {file: (ROOT / file).read_text() for file in files if file.endswith(".md")})

    def all_tests(self):
        return set().union(*self.tests.values())


def anchor(heading):
    """Returns the anchor that web pages of repositories make from a heading."""
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading.lower())
    return re.sub(r" ", "-", re.sub(r"[^\w\- ]", "", text)).strip("-")


def anchors(text):
    return {anchor(heading.strip()) for heading in re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.MULTILINE)}


def broken_links(repository, name):
    """Yields a line for each link of a document to a file or a heading that does not exist."""
    text = FENCE.sub("", repository.documents[name])
    for target in re.findall(r"\]\(([^()\s]+)\)", CODE.sub("", text)):
        if NOT_HERE.match(target):
            continue
        path, _, heading = target.partition("#")
        found = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
        if found not in repository.files and found not in repository.folders:
            yield f"{name}: links to {target}, which is not in the project"
        elif heading and heading not in anchors(repository.documents.get(found, "")):
            yield f"{name}: links to {target}; that page has no such heading"


def links(repository, name):
    """Yields the file that each link of a document leads to."""
    text = CODE.sub("", FENCE.sub("", repository.documents[name]))
    for target in re.findall(r"\]\(([^()\s]+)\)", text):
        path = target.partition("#")[0]
        if path and not NOT_HERE.match(target):
            yield os.path.normpath(os.path.join(os.path.dirname(name), path))


def index_faults(repository):
    """Yields a line for each page of docs/ that its index does not list exactly once.

    The index of a folder is its README.md. It lists the pages of the folder, and the README.md of each folder in it.
    """
    for page in sorted(name for name in repository.documents if name.startswith("docs/") and name != "docs/README.md"):
        folder = os.path.dirname(page)
        index = f"{os.path.dirname(folder) if page.endswith('/README.md') else folder}/README.md"
        if index not in repository.documents:
            yield f"{page}: its folder has no README.md that lists it"
            continue
        times = list(links(repository, index)).count(page)
        if times != 1:
            yield f"{index}: lists {page} {times} times instead of once"


def defines(text, function):
    """Returns whether a C++ source holds the body of this function. A declaration has a semicolon instead."""
    for found in re.finditer(rf"^(?![\s/#]).*?(?<![\w:]){re.escape(function)}\(", text, re.MULTILINE):
        depth, at = 1, found.end()
        while depth > 0 and at < len(text):
            depth += {"(": 1, ")": -1}.get(text[at], 0)
            at += 1
        if re.match(r"[^;{]*\{", text[at:]):
            return True
    return False


def linked_functions(repository, name):
    """Yields (function, file) of links such as [`HapticTick::tick`](../haptic_bridge/loop/haptic_tick.cpp)."""
    for function, path in re.findall(r"\[`([\w:]+)`\]\(([^()\s]+\.[ch]pp)\)", FENCE.sub("", repository.documents[name])):
        yield function, os.path.normpath(os.path.join(os.path.dirname(name), path))


def missing_functions(repository, name):
    """Yields a line for each link that names a function and leads to a source that does not define it."""
    for function, file in linked_functions(repository, name):
        if file not in repository.files:
            yield f"{name}: links {function} to {file}, which is not in the project"
        elif not defines(repository.read(file), function):
            yield f"{name}: links {function} to {file}, which does not define it"


def has_path(repository, path):
    """Returns whether the project has this file or folder, or one of this form if the path has the reader's own name in it."""
    form = OWN_NAME.sub("*", path.rstrip("/"))
    return form in repository.files or form in repository.folders or (
        "*" in form and any(fnmatch.fnmatchcase(known, form) for known in repository.files | repository.folders))


def missing_sources(repository, name):
    """Yields a line for each file or folder that a document names and the project does not have."""
    for span in CODE.findall(repository.documents[name]):
        if repository.source.match(span) and not has_path(repository, span):
            yield f"{name}: names {span}, which is not in the project"


def recipes(repository):
    """Yields (heading, text) of each recipe. A recipe is a section under "How to add"."""
    _, _, page = repository.documents.get(RECIPES, "").partition("\n## How to add\n")
    for section in page.split("\n## ")[0].split("\n### ")[1:]:
        heading, _, text = section.partition("\n")
        yield heading, text


def stale_recipes(repository):
    """Yields a line for each name of code in a recipe that no file of the recipe has, and for each recipe without a test."""
    for heading, text in recipes(repository):
        spans = CODE.findall(text)
        files = [span for span in spans if span in repository.files]
        code = "\n".join(repository.read(file) for file in files)
        for span in spans:
            if CPP_NAME.match(span) and any(not re.search(rf"\b{word}\b", code) for word in re.findall(r"\w+", span)):
                yield f"{RECIPES}: {heading}: no file of this recipe has {span}"
        if not any(span.startswith("tests/") for span in spans):
            yield f"{RECIPES}: {heading}: names no test"


# Keys that code reads from a scene file, with the call that reads them or the list that declares them.
SCENE_KEY = (r'(?:\.|->)(?:number|numbers|text|texts|integer|flag|value|choice|table)(?:Or)?\(\s*"(\w+)"|\w+Or\(\*?\w+, "(\w+)"'
             r'|^    ForceKey\{"(\w+)", &|^    keyOf<[^>]*>\("(\w+)"')
NAMED_VALUE = r'base::Named\{\w+, "([\w-]+)"\}'
# Names that a user may write, by what declares them, and the pages that must list all of them.
LISTS = (
    ("sand/model/tool.hpp", NAMED_VALUE, ("docs/scenes.md", "docs/operator.md", "docs/pointer.md", "docs/protocol.md", "docs/glossary.md",
                                            "docs/schemas/status.schema.json")),
    ("walls/wall.hpp", r'base::Named\{(?!Eye)\w+, "([\w-]+)"\}', ("docs/stereo.md", "docs/wall_files.md")),
    ("lockstep/overlays.hpp", r'[{\s]"([\w-]+)"[,}]', ("docs/look.md", "docs/operator.md")),
    ("sand/model/step.hpp", NAMED_VALUE, ("docs/journal.md", "docs/protocol.md", "docs/glossary.md")),
    ("master/operator/verbs.hpp", r'^ +\{"([\w-]+)", "', ("docs/operator.md", "tests/master/operator/operator_desk_test.cpp")),
    ("scene/load/scene_file.cpp", SCENE_KEY, ("docs/scenes.md",)),
    ("scene/load/terrain.cpp", SCENE_KEY, ("docs/scenes.md",)),
    ("scene/load/terrain_source.cpp", SCENE_KEY, ("docs/scenes.md",)),
    ("scene/load/tin_table.cpp", SCENE_KEY, ("docs/scenes.md",)),
    ("scene/model/material.cpp", SCENE_KEY, ("docs/scenes.md",)),
    ("scene/model/material.cpp", r'^    keyOf<[^>]*>\("\w+", "([\w-]+)"', ("docs/operator.md",)),
    ("sand/force/force_constants.cpp", SCENE_KEY, ("docs/scenes.md", "docs/forces.md")),
)


def declared(text, pattern):
    """Returns the names that the pattern finds in a source."""
    return sorted({name for found in re.finditer(pattern, text, re.MULTILINE) for name in found.groups() if name})


def unlisted_names(repository, lists=LISTS):
    """Yields a line for each name that a source declares and a page leaves out, and for each source that declares none."""
    for file, pattern, pages in lists:
        names = declared(repository.read(file), pattern)
        if not names:
            yield f"{file}: declares no name that docs_test finds"
        for page in pages:
            text = repository.documents.get(page) or repository.read(page)
            for name in names:
                if not re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", text):
                    yield f"{page}: leaves out {name}, which {file} declares"


def missing_filters(repository, name):
    """Yields a line for each filter that matches no test."""
    for given in re.findall(r"--gtest_filter='?([\w.*?:/-]+)", repository.documents[name]):
        # The full name of a test with parameters has an instance in front and a parameter at the end.
        for pattern in given.split(":"):
            if not any(fnmatch.fnmatchcase(test, pattern) or fnmatch.fnmatchcase(f"x/{test}/x", pattern)
                       for test in repository.all_tests()):
                yield f"{name}: the filter {pattern} runs no test"


def missing_tests(repository, name):
    """Yields a line for each test that a row of papers.md names and its file does not have. A row names a file, then its tests."""
    for row in repository.documents[name].splitlines():
        file = None
        for span in CODE.findall(row):
            if re.match(r"tests/.*\.cpp$", span):
                file = span
            elif TEST_NAME.match(span):
                if file is None:
                    yield f"{name}: {span} must follow the file of its tests"
                elif span not in repository.tests.get(file, set()):
                    yield f"{name}: {file} has no test {span}"


def unknown_tests(repository, name):
    """Yields a line for each test that a document names and the project does not have."""
    for span in CODE.findall(repository.documents[name]):
        if TEST_NAME.match(span) and span not in repository.all_tests():
            yield f"{name}: names the test {span}, which is not in the project"


def missing_pages(sources):
    """Returns a line for each page that a source names, such as the help of an option, and that does not exist."""
    return [f"{name}: names {page}, which does not exist" for name, text in sources.items()
            for page in dict.fromkeys(re.findall(r"\bdocs/\w+\.md\b", text)) if not (ROOT / page).is_file()]


def constant(file, name):
    """Returns the digits of a constant of a C++ header."""
    return re.search(rf"\b{name} = (\d+);", (ROOT / file).read_text(encoding="utf-8"))[1]


def faults(repository):
    found = []
    for name in repository.documents:
        for look in (broken_links, missing_functions, missing_sources, missing_filters, unknown_tests):
            found += look(repository, name)
    return found + list(missing_tests(repository, PAPERS)) + list(stale_recipes(repository)) + list(unlisted_names(repository))
