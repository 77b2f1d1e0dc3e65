# SPDX-License-Identifier: Apache-2.0
"""The programs that `sandwall NAME` starts, their versions, and `sandwall list`."""

import json
import pathlib
import subprocess

from base import checked_json, console, layout
from base.bad_input import BadInput
from base.layout import program

FAILED = 1
# Programs that `sandwall NAME` starts. The other programs are started by `run` and `film`.
TOOLS = {"check": "check a wall file", "relax": "relax a terrain without a wall", "replay": "replay, verify or export a journal",
         "compare": "compare two pictures", "track": "print or send poses of a head", "watch": "watch a haptic server",
         "haptic-server": "run a haptic server by itself"}


def list_known(args):
    kinds = [args.kind] if args.kind else list(layout.FOLDERS)
    for kind in kinds:
        console.OUT.line("\n".join(layout.known(kind)) if args.kind else f"{kind}: {' '.join(layout.known(kind))}")
    return 0


def add_list(commands):
    command = commands.add_parser("list", help="print the walls, scenes and strokes that come with Sandwall",
                                  description="Prints the names that --wall, --scene and --device script:NAME take.")
    command.set_defaults(run=list_known)
    command.add_argument("kind", nargs="?", choices=tuple(layout.FOLDERS), help="print the names of this kind alone, one per line")


def add_tools(commands):
    """Adds the tools to --help. main() starts them before it parses options, because a tool has options of its own."""
    for name, what in TOOLS.items():
        commands.add_parser(name, help=what, add_help=False)


PROGRAMS = ("master", "render-node", "haptic-server", "replay", "relax", "check", "compare", "track", "watch", "bench")


def versions(as_json):
    """Prints the versions of all programs. Returns exit status 1 if they are of several builds, else 0."""
    found = []
    for name in PROGRAMS:
        if not (pathlib.Path(program("sandwall-master")).parent / f"sandwall-{name}").is_file():
            continue  # sandwall-bench is not part of every build
        ended = subprocess.run([program(f"sandwall-{name}"), "--version", "--json"], capture_output=True, text=True)
        try:
            entry = checked_json.parse(ended.stdout)
        except ValueError:
            entry = None
        if not isinstance(entry, dict) or not all(isinstance(entry.get(key), str) for key in ("program", "version", "build")):
            raise BadInput(f"{program(f'sandwall-{name}')}: does not answer --version --json; {layout.MEND}")
        found.append(entry)
    one_build = len({entry["build"] for entry in found}) == 1
    if as_json:
        console.OUT.line(json.dumps({"version": found[0]["version"], "build": found[0]["build"] if one_build else None, "programs": found}))
    else:
        for entry in found:
            known = "".join(f", {key} {value}" for key, value in entry.items() if key not in ("program", "version", "build"))
            console.OUT.line(checked_json.one_line(f"{entry['program']} {entry['version']}, build {entry['build']}{known}"))
    if not one_build:
        console.print_line(f"the programs are of several builds; {layout.MEND}")
    return 0 if one_build else FAILED
