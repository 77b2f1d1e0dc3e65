# SPDX-License-Identifier: Apache-2.0
"""Reads text files in the encodings that people have, by the rules of base/text_decoder.hpp. Both have the same tests."""

import codecs
import re

UTF16 = {b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}
ENDS = {"\0": "a byte 0 is inside the text; the file is damaged, or no text; save it as UTF-8",
        "\x1a": "a byte 0x1A, with which texts of DOS end, is inside the text; remove it"}


class NotText(Exception):
    """A file that cannot be read as text: the number of a line, and one line for the user."""

    def __init__(self, line, message):
        super().__init__(message)
        self.line = line


def encoding_of(data):
    """Returns the name of UTF-16 in one byte order, or None for UTF-8 and Latin-1."""
    begin = data[:4]
    if begin in (b"\xff\xfe\0\0", b"\0\0\xfe\xff"):
        raise NotText(1, "begins with the byte order mark of UTF-32; save it as UTF-8")
    if begin[:2] in UTF16:
        return UTF16[begin[:2]]
    # Without a mark, every second byte of an ASCII text in UTF-16 is 0.
    zeros = [byte == 0 for byte in begin]
    return {(False, True, False, True): "utf-16-le", (True, False, True, False): "utf-16-be"}.get(tuple(zeros))


def as_latin1(error):
    """Decodes the first byte that is not UTF-8 as Latin-1. For bytes.decode()."""
    return chr(error.object[error.start]), error.start + 1


codecs.register_error("sandwall-latin1", as_latin1)


def characters_of(data):
    encoding = encoding_of(data)
    if encoding is None:
        return data.decode("utf-8", "sandwall-latin1")
    if len(data) % 2 == 1:
        raise NotText(data.decode(encoding, "replace").count("\n") + 1,
                      "the text ends in the middle of a character of UTF-16; the file may be cut")
    return data.decode(encoding, "replace")


def lines_of(data):
    """Returns the lines of the bytes of a text file, without their ends. Throws NotText."""
    text = re.sub("\r\n?", "\n", characters_of(data).replace("\ufeff", "").replace("\xa0", " "))
    end = re.search("[\0\x1a]", text)
    if end:
        behind = re.search("[^\0\x1a \t\n\f\v]", text[end.start():])
        if behind:
            raise NotText(text.count("\n", 0, end.start() + behind.start()) + 1, ENDS[end[0]])
        text = re.sub("[\0\x1a]", "", text)
    text = re.sub("[\f\v]", " ", text)
    lines = text.split("\n")
    return lines if lines[-1] else lines[:-1]
