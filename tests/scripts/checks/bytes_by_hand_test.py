#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that few files write and read bytes by hand, and that a further file is found.

A value lists its members once (base/fields.hpp), and the listed files do what such a list cannot do: they compress, store
differences, or frame other bytes. docs/decisions/values_described_once.md has the same list.

usage: bytes_by_hand_test.py
"""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import product  # noqa: E402

# base/ has the reader, the writer, and the forms of members.
FOLDERS = sorted({*product.folders(), "bench", "examples"} - {"base"})
RECORD = "docs/decisions/values_described_once.md"
MOST = 15

# Files that call put…() or get…() of a ByteWriter or a ByteReader.
BY_HAND = {
    "haptic_bridge/link/handshake.cpp": "the bytes under a proof, which are never read",
    "haptic_bridge/link/message_forms.hpp": "forms of printed texts and of edits",
    "haptic_bridge/link/protocol.cpp": "length and type around a message",
    "haptic_bridge/loop/tick_track.cpp": "differences between ticks",
    "journal/format.cpp": "length, type, mark and checksum around a record",
    "master/journal/checkpoint.cpp": "the state of a checkpoint, which is compressed into its file",
    "sand/grid/snapshot.cpp": "the outflow before compressed cells",
    "sand/model/grid_codec.cpp": "compressed cells",
    "sand/model/movement.cpp": "runs of equal numbers",
    "sand/model/step.cpp": "differences between points of a path",
    "sand/replica_state.cpp": "the head of a state",
    "sand/tin/snapshot.cpp": "a compressed TIN",
    "sand/tin/tool/imprint.cpp": "the imprint, because every step makes a hash of it",
    "sand/tin/volume/vertex_sand_codec.cpp": "numbers of variable length, and gaps",
}

# Headers of types that are written as JSON alone (host/json_fields.hpp), and such a type beside others.
JSON = ("master/measure/failure_report.hpp", "master/measure/incidents.hpp", "master/operator/dark_outputs.hpp",
        "master/measure/summary.hpp", "master/measure/summary_parts.hpp", "tracking/head_tracker.hpp", "web/replica/page_session.hpp")
JSON_TYPES = {"MaterialNumbers"}
LISTS = ("tests/described/types.hpp", "tests/described/rank_types.hpp")

OWNER = re.compile(r"\bByte(?:Reader|Writer)\s*&?\s+(\w+)\s*[;,(){=]|\bByte(?:Reader|Writer)&\s*(\w+)\s*[,)]")
TEMPORARY = re.compile(r"\bByteReader\s*\([^;]*?\)\s*\.\s*get\w*\s*[<(]")


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def sources():
    return {str(path.relative_to(ROOT)): without_comments(path.read_text())
            for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".cpp", ".hpp")}


def by_hand(files):
    """Returns the files in which a reader or a writer is asked for single values."""
    found = set()
    for path, text in files.items():
        names = {name for match in OWNER.finditer(text) for name in match.groups() if name}
        calls = rf"\b(?:{'|'.join(sorted(names))})\s*(?:\.|->)\s*(?:get|put)\w*\s*[<(]"
        if (names and re.search(calls, text)) or TEMPORARY.search(text):
            found.add(path)
    return found


def described(files):
    """Returns the names of the described types in headers. A type in a .cpp file is part of one of them."""
    return {re.findall(r"(?<!enum )\b(?:struct|class) (\w+)[^;(>{]*\{", text[:match.start()])[-1]
            for path, text in files.items() if path.endswith(".hpp") for match in re.finditer(r"\bstatic void fields\(", text)}


class BytesByHand(unittest.TestCase):
    files = sources()
    found = by_hand(files)

    def test_the_listed_files_alone_write_and_read_bytes_by_hand(self):
        self.assertEqual(sorted(self.found - set(BY_HAND)), [], "list the members in fields() (base/fields.hpp)")
        self.assertEqual(sorted(set(BY_HAND) - self.found), [], f"remove these files from BY_HAND and from {RECORD}")

    def test_there_are_few_of_them(self):
        self.assertLessEqual(len(self.found), MOST)

    def test_the_decision_lists_the_same_files(self):
        listed = re.findall(r"^\| `([\w/.]+)` \|", (ROOT / RECORD).read_text(), flags=re.MULTILINE)
        self.assertEqual(sorted(listed), sorted(BY_HAND))

    def test_the_fuzzers_try_every_described_type(self):
        listed = "".join(without_comments((ROOT / path).read_text()) for path in LISTS)
        others = described({path: text for path, text in self.files.items() if path not in JSON}) - JSON_TYPES
        missing = {name for name in others if not re.search(rf"::{name}\b", listed)}
        self.assertEqual(missing, set(), f"add the type to {LISTS[0]} or {LISTS[1]}")

    def test_a_described_type_is_found(self):
        self.assertEqual(described({
            "walls/wall.hpp": "struct Wall {\n    struct Tile { int row; static void fields(Self& it, Visit& visit); };\n};\n"
                              "class Overlays : public Base {\n    template <class S>\n    static void fields(S& it) {}\n};",
            "walls/wall.cpp": "struct Own { static void fields(Self& it, Visit& visit); };",
        }), {"Tile", "Overlays"})

    def test_a_further_file_is_found_however_it_calls(self):
        for text in ("void Rules::encode(base::ByteWriter& writer) const { writer.put(columns); }",
                     "base::ByteWriter body; body.putVarint(3);",
                     "base::ByteReader bytes(all); return bytes.get<int>();",
                     "base::ByteReader payload{all}; (void)payload.getBlock();",
                     "int f(base::ByteReader& in, int most) { return in.get<int>(); }",
                     "const auto length = base::ByteReader(stream).get<std::uint32_t>();",
                     "template <class T> T get(ByteReader& reader) { return reader . get < T > (); }"):
            with self.subTest(text):
                self.assertEqual(by_hand({"walls/wall.cpp": text}), {"walls/wall.cpp"})

    def test_described_values_and_their_forms_are_free(self):
        for text in ("void put(base::ByteWriter& writer) const { base::putMember(writer, it.scene); }",
                     "void get(base::ByteReader& reader) const { value = base::read<Part>(reader); }",
                     "base::ByteWriter writer; base::text(name, 4).put(writer); return writer.take();",
                     "std::unique_ptr<Surface> surface; base::ByteReader reader(bytes); use(surface.get());",
                     "// writer.put(number)\nbase::ByteWriter writer;"):
            with self.subTest(text):
                self.assertEqual(by_hand({"walls/wall.cpp": without_comments(text)}), set())


if __name__ == "__main__":
    unittest.main()
