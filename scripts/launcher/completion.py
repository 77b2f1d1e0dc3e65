# SPDX-License-Identifier: Apache-2.0
"""What can follow `sandwall` on a command line, for completion.bash. No program runs for it.

usage: sandwall complete [COMMAND [OPTION]]   (not in --help)
       sandwall complete ctl VERB
"""

import programs
from ask import session_control
from base import console, program_options


def of_parser(parser):
    """Returns the options of one of the launcher's commands, with and without those of the programs."""
    if parser.later is not None:
        parser.later()
    return sorted({name for action in parser._actions for name in action.option_strings if name.startswith("--")})


def answer(commands, words):
    """Prints the commands, or the options of a command, or all values of an option or the verbs of ctl, if they are known."""
    command, option = [*words, None, None][:2]
    if command is None:
        found = [*commands, "--help", "--version"]
    elif command in programs.TOOLS:
        listed = program_options.listed(f"sandwall-{command}")
        found = [entry["name"] for entry in [*listed.get("commands", ()), *listed["options"]]] + ["--help", "--version"]
    elif command not in commands:
        found = []
    elif option is None:
        found = of_parser(commands[command])
    elif (command, option) == ("ctl", "VERB"):
        found = ["help", *(verb.split()[0] for verb in session_control.verbs())]
    else:
        if option == "--device":
            console.OUT.line("\n".join(program_options.kinds_of_device()))
            return 0
        lists = (program_options.offered(command, program) for program in program_options.PROGRAMS)
        found = next((entry.get("values", []) for entries in lists for entry in entries if entry["name"] == option), [])
    console.OUT.line("\n".join(found))
    return 0
