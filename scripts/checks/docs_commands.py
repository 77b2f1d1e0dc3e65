#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the commands in the documents as they are written, and prints a line for each block: ok, failed, or not run and why.

The blocks of a page run one after another in one temporary folder. The folder shows the project by symbolic links, and has
no out/. A session that continues until Ctrl-C gets SIGINT at the end of its block, and must end with status 0. All
processes that a block leaves are killed. docs/testing.md describes the marks in the pages.

Exit status 1: a block fails, or cannot be run and has no mark that says why.
Exit status 2: a page does not exist, or the programs are not built.

usage: scripts/docs_commands.py [--list] [--seconds N] [PAGE.md...]   (--list: print the blocks without running them;
--seconds N: the most that a block may take, default 600; default pages: README.md, CONTRIBUTING.md, docs/*.md)
"""

import argparse
import collections
import ctypes
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
import docs_blocks
from base.command_line import Parser
from docs_blocks import BIN, ROOT

PR_SET_CHILD_SUBREAPER = 36
MORE_SECONDS = 3  # for which programs that continue until Ctrl-C run after the last command
STOP = re.compile(r"scripts/sandwall ctl (\S+) stop\b")
LAST_LINES = 15  # of the output of a block that fails
# Programs that continue until Ctrl-C, and the options with which they end by themselves.
ENDLESS = {r"scripts/sandwall run\b": r"--(steps|frames|print-command|help)\b",
           r"sandwall-haptic-server\b": r"--(version|help)\b",
           r"sandwall-(watch|track)\b": r"--(seconds|version|help)\b",
           r"\bposition_sender\.py\b": r"--help\b"}
# A session is ready when its hand has moved the sand, as it has when a person types the next line. An undo needs a stroke.
BEGIN = r"""set -e -m -o pipefail
going=() expected=() outs=() stopped=" "
ready() {
    until [[ $(scripts/sandwall ctl "$1" status 2>/dev/null) =~ \"step\":\ *([0-9]+) && ${BASH_REMATCH[1]} -gt 120 ]]; do
        kill -0 "${going[-1]}"
        sleep 0.5
    done
}
"""
# Each program that continues has a process group of its own, as in a terminal. The program that began last ends first.
# A session ends in order at Ctrl-C, so its status must be 0. Other programs may end by the signal itself (130). A session
# that the block has stopped ends by itself.
END = r"""for ((i = ${#going[@]} - 1; i >= 0; --i)); do
    [[ $stopped == *" ${outs[i]} "* ]] || kill -INT -- "-${going[i]}" 2>/dev/null || true
    status=0
    wait "${going[i]}" || status=$?
    [[ $status == @(0|${expected[i]}) ]] || { echo "a program that continues until Ctrl-C ended with status $status"; exit 1; }
done
"""


def is_endless(command):
    """Returns whether a command continues until Ctrl-C, and the block does not put it into the background itself."""
    plain = " ".join(shlex.split(command, comments=True))
    return not plain.endswith("&") and any(re.search(program, plain) and not re.search(ends, plain)
                                           for program, ends in ENDLESS.items())


def out_of(command):
    """Returns the folder after --out. Throws ValueError if the command names none: its session could not be asked."""
    words = shlex.split(command, comments=True)
    folders = [after for word, after in zip(words, words[1:]) if word == "--out"] + [
        word.partition("=")[2] for word in words if word.startswith("--out=")]
    if not folders:
        raise ValueError(f"a session that continues until Ctrl-C needs --out FOLDER: {' '.join(words)}")
    return folders[-1]


def script_of(group):
    """Returns the bash script that runs the blocks of a group. It appends the number of each block to the file $BLOCKS.

    Throws ValueError with one line if a command cannot be run.
    """
    lines, endless = [BEGIN], False
    for number, block in enumerate(group):
        lines.append(f'echo {number} >>"$BLOCKS"')
        for command in block.commands():
            if is_endless(command):
                endless, session = True, "scripts/sandwall run" in command
                out = shlex.quote(out_of(command)) if session else "-"
                lines.append(f"{{\n{command}\n}} &\ngoing+=($!) expected+=({0 if session else 130}) outs+=({out})")
                if session:
                    lines.append(f"ready {out}")
            else:
                lines.append(command)
                if stop := STOP.match(command):
                    lines.append(f'stopped+="{stop[1]} "')
    return "\n".join([*lines, f"sleep {MORE_SECONDS}\n{END}" if endless else ""])


def descendants():
    """Returns the processes that this one has started, and theirs."""
    children = collections.defaultdict(list)
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                # The name of the program, in parentheses, may hold blanks.
                children[int((entry / "stat").read_text().rpartition(")")[2].split()[1])].append(int(entry.name))
            except OSError:
                pass  # it has ended
    found = [os.getpid()]
    for process in found:
        found += children[process]
    return found[1:]


def kill_descendants():
    """Kills all processes that a block has left. This process is their parent once their own parent has ended."""
    while left := descendants():
        for process in left:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass  # it has ended
        try:
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        except ChildProcessError:
            return
        time.sleep(0.05)


def run(group, folder, seconds):
    """Runs the blocks of a group in a folder. Returns (blocks that ended in order, complaint or an empty string)."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)  # a process whose parent has ended becomes a child of this one
    try:
        script = script_of(group)
    except ValueError as error:
        return 0, str(error)
    progress, output = folder / ".blocks", folder / ".output"
    progress.write_text("")
    environment = {**os.environ, "PATH": f"{ROOT / BIN}:{os.environ['PATH']}", "PYTHONDONTWRITEBYTECODE": "1",
                   "BLOCKS": str(progress)}
    with open(output, "wb") as stream:
        process = subprocess.Popen(["bash", "-c", script], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                   stdout=stream, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        status = process.wait(timeout=seconds * len(group))
        complaint = f"exit status {status}" if status != 0 else ""
    except subprocess.TimeoutExpired:
        complaint = f"not done after {seconds * len(group)} s"
    finally:
        kill_descendants()
        process.wait()  # it has ended
    if complaint:
        complaint = "\n    ".join([complaint, *output.read_text(errors="replace").splitlines()[-LAST_LINES:]])
    begun = progress.read_text().split()
    return (len(begun) - 1 if complaint else len(group)), complaint


def scratch():
    """Returns a new folder that shows the project by symbolic links, without out/ and with the programs alone in build/."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="sandwall-docs-"))
    for entry in ROOT.iterdir():
        if not entry.name.startswith(".") and entry.name not in ("build", "out"):
            (folder / entry.name).symlink_to(entry)
    (folder / BIN).parent.mkdir(parents=True)
    (folder / BIN.rstrip("/")).symlink_to(ROOT / BIN)
    return folder


def results(page, text, options):
    """Yields (line, result) of each block of a page, after the mistakes that are at no block."""
    wrong = collections.defaultdict(list)
    for line, what in docs_blocks.mistakes(page, text):
        wrong[line].append(what)
    blocks = docs_blocks.blocks(page, text)
    yield from ((line, f"failed: {'; '.join(wrong[line])}") for line in set(wrong) - {block.line for block in blocks})
    folder = scratch()
    try:
        for group in docs_blocks.sessions(blocks):
            known = [f"failed: {'; '.join(wrong[block.line])}" if block.line in wrong else
                     f"not run: {block.why_not_run()}" if block.why_not_run() else "" for block in group]
            if options.list or any(known):
                yield from ((block.line, result or "to run") for block, result in zip(group, known))
                continue
            began = time.monotonic()
            good, complaint = run(group, folder, options.seconds)
            took = time.monotonic() - began
            for number, block in enumerate(group):
                yield block.line, (f"ok, {took:.0f} s" if number < good else f"failed: {complaint}" if number == good else
                                   "failed: the block before it has failed")
    finally:
        shutil.rmtree(folder)


def pages(paths):
    """Returns the paths of all pages to read, relative to the project's folder. Throws OSError if one does not exist."""
    if paths:
        return [os.path.relpath(pathlib.Path(path).resolve(strict=True), ROOT) for path in paths]
    return [str(path.relative_to(ROOT)) for path in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/*.md"))]
            if path.is_file()]


def main():
    parser = Parser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--seconds", type=int, default=600)
    parser.add_argument("paths", nargs="*", metavar="PAGE.md")
    options = parser.parse_args()
    try:
        names = pages(options.paths)
        texts = {name: (ROOT / name).read_text() for name in names}
    except OSError as error:
        print(f"docs_commands.py: {error.filename}: cannot be read ({error.strerror})", file=sys.stderr)
        return 2
    if not options.list and not (ROOT / BIN / "sandwall-master").is_file():
        print(f"docs_commands.py: {BIN}: holds no programs; run scripts/test.sh, or print the blocks with --list", file=sys.stderr)
        return 2
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda number, _: sys.exit(128 + number))
    counts = collections.Counter()
    for name, text in texts.items():
        for line, result in results(name, text, options):
            print(f"{name}:{line}: {result}", flush=True)
            counts[re.match(r"ok|failed|not run|to run", result)[0]] += 1
    print(", ".join(f"{count} {result}" for result, count in sorted(counts.items())))
    return 1 if counts["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
