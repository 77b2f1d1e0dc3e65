# SPDX-License-Identifier: Apache-2.0
"""Finds the places of a source at which one bug can be planted: conditions, constants and signs.

condition: the condition of an `if` is negated. constant: a whole number n becomes n + 1, any other number 1.5 n, and
`true` and `false` become each other. sign: `+` and `-` become each other.
"""

import ast
import dataclasses
import io
import re
import tokenize


@dataclasses.dataclass(frozen=True)
class Site:
    """One bug: the characters from `start` to `end` [index in the text] are replaced."""

    kind: str  # "condition", "constant" or "sign"
    start: int
    end: int
    replacement: str

    def planted(self, text):
        return text[:self.start] + self.replacement + text[self.end:]

    def line(self, text):
        """Returns the number of the line, from 1."""
        return text.count("\n", 0, self.start) + 1

    def line_text(self, text):
        return text[text.rfind("\n", 0, self.start) + 1:].split("\n", 1)[0].strip()

    def words(self, text):
        """Returns the change in words: `a + b`: + becomes -."""
        return f"`{self.line_text(text)}`: {shown(text[self.start:self.end])} becomes {shown(self.replacement)}"


def shown(code):
    return " ".join(code.split())


# Matches text to skip, such as comments, and the tokens at which a bug can be planted. The first alternative that matches counts.
CPP = re.compile(r"""
    (?P<skip> //[^\n]* | /\*.*?\*/ | R"(?P<raw>[^()\s]*)\(.*?\)(?P=raw)" | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*'
            | ^[ \t]*\#(?:\\\n|[^\n])* | static_assert\b[^;]* | operator\s*[-+]+=? | \+\+ | -- | -> )
  | (?P<number> (?<![\w.]) (?: 0[xX][0-9a-fA-F'.]+ (?:[pP][-+]?\d+)? | (?:\d[\d']*\.?[\d']*|\.\d+) (?:[eE][-+]?\d+)? ) [uUlLfFzZ]* )
  | (?P<word> [A-Za-z_]\w* )
  | (?P<sign> [-+] )
    """, re.VERBOSE | re.DOTALL | re.MULTILINE)


def next_number(text):
    """Returns the number of a C++ source that replaces `text`."""
    digits = text.rstrip("uUlLzZ") if text[:2] in ("0x", "0X") else text.rstrip("uUlLfFzZ")
    suffix = text[len(digits):]
    plain = digits.replace("'", "")
    try:
        return str(int(plain, 0 if plain[:2].lower() == "0x" else 10) + 1) + suffix
    except ValueError:
        return f"(1.5 * {text})" if re.fullmatch(r"[\d.eE+-]+", plain) and float(plain) else "1.0" + suffix


def closing(text, start):
    """Returns the index of the bracket that closes the one at `start`, or None if the text ends before."""
    depth = 0
    for match in re.finditer(r"""//[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'|[()]""", text[start:]):
        depth += {"(": 1, ")": -1}.get(match[0], 0)
        if depth == 0 and match[0] == ")":
            return start + match.start()
    return None


def condition(text, start):
    """Returns where the condition of the `if` at `start` begins and ends, or None for an `if` without brackets."""
    opening = re.compile(r"if\s*(?:constexpr\s*)?\(").match(text, start)
    end = opening and closing(text, opening.end() - 1)
    if not end:
        return None
    first = opening.end()  # `if (auto a = f(); a > 0)`: the part behind the semicolon is the condition
    return first + text[first:end].rfind(";") + 1, end


def cpp_sites(text):
    for match in CPP.finditer(text):
        if match["number"]:
            yield Site("constant", match.start(), match.end(), next_number(match["number"]))
        elif match["word"] in ("true", "false"):
            yield Site("constant", match.start(), match.end(), "false" if match["word"] == "true" else "true")
        elif match["word"] == "if" and (found := condition(text, match.start())):
            yield Site("condition", *found, f"!({text[slice(*found)].strip()})")
        elif match["sign"]:
            yield Site("sign", match.start(), match.end(), "-" if match["sign"] == "+" else "+")


def python_sites(text):
    starts = [0]  # index of each line
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    def index(row, column):
        """Returns the index of a position of ast, whose column is in bytes."""
        line = text[starts[row - 1]:starts[row]]
        return starts[row - 1] + len(line.encode()[:column].decode())

    def span(node):
        return index(node.lineno, node.col_offset), index(node.end_lineno, node.end_col_offset)

    strings = []  # format strings, whose parts have no position of their own in each version of Python
    nodes = [ast.parse(text)]
    while nodes:
        node = nodes.pop()
        if isinstance(node, ast.JoinedStr):
            strings.append(span(node))
            continue
        nodes += ast.iter_child_nodes(node)
        if isinstance(node, (ast.If, ast.IfExp)):
            start, end = span(node.test)
            yield Site("condition", start, end, f"(not ({text[start:end]}))")
        elif isinstance(node, ast.Constant) and isinstance(node.value, (bool, int, float)):
            value = node.value
            changed = not value if isinstance(value, bool) else value + 1 if isinstance(value, int) else 1.5 * value or 1.0
            yield Site("constant", *span(node), repr(changed))
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.OP and token.string in ("+", "-", "+=", "-="):
            start = starts[token.start[0] - 1] + token.start[1]
            if not any(first <= start < last for first, last in strings):
                yield Site("sign", start, start + 1, "-" if token.string[0] == "+" else "+")


def sites(name, text):
    """Returns the places of the source `name` with the text `text`, in the order of the text. Leaves out format strings of Python."""
    found = cpp_sites(text) if name.endswith(".cpp") else python_sites(text)
    return sorted(set(found), key=lambda site: (site.start, site.end))
