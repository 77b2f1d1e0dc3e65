#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds sentences that a reader has to read twice, in documents, comments and messages.

Reads Markdown, the comments and string literals of C++ and Python, and the comments of shell and CMake. Skips code, text
in backquotes, fenced blocks and headings. The words to avoid are the phrases in backquotes in the table of docs/glossary.md
below "Words that we avoid". A semicolon ends a sentence of a message, because most messages have no full stops. Prints the
share of flagged sentences per kind of text and the number of flags per rule.

Exit status 1: more than 1 % of the documents' or the comments' sentences are flagged, or more than 0.5 % of the messages.
Exit status 2: a path does not exist or cannot be checked.

usage: scripts/plain_english.py [--list] [PATH...]   (--list: also print every flagged sentence with its file and line;
PATH: a file, or a folder whose tracked files are read; default: the whole repository)
"""

import argparse
import collections
import os
import pathlib
import re
import signal
import subprocess
import sys

sys.dont_write_bytecode = True
import prose_reader

ROOT = pathlib.Path(__file__).resolve().parents[2]
GLOSSARY = ROOT / "docs" / "glossary.md"
MOST_FLAGGED = {"documents": 1.0, "comments": 1.0, "messages": 0.5}  # [%]
MOST_WORDS = 25
PROGRAM = ("(?:agent|client|launcher|master|node|peer|process|program|rank|replica|script|server|session|supervisor|thread|"
           "wall)(?:s|es)?")
VERB = ("(?:is|are|was|were|has|have|had|does|do|did|can|cannot|could|may|might|must|will|should|needs?|takes?|makes?|goes|"
        "comes?|holds?|held|knows?|gives?|stays?|draws?|moves?|costs?|looks?|ends|begins|lies|stands|becomes|gets|lets|keeps|"
        "allows)")
# Punctuation and prepositions before a clause.
BEFORE_CLAUSE = r"(?:[;:(–] ?|\b(?:by|for|to|of|with|from|than|as|in|on|at) )"

RULES = {name: re.compile("|".join(patterns)) for name, patterns in {
    "clause without a noun": [  # except "where x is …", which explains a formula
        r"^([Ww]ho|[Ww]hat|[Ww]hatever|Which|Where|How)\b(?!\(| to |$)(?!.*\?)(?!(?<=ere) \w(_\w+)? (is|are|=))",
        rf"(?:^|{BEFORE_CLAUSE}|\b(?:and|or|but|if|where|when) )([Ww]ho|[Ww]hom)\b(?!.*\?)",
        rf"\b[Ww]hat (lies|stands|goes|comes?|came|moves?|flows?|falls|remains)\b(?!.*\?)",
        rf"{BEFORE_CLAUSE}what (is|was|has|had)\b(?!.*\?)",
        r"\b[Tt]hose (that|who|which)\b|\bthat which\b|^[Tt]hat (a|an|the|each|every|no|what|all) "],
    "negation as a value": [
        r"(?<![Tt]here )\b(is|are|was|were) (none\b(?![,'])|nothing\b)",
        r"(?<![Tt]here )\b(is|are|was|were) no (?!longer|more|less|reason|point|problem|doubt|\w+er than)\w",
        r"(?:^|[,;:(] |\b(?:or|and|returns?|gives?) )(nothing|none) (when|where|if|for|while|until|unless)\b",
        r"^None (when|where|if|for)\b|\b([Nn]obody|[Nn]o one)\b",
        r"\b(no|none|nothing)\b[^.,:;]{0,60}\b(nothing|none)\b|\b([Nn]othing|[Nn]one|[Nn]o \w+) but\b"],
    "leans on another line": [
        r"^(Same|The same)( (of|for|with|within|without|in|from|at|through|where|when|if|but|and|on|by|holds|is|applies)\b|"
        r"[,.:;]|$)",
        r"^([Ll]ikewise|[Dd]itto|As (it|they|those|these|its|their|above|before|below)|So (is|are|do|does))\b",
        r"^As \w+['’]s?\.?$"],
    "'of' in front": [r"^Of (?!course)"],
    "'for' as because": [
        r", for (it|they|he|she|there|few|so|what|then|that) ",
        rf", for (?:(?!\b(?:each|every|all|some|who|that|which|where|when|if|what|as|to)\b)[^,.;:()])+ {VERB}\b"],
    "verb before subject": [
        r"^Nor\b|\bso (neither )?(is|are|does|do|did|has|have|was|were|can|may|must) (a|an|the|its|every|each|one|this|that)\b",
        r"^(Should|Were|Had) (a|an|the|it|its|they)\b[^?]*,[^?]*$",
        r"^(Here|There|Behind|Beside|Below|Above|Under|Before|After|Between|Around|From|In|On|At|With|Among|Beyond)\b"
        r"[^,:;]{0,40} (lies|stands|comes|goes|hangs|sits) (a|an|the|its|what|those|their)\b"],
    "'nor' without 'neither'": [r"^(?!.*\b[Nn]either\b).*\bnor\b"],
    "of which": [r"(?<!track )(?<!all )(?<!each )(?<!both )(?<!some )(?<!most )(?<!one )\bof (which|whom)\b"],
}.items()}
# Rules for the first words of a comment, which has no sentence or cell of a table before it.
OPENING_RULES = {
    "clause without a noun": re.compile(r"^(which|where|how)\b(?! to )(?!(?<=ere) \w(_\w+)? (is|are|=))"),
    "leans on another line": re.compile(rf"^The same\b(?![^.,;:]* {VERB}\b)|^([Tt]hey|[Ii]ts|[Tt]heir|[Aa]nd|[Bb]ut|[Oo]r)\b"),
}

# A word has letters and is not code. A list of names counts as one word.
WORD = re.compile(r"(?<!\S)(?!\W*Code\b)(?:\S*[A-Za-z]{2}\S*|[aAI](?!\S))")
LIST = re.compile(r"(?:, (?:and |or )?[\w'’-]+(?: [\w'’-]+)?(?=[,.;:)]| and | or |$)){3,}")
UNIT_OR_PARAMETER = re.compile(r"^\[[^]]*\][,:;]? |^[@\\](?:param(?:\[\w+\])? \w+|\w+) +")


def words_to_avoid(page):
    """Returns one pattern for the phrases in backquotes in the first column of the table below `Words that we avoid`."""
    table = re.search(r"^## Words that we avoid\n[^|]*((?:\|.*\n)+)", page, re.MULTILINE)[1]
    phrases = [phrase for row in table.splitlines()[2:] for phrase in re.findall(r"`([^`]+)`", row.split("|")[1])]
    alternatives = "|".join(map(re.escape, phrases)).replace("PROGRAM", PROGRAM)
    return re.compile(rf"(?<![\w-])({alternatives})(?![\w-])", re.IGNORECASE)


def flags(sentence, opens_comment, avoided):
    """Returns the names of the rules that a sentence breaks."""
    sentence = UNIT_OR_PARAMETER.sub("", sentence)
    rules = [*RULES.items(), *(OPENING_RULES.items() if opens_comment else ())]
    found = list(dict.fromkeys(name for name, pattern in rules if pattern.search(sentence)))
    if len(WORD.findall(LIST.sub(", list", sentence))) > MOST_WORDS:
        found.append(f"more than {MOST_WORDS} words")
    if word := avoided.search(sentence):
        found.append(f"word to avoid: {word[0]}")
    return found


def sentences(text, kind="comments"):
    """Returns the sentences of a paragraph, with Code in place of text in backquotes and without emphasis."""
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)|https?://\S+", r"\1", re.sub(r"`[^`]*`", "Code", text)).replace("**", "")
    text = re.sub(r"\b(e\.g|i\.e|[Ff]igs?|[Ee]qs?|vs|al|cf|etc|[A-Z])\.(?= )", r"\1", text)
    ends = r"(?<=[.?!])\s+(?=\w|\()|(?<=[:;])\s+(?=[A-Z(]|\w+:)" + r"|(?<=;)\s+" * (kind == "messages")
    return [part.strip(" *_") for part in re.split(ends, text)]


def judged(path, avoided):
    """Yields (line, kind, sentence, flags). A sentence of fewer than four words counts only in a comment, and if it is flagged."""
    for line, kind, text in prose_reader.of(path)(path.read_text(errors="replace")):
        if kind == "messages":
            text = re.sub(r"\{[^{}]*\}|%[.\d]*[a-z]\b", "Code", text).strip()
            if not prose_reader.for_a_person(text):
                continue
        for i, sentence in enumerate(sentences(text, kind)):
            words = len(sentence.split())
            judge = words > 3 or kind == "comments" and (words > 1 or i == 0)
            found = flags(sentence, kind == "comments" and i == 0, avoided) if judge else []
            if words > 3 or found:
                yield line, kind, sentence, found


def files(paths):
    """Yields the files to read. Throws OSError for a path that does not exist or holds no text to check."""
    for path in paths:
        listed = [path]
        if path.is_dir():
            git = subprocess.run(["git", "ls-files", "-z"], cwd=path, capture_output=True, text=True)
            listed = [path / name for name in git.stdout.split("\0") if name and (path / name).is_file() and not (path / name).is_symlink()]
            listed = [file for file in listed if prose_reader.of(file)]
        elif not path.exists():
            raise OSError(f"{path}: does not exist; check the path")
        if not listed or not prose_reader.of(listed[0]):
            raise OSError(f"{path}: holds no text that this check reads; usage: scripts/plain_english.py [--list] [PATH...]")
        yield from listed


def count(options):
    """Returns three counters: sentences by kind, flagged sentences by kind, flags by rule. Prints what --list asks for."""
    avoided = words_to_avoid(GLOSSARY.read_text())
    seen, flagged, rules = collections.Counter(), collections.Counter(), collections.Counter()
    for path in files(options.paths):
        for line, kind, sentence, found in judged(path, avoided):
            seen[kind] += 1
            flagged[kind] += bool(found)
            rules.update(name.partition(":")[0] for name in found)
            if found and options.list:
                print(f"{os.path.relpath(path)}:{line}: {kind}: [{'; '.join(found)}] {' '.join(sentence.split())}")
    return seen, flagged, rules


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("paths", nargs="*", type=pathlib.Path, default=[ROOT], metavar="PATH")
    try:
        seen, flagged, rules = count(parser.parse_args())
    except (OSError, SyntaxError) as error:
        print(f"plain_english.py: {error}", file=sys.stderr)
        return 2
    share = {kind: 100 * flagged[kind] / seen[kind] for kind in MOST_FLAGGED if seen[kind]}
    for kind in share:
        print(f"{kind}: {flagged[kind]} of {seen[kind]} sentences flagged, {share[kind]:.1f} %")
    for name, number in rules.most_common():
        print(f"  {number} {name}")
    too_many = [kind for kind in share if share[kind] > MOST_FLAGGED[kind]]
    for kind in too_many:
        print(f"plain_english.py: {share[kind]:.1f} % of the sentences in {kind} are flagged, more than {MOST_FLAGGED[kind]} %; "
              "rewrite the ones that --list prints", file=sys.stderr)
    return 1 if too_many else 0


if __name__ == "__main__":
    sys.exit(main())
