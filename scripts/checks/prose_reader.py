# SPDX-License-Identifier: Apache-2.0
"""Reads the prose of a source file: paragraphs of a document, comments, and messages for a person.

Every reader takes the text of a file and yields (line, kind, paragraph). The kind is documents, comments or messages.
"""

import ast
import io
import re
import tokenize

CPP = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|(?<!\w)\'(?:[^\'\\\n]|\\.)+\'', re.DOTALL)
SCRIPT = re.compile(r'''((?:"(?:[^"\\]|\\.)*"|'[^']*'|\\.|[^"'#\\]|(?<=\S)#)*)(?<!\S)#+(?: (.*))?$''')


def markdown(text):
    """Yields (line, kind, paragraph) of a page: paragraphs, items of lists and cells of tables."""
    block, start, fenced = [], 1, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        flat = line.strip()
        item = re.match(r"\s*(?:[-*+]|\d+[.)])\s+", line)
        fence = flat.startswith(("```", "~~~"))
        breaks = fence or fenced or not flat or flat.startswith(("|", "#", "![", "<"))
        if block and (breaks or item):
            yield start, "documents", " ".join(block)
            block = []
        fenced ^= fence
        if flat.startswith("|") and not fenced:
            yield from ((number, "documents", cell.strip()) for cell in flat.strip("|").split("|"))
        elif not breaks and (block or item or not line.startswith("    ")):
            start = start if block else number
            block.append(line[item.end():].strip() if item else flat)


def paragraphs(comments):
    """Yields (line, kind, paragraph) of comments (line, column, text, whether the line holds only the comment)."""
    block, start, last = [], 0, (-1, 0, "", True)
    for number, column, text, alone in comments + [(0, 0, "", True)]:
        follows = alone and number == last[0] + 1 and (last[3] or column == last[1])
        if block and not (follows and text and not re.match(r"[@\\-]|\d\. |\(\d\) ", text)):
            yield start, "comments", " ".join(block)
            block = []
        if text and "SPDX" not in text:
            start = start if block else number
            block.append(text)
        last = (number, column, text, alone)


def cpp(text):
    """Yields (line, kind, paragraph). Literals that '+' or '<<' joins are one message."""
    comments, messages, end = [], [], 0
    for found in CPP.finditer(text):
        start, token = found.start(), found[0]
        number, begin = text.count("\n", 0, start) + 1, text.rfind("\n", 0, start) + 1
        if token.startswith("/"):
            for i, line in enumerate(token.removesuffix("*/").split("\n")):
                alone = i > 0 or not text[begin:start].strip()
                comments.append((number + i, start - begin, line.lstrip("/*!< \t").rstrip("* \t"), alone))
        elif token.startswith('"'):
            between, before = text[end:start], text[max(start - 40, 0):start].rstrip()
            joined = re.fullmatch(r"\s*(?:(?:\+|<<)[^;{}]*(?:\+|<<)\s*)?", between)
            if messages and joined and between.count("(") == between.count(")"):
                messages[-1][1] += "Code" * bool(between.strip()) + token[1:-1]
            else:
                continues = before.endswith("+") or before.endswith("<<") and not token[1].isalpha()
                messages.append([number, "Code" * continues + token[1:-1]])
            end = found.end()
    yield from paragraphs(comments)
    yield from ((number, "messages", message.replace("\\n", "\n").replace('\\"', '"')) for number, message in messages)


def python(text):
    """Yields (line, kind, paragraph): comments, docstrings without their usage, and all other strings as messages."""
    lines, comments, done = text.splitlines(), [], set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT and not token.string.startswith("#!"):
            number, column = token.start
            comments.append((number, column, token.string.lstrip("# "), not lines[number - 1][:column].strip()))
    yield from paragraphs(comments)
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node):
            done.add(node.body[0].value)
            for block in re.split(r"\n\s*\n", ast.get_docstring(node)):
                if not block.startswith(("usage:", "    ")):
                    yield node.body[0].lineno, "comments", " ".join(block.split())
        elif isinstance(node, ast.JoinedStr):
            done |= set(node.values)
            parts = (part.value if isinstance(part, ast.Constant) else "Code" for part in node.values)
            yield node.lineno, "messages", "".join(parts)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in done:
            yield node.lineno, "messages", node.value


def script(text):
    """Returns (line, kind, paragraph) of the comments after '#' in shell and CMake."""
    found = [(number, SCRIPT.match(line)) for number, line in enumerate(text.splitlines(), 1) if not line.startswith("#!")]
    return paragraphs([(number, len(match[1]), (match[2] or "").strip(), not match[1].strip())
                       for number, match in found if match])


READERS = {".md": markdown, ".cpp": cpp, ".hpp": cpp, ".c": cpp, ".h": cpp, ".py": python, ".sh": script, ".cmake": script}


def of(path):
    """Returns the function that reads a file, or None for a file that the check does not know."""
    if path.name == "CMakeLists.txt":
        return script
    if path.suffix:
        return READERS.get(path.suffix)
    first = path.read_bytes()[:40].partition(b"\n")[0]
    return python if b"python" in first else script if re.match(rb"#!.*sh$", first) else None


def for_a_person(message):
    """Returns whether a string literal is a message for a person: at least four words, and no lines of data or code."""
    words = re.findall(r"(?<!\S)[A-Za-z’']{2,}[,.;:]?(?!\S)", message)
    return len(words) > 3 and not re.search(r"(?<!\n)\n(?!\n)|[{}$\\]", message)
