# SPDX-License-Identifier: Apache-2.0
"""The options that our programs have. Each program lists them when it is built: sandwall-NAME.json beside the program.

The launcher offers an option to its user, and passes it on, if the program says so ("offered_by"). So help, checks of
values and completion know every option of this build, and no program has to run for them.
"""

import functools
import pathlib
import re

from base import checked_json, command_line, layout
from base.bad_input import BadInput

MASTER, SERVER, NODE = "sandwall-master", "sandwall-haptic-server", "sandwall-render-node"
BUILT_IN_STROKES = "gis"  # in the haptic server itself
PROGRAMS = (MASTER, SERVER, NODE)  # their options are offered; an option of several programs has the first one's help


@functools.lru_cache(maxsize=None)
def listed(program):
    """Returns what a program lists about itself, see OptionList in host/option_list.hpp. Throws BadInput without a build."""
    path = pathlib.Path(layout.program(program)).with_name(f"{program}.json")
    try:
        return checked_json.parse(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        raise BadInput(f"{path}: no list of options of this build; {layout.MEND}") from None


def offered(command, program):
    """Returns the options of a program that a command of the launcher offers."""
    return [option for option in listed(program)["options"] if command in option.get("offered_by", ())]


def variable(option):
    """Returns the name of the option's value in what argparse returns: frame_timeout for --frame-timeout."""
    return option["name"].removeprefix("--").replace("-", "_")


def type_of(option):
    """Returns the type for argparse, which refuses what the program would refuse."""
    if option["kind"] == "text":
        return None
    kind = int if option["kind"] == "integer" else float
    least, above, most = (whole(option.get(key)) for key in ("least", "above", "most"))
    if most is not None:
        return command_line.within(kind, least, most)
    if above is not None:
        return command_line.above(kind, above)
    return command_line.number(kind, lambda value: True, "") if least is None else command_line.at_least(kind, least)


def whole(value):
    """Returns 2 for 2.0, as people write it, and every other value unchanged."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


def add_option(parser, option):
    """Adds an option of a program to a parser of the launcher."""
    help_text = (option["help"] + option.get("more", "")).replace("%", "%%") + (" (default: %(default)s)" if "default" in option else "")
    if option["kind"] == "flag":
        parser.add_argument(option["name"], action="store_true", help=help_text)
        return
    several = option.get("several", False)
    parser.add_argument(option["name"], type=type_of(option), choices=option.get("values"), metavar=option.get("metavar"),
                        action="append" if several else "store", default=[] if several else option.get("default"), help=help_text)


def add(parser, command, groups=None, changes=None):
    """Adds all options that the programs offer to this command. Options that exclude each other share a group.

    `groups` has a group of argparse for some options, which options of the launcher exclude. `changes` has what the launcher
    changes in some of them: another default, fewer values, or more help.
    """
    groups, added = dict(groups or {}), set()
    for program in PROGRAMS:
        options = offered(command, program)
        excluded = {name for option in options for name in option.get("excludes", ())}
        for option in options:
            name = option["name"]
            if name in added:
                continue
            added.add(name)
            if name in excluded and name not in groups:
                groups[name] = parser.add_mutually_exclusive_group()
            place = next((groups[other] for other in [name, *option.get("excludes", ())] if other in groups), parser)
            add_option(place, {**option, **(changes or {}).get(name, {})})


def words(args, command, program, **instead):
    """Returns the words that pass the given options on to a program. `instead` has other values of some options."""
    found = []
    for option in offered(command, program):
        value = instead.get(variable(option), getattr(args, variable(option)))
        if option["kind"] == "flag":
            found += [option["name"]] if value else []
        else:
            for single in value if isinstance(value, list) else [value]:
                found += [] if single is None else [option["name"], str(whole(single))]
    return found


def kinds_of_device():
    """Returns how a value of --device may begin: the kinds that the haptic server opens, and those of the launcher."""
    return [*next(option for option in listed(SERVER)["options"] if option["name"] == "--device")["beginnings"], "pointer", "none"]


def device(spec):
    """Returns a SPEC of --device with the path of strokes that come with Sandwall, if it names them.

    Throws BadInput for an unknown kind of device, for an unknown name of strokes, and for the device `mouse` of earlier
    versions.
    """
    kind, colon, name = spec.partition(":")
    if spec == "mouse":
        raise BadInput("--device mouse: is gone; give --device pointer, which is the mouse in the wall's windows")
    if (kind + colon) not in kinds_of_device():
        raise BadInput(f"--device {spec}: unknown device; give script:gis, script:FILE, trace:FILE.csv, driver:FILE.so, sim:PRESET, "
                       "spacenav, pointer or none")
    # A word without an ending is a name. The haptic server reports other files that it cannot read.
    if kind == "script" and name != BUILT_IN_STROKES and re.fullmatch(r"[A-Za-z0-9_-]+", name):
        return f"script:{layout.found('strokes', name)}"
    return spec
