#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that few places ask whether sand is a height field or a TIN, and that a further place is found.

Sand is read as sand::SurfaceData. The four listed places select one of its two alternatives, to make something of the
sand
or to take something from it. All other code calls Surface, Replica or DrawnSurface. Another question is the start of a
scene: code that reads, checks or encodes a scene asks for its table [tin].

usage: kinds_of_sand_test.py
"""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Folders of programs and libraries. Tests, examples and benchmarks know the kind of their sand.
FOLDERS = ("base", "haptic_bridge", "host", "lockstep", "master", "pictures", "render_node", "sand", "scene", "tracking", "walls")

# The four places that may ask for the kind.
PLACES = {
    "sand/surface_factory.cpp": "makes the sand that a replica starts with, and a start of sand",
    "render_node/surface_factory.cpp": "makes the object that draws it",
    "sand/force/surface_patch.cpp": "takes the part that a hand feels",
    "scene/export/results.cpp": "takes rasters and triangles from it",
}
# Code of one kind of sand. It may use its own alternative, and throws if it gets the other one.
KINDS = {
    "sand/grid/": "Grid|Cell",
    "sand/tin/": "Tin",
    "render_node/grid/": "Grid|Cell",
    "render_node/tin/": "Tin",
}
# Files, and folders that end in a slash, that ask whether a scene has a table [tin].
STARTS = {
    "master/": "the memory that ranks need, and the volume that a session begins with",
    "sand/replica.cpp": "the memory that a replica needs",
    "sand/start.cpp": "the mean height",
    "sand/surface_factory.cpp": "makes the sand, and the heights that a hand follows",
    "scene/load/memory.cpp": "the memory that a scene needs",
    "scene/load/scene_file.cpp": "refuses a scheme that a TIN does not have",
    "scene/load/terrain.cpp": "columns and rows",
    "scene/load/tin_settings.cpp": "the spacing of points",
    "scene/load/tin_table.cpp": "reads the table",
    "scene/scene.cpp": "encodes the scene",
}

ALTERNATIVE = re.compile(r"\b(?:get|get_if|holds_alternative|in_place_type)\s*<\s*(?:sand::)?(Grid|Tin)(?:Data|Change)\b|"
                         r"\b(?:get|get_if|holds_alternative|in_place_type)\s*<\s*(?:sand::)?(Cell)Change\b")
# Questions to any std::variant. They count only in files that name these types.
OF_DATA = re.compile(r"\b(?:SurfaceData|SurfaceChange|GridData|TinData|CellChange|TinChange)\b|\bsurface(?:\(\)|_)(?:\.|->)data\(\)|\btakeChange\(\)")
ANY_VARIANT = re.compile(r"\bstd::(?:visit\s*\(|get_if\s*<\s*\d|get\s*<\s*\d)|\bholds_alternative\s*<|\.index\(\)")
# A class of one kind of sand, or a former function that asked for the kind.
CLASS = re.compile(r"\b(?:GridSurface|TinSurface|SandMesh|TinMesh)\b|\btinView\b|\bis(?:Tin|Grid)\b")
START = re.compile(r"\btin\s*(?:==|!=)\s*nullptr|\bnullptr\s*(?:==|!=)\s*[\w.>-]*\btin\b|"
                   r"(?:\bif\s*\(|&&|\|\||!|\()\s*!?(?:\w+(?:\.|->))+tin\s*(?:\)|&&|\|\||\?)")


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def sources():
    return {str(path.relative_to(ROOT)): without_comments(path.read_text())
            for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".cpp", ".hpp")}


def questions(path, text):
    """Returns the expressions in a file that ask for the kind of sand."""
    own = next((kind for folder, kind in KINDS.items() if path.startswith(folder)), None)
    found = [match.group(0) for match in ALTERNATIVE.finditer(text)
             if own is None or "if" in match.group(0) or "holds" in match.group(0)
             or (match.group(1) or match.group(2)) not in own.split("|")]
    if own is None:
        found += CLASS.findall(text)
    if OF_DATA.search(text):
        found += ANY_VARIANT.findall(text)
    return found


def asking(files):
    return {path for path, text in files.items() if questions(path, text)}


def starting(files):
    """Returns the files that ask for the TIN of a start, or the listed folders that hold them."""
    folders = [path for path in STARTS if path.endswith("/")]
    return {next((folder for folder in folders if path.startswith(folder)), path)
            for path, text in files.items() if START.search(text)}


class KindsOfSand(unittest.TestCase):
    files = sources()

    def test_four_places_tell_a_height_field_from_a_tin(self):
        found = {path: questions(path, text) for path, text in self.files.items() if questions(path, text)}
        more = {path: asked for path, asked in found.items() if path not in PLACES}
        self.assertEqual(more, {}, "call Surface, Replica or DrawnSurface, which know the kind of sand")
        self.assertEqual(sorted(found), sorted(PLACES), "remove a place that no longer asks from the list PLACES")

    def test_a_scene_is_asked_for_its_tin_where_it_is_read_or_begins(self):
        self.assertEqual(sorted(starting(self.files)), sorted(STARTS))

    def test_a_fifth_place_is_found_however_it_asks(self):
        for path, text in {
            "render_node/tile_painter.cpp": "if (const auto* tin = std::get_if<sand::TinData>(&data)) {",
            "render_node/sand_box.cpp": "const auto& field = std::get<sand::GridData>(terrain.surface().data()).field;",
            "master/session.cpp": "if (std::holds_alternative<sand::GridData>(terrain.surface().data())) {",
            "lockstep/frame_barrier.cpp": "const sand::SurfaceChange change; std::visit(Send{}, change.parts);",
            "scene/scene.cpp": "const SurfaceData data; return data.index() == 1;",
            "sand/replica.cpp": "const auto* grid = dynamic_cast<const grid::GridSurface*>(surface_.get());",
            "master/journal/verify.cpp": "if (terrain.tinView() == nullptr) {",
            "render_node/grid/mesh.cpp": "if (std::holds_alternative<sand::GridData>(data)) {",
            "render_node/tin/mesh.cpp": "const auto& field = std::get<sand::GridData>(data).field;",
            "render_node/tool/reach.cpp": "for (const auto& cells : std::get<sand::CellChange>(change.parts).cells) {",
        }.items():
            with self.subTest(path):
                self.assertEqual(asking({path: text}), {path})

    def test_code_of_one_kind_takes_its_own_and_other_variants_are_free(self):
        self.assertEqual(asking({
            "render_node/grid/mesh.cpp": "std::get<sand::GridData>(data).field; std::get<sand::CellChange>(change.parts);",
            "render_node/tin/mesh.cpp": "std::get<sand::TinData>(data).view; std::get<sand::TinChange>(change.parts);",
            "haptic_bridge/server/peer.cpp": "if (const auto* hello = std::get_if<Hello>(&message)) {",
            "host/event.cpp": "return std::visit(Print{}, value);",
        }), set())

    def test_a_further_question_to_a_scene_is_found(self):
        for text in ("if (scene.tin != nullptr) {", "return nullptr == scene.tin;", "const bool tin = !(scene->tin);",
                     "return (scene.tin ? 1 : 2);", "if (scene.tin && more) {"):
            with self.subTest(text):
                self.assertEqual(starting({"walls/wall.cpp": text}), {"walls/wall.cpp"})


if __name__ == "__main__":
    unittest.main()
