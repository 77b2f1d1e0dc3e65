# SPDX-License-Identifier: Apache-2.0
"""Finds the blocks of shell commands in a page, the marks above them, and the mistakes in both (docs/testing.md)."""

import dataclasses
import functools
import os
import pathlib
import re
import shlex
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = "build/release/bin/"
FENCE = re.compile(r" *(```+|~~~+) *(\S*)")
COMMENT = re.compile(r"<!-- (.*) -->")
COMMANDS = ("", "sh")  # languages of blocks of commands
MARK = re.compile(r"(not run|with|first): (.*\S)|(other terminal)")
RESERVED = {"do", "then", "else", "if", "while", "until", "!", "{", "time"}
NOT_A_COMMAND = {"for", "case", "function", "done", "fi", "esac", "}", "[["}
PLACEHOLDER = re.compile(r"(?<![\w$@.%=-])[A-Z][A-Z_]+(?![\w=])")


@dataclasses.dataclass
class Block:
    """Commands of a page, with the marks above them."""

    page: str
    line: int  # of the first command, from 1
    text: str
    marks: list  # (name, value), in the order of the page

    def values(self, name):
        return [value for mark, value in self.marks if mark == name]

    def why_not_run(self):
        """Returns the reasons for which the block is not run, or an empty string."""
        return "; ".join(self.values("not run"))

    def replacements(self):
        """Returns (text, value) of all marks `with`."""
        return [tuple(part.partition("=")[::2]) for value in self.values("with") for part in value.split(", ")]

    def filled(self):
        """Returns the commands of the page, with the replacements of the marks `with`."""
        text = self.text
        for name, value in self.replacements():
            text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", lambda _: value, text)
        return logical_lines(text)

    def commands(self):
        """Returns the commands to run: those of the marks `first`, and those of the page."""
        return [*self.values("first"), *self.filled()]


def logical_lines(text):
    """Returns the lines of a block, without empty lines and lines of comments. A backslash at its end continues a line."""
    lines = text.replace("\\\n", " ").splitlines()
    return [line.strip() for line in lines if line.strip() and not line.lstrip().startswith("#")]


def code_blocks(text):
    """Yields (line, language, text, comments above) of every block of code in a page. An indented block has no language.

    Comments that are not on the lines above a block are yielded with the language None.
    """
    lines, index, comments = text.splitlines() + [""], 0, []
    follows = True  # whether an indented line begins a block here; otherwise it continues a paragraph
    while index < len(lines):
        line, end = lines[index], index + 1
        fence, comment = FENCE.match(line), COMMENT.fullmatch(line.strip())
        if fence:
            while end < len(lines) and not lines[end].strip().startswith(fence[1]):
                end += 1
            yield index + 2, fence[2], "\n".join(lines[index + 1:end]), comments
            end += 1
        elif follows and line.startswith("    ") and line.strip():
            while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
                end += 1
            yield index + 1, "", "\n".join(lines[index:end]).rstrip(), comments
        elif comments and not comment:
            yield index, None, "", comments
        comments = [*comments, comment[1]] if comment else []
        follows = fence or comment or not line.strip() or line.startswith("#")
        index = end


def blocks(page, text):
    """Returns the blocks of commands: indented blocks, and fences with the language `sh` or without one."""
    found = []
    for line, language, code, comments in code_blocks(text):
        if language in COMMANDS:
            marks = [MARK.fullmatch(comment) for comment in comments]
            found.append(Block(page, line, code, [(mark[1] or mark[3], mark[2]) for mark in marks if mark]))
    return found


def sessions(page_blocks):
    """Returns lists of blocks that run together: a block, and the blocks after it that are for another terminal."""
    found = []
    for block in page_blocks:
        if found and block.values("other terminal"):
            found[-1].append(block)
        else:
            found.append([block])
    return found


def programs(command):
    """Yields the first word of each simple command in a line."""
    words = shlex.shlex(command, posix=True, punctuation_chars=True)
    words.whitespace_split = True
    first = True
    for word in words:
        if re.fullmatch(r"[;&|()]+", word):
            first = True
        elif first and word not in RESERVED and not re.fullmatch(r"\w+=.*", word):
            first = False
            if word not in NOT_A_COMMAND:
                yield word


@functools.cache
def project():
    """Returns the files and folders that git tracks, and the words of all CMakeLists.txt."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, text=True).stdout.split("\0")
    files = {name for name in listed if name}
    folders = {str(parent) for name in files for parent in pathlib.PurePosixPath(name).parents}
    targets = {word for name in files if name.endswith("CMakeLists.txt") and (ROOT / name).is_file()
               for word in re.findall(r"[\w-]+", (ROOT / name).read_text())}
    return files | folders, targets


@functools.cache
def builtins():
    """Returns the commands that bash has itself."""
    return set(subprocess.run(["bash", "-c", "compgen -b"], capture_output=True, check=True, text=True).stdout.split())


def is_program(word):
    """Returns whether a shell finds a program in the project's folder: a script, a target of CMake, or one of the system."""
    files, targets = project()
    if "/" in word and not word.startswith((BIN, "/")):
        return word in files and os.access(ROOT / word, os.X_OK)
    return word.removeprefix(BIN) in targets or word in builtins() or shutil.which(word) is not None


def mistake_of(block):
    """Returns what is wrong with the commands of a block, or None."""
    text = "; a block of other text names its language: ```text"
    if block.why_not_run():
        gone = [word for line in logical_lines(block.text) for word in programs(line) if "/" in word and not is_program(word)]
        return f"{gone[0]}: no program of the project" if gone else None
    for name, _ in block.replacements():
        if not re.search(rf"(?<!\w){re.escape(name)}(?!\w)", block.text):
            return f"the mark replaces {name}, which the block does not have"
    commands = block.commands()
    checked = subprocess.run(["bash", "-n"], input="\n".join(commands), capture_output=True, text=True)
    if checked.returncode != 0:
        return f"no commands for bash ({checked.stderr.splitlines()[0]}){text}"
    if unknown := [word for command in commands for word in programs(command) if not is_program(word)]:
        return f"{unknown[0]}: no program of the project or of this machine{text}"
    for command in block.filled():
        if placeholder := PLACEHOLDER.search(" ".join(shlex.split(command, comments=True))):
            return f"{placeholder[0]} is not filled; write <!-- with: {placeholder[0]}=VALUE --> above the block"
    return None


def mistakes(page, text):
    """Yields (line, what is wrong) of the marks and the blocks of a page."""
    for line, language, _, comments in code_blocks(text):
        for comment in comments:
            if not MARK.fullmatch(comment):
                yield line, f"unknown mark '{comment}'; docs/testing.md lists the marks"
            elif language is None:
                yield line, f"the mark '{comment}' is not on the line above a block"
            elif language not in COMMANDS:
                yield line, f"the mark '{comment}' is above a block of {language}, which holds no commands"
    before = None
    for block in blocks(page, text):
        if block.why_not_run() and len(block.marks) > 1:
            yield block.line, "a block that is not run needs no other mark"
        elif block.values("other terminal") and (before is None or before.why_not_run()):
            yield block.line, "the block before is not run, so nothing runs in the other terminal"
        elif what := mistake_of(block):
            yield block.line, what
        before = block
