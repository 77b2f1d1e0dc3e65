# SPDX-License-Identifier: Apache-2.0
"""Reads the names in C++ headers: all identifiers, their parts, and the types that a namespace declares."""

import re

import prose_reader

IDENTIFIER = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
PART = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
DEFINED = r"(?:class|struct|enum class|enum) (?:\[\[\w+\]\] )?(\w+)(?: final)?\s*(?::[^:;{}()=][^;{}()=]*)?\{"
TOKEN = re.compile(r"namespace ([\w:]+) \{|namespace \{|" + DEFINED + r"|using (\w+) = |[{}]")


def code(text):
    """Returns a C++ text without comments, literals and preprocessor lines. Lines stay where they are."""
    def blank(match):
        return "\n" * match[0].count("\n")
    return re.sub(r"^[ \t]*#(?:[^\n\\]|\\\n?)*", blank, prose_reader.CPP.sub(blank, text), flags=re.MULTILINE)


def parts(identifier):
    """Returns the words of an identifier in lower case: grantSentNs has grant, sent and ns."""
    return [part.lower() for part in PART.findall(identifier)]


def identifiers(text):
    """Yields (line, identifier) for each identifier of a C++ text, at its first place."""
    seen = set()
    for number, line in enumerate(code(text).splitlines(), 1):
        for found in IDENTIFIER.finditer(line):
            if found[0] not in seen:
                seen.add(found[0])
                yield number, found[0]


def types(text):
    """Yields the full name of each class, struct, enum and alias that a header defines in a namespace.

    Leaves out types inside of classes and functions.
    """
    open_, plain = [], 0  # names of the open namespaces, and the number of other open braces
    for found in TOKEN.finditer(code(text)):
        namespace, declared, alias = found.groups()
        if found[0] == "}":
            if plain:
                plain -= 1
            elif open_:
                open_.pop()
            continue
        name = declared or alias
        if name and not plain and open_ and all(open_):
            yield "::".join([*open_, name])
        if found[0].startswith("namespace") and not plain:
            open_.append(namespace or "")
        elif not alias:
            plain += 1
