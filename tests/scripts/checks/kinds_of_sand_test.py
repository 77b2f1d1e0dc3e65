#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests that few files know whether sand is a height field or a TIN, and that a further file is found.

Sand is read as sand::SurfaceData. The five files in PLACES select one of its two alternatives, to make something of the
sand or to take something from it. All other code calls Surface, Replica, Start, FieldSize, Rules or DrawnSurface.

Outside sand/ and the two folders that draw it, a file knows a kind if it names something of one kind: a folder, a
namespace, a class, the table [tin], or anything with the word tin. KNOWING lists these files one by one, with reasons.
A HeightField is no kind of sand: it is a raster of heights, from which a TIN is made, too.

usage: kinds_of_sand_test.py
"""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "checks"))
import product  # noqa: E402

# The five places that may ask for the kind.
PLACES = {
    "sand/surface_factory.cpp": "makes the sand that a replica starts with, and a start of sand",
    "render_node/surface_factory.cpp": "makes the object that draws it",
    "sand/force/surface_patch.cpp": "takes the part that a hand feels",
    "scene/export/results.cpp": "takes rasters and triangles from it",
    "web/drawing/drawing.cpp": "makes the object that draws it for a page, and takes its heights",
}
# Code of one kind of sand. It may use its own alternative, and throws if it gets the other one.
KINDS = {
    "sand/grid/": "Grid|Cell",
    "sand/tin/": "Tin",
    "render_node/grid/": "Grid|Cell",
    "render_node/tin/": "Tin",
    "shapes/grid/": "Grid|Cell",
    "shapes/tin/": "Tin",
}
# Files of sand that belong to no kind, and ask whether a Start is a TIN.
STARTS = {
    "sand/start.cpp": "memory, mean height and bytes of the sand",
    "sand/surface_factory.cpp": "makes the sand, its volume, and the heights that a hand follows",
}
# Files outside sand/ and its drawing that know a kind of sand.
KNOWING = {
    "render_node/surface_factory.cpp": "makes the object that draws it",
    "scene/export/results.cpp": "takes rasters and triangles from it",
    "scene/export/tin_raster.cpp": "samples a TIN for a raster",
    "scene/export/tin_raster.hpp": "declares this",
    "scene/load/scene_file.cpp": "calls the readers of [tin], and refuses a scheme that a TIN does not have",
    "scene/load/terrain.cpp": "dunes; points need [tin]; the size that is checked is that of a TIN's cells",
    "scene/load/tin_settings.cpp": "reads the numbers in [tin]",
    "scene/load/tin_settings.hpp": "declares this",
    "scene/load/tin_table.cpp": "makes a TIN of a field or of points",
    "scene/load/tin_table.hpp": "declares this",
    "scene/relax/main.cpp": "calls the program for rasters or the one for TINs",
    "scene/relax/options.hpp": "declares both",
    "scene/relax/raster_thinning.cpp": "chooses the vertices of a TIN",
    "scene/relax/relax_grid.cpp": "brings a raster to rest",
    "scene/relax/relax_tin.cpp": "brings a TIN to rest",
    "scene/relax/relaxation.cpp": "sweeps of a height field, with their certificate",
    "scene/relax/relaxation.hpp": "declares this",
    "scene/relax/slivers.cpp": "finds thin triangles",
    "scene/relax/slivers.hpp": "declares this",
    "scene/relax/steepness.cpp": "slopes by the flux limits of a height field",
    "scene/relax/tin_sand.cpp": "makes a TIN of a file",
    "scene/relax/tin_sand.hpp": "declares this",
    "web/drawing/drawing.cpp": "makes the object that draws it for a page, and takes its heights",
}
MOST_KNOWING = 23

ALTERNATIVE = re.compile(r"\b(?:get|get_if|holds_alternative|in_place_type)\s*<\s*(?:sand::)?(Grid|Tin)(?:Data|Change)\b|"
                         r"\b(?:get|get_if|holds_alternative|in_place_type)\s*<\s*(?:sand::)?(Cell)Change\b")
# Questions to any std::variant. They count only in files that name these types.
OF_DATA = re.compile(r"\b(?:SurfaceData|SurfaceChange|GridData|TinData|CellChange|TinChange)\b|\bsurface(?:\(\)|_)(?:\.|->)data\(\)|\btakeChange\(\)")
ANY_VARIANT = re.compile(r"\bstd::(?:visit\s*\(|get_if\s*<\s*\d|get\s*<\s*\d)|\bholds_alternative\s*<|\.index\(\)")
# A class of one kind of sand, or a former function that asked for the kind.
CLASS = re.compile(r"\b(?:GridSurface|TinSurface|GridMesh|TinMesh)\b|\btinView\b|\bis(?:Tin|Grid)\b")
START = re.compile(r"\btin\s*(?:==|!=)\s*nullptr|\bnullptr\s*(?:==|!=)\s*[\w.>-]*\btin\b|"
                   r"(?:\bif\s*\(|&&|\|\||!|\()\s*!?(?:\w+(?:\.|->))+tin\s*(?:\)|&&|\|\||\?)")
# Anything of one kind: a header, a namespace, a class, FieldSize::nominal, or the word tin in a name or in a text. The
# other words that begin with Grid are rasters and walls.
KIND = re.compile(r"\"(?:sand|shapes|render_node)/(?:grid|tin)/|\b(?:grid|tin)\s*::|\bGrid(?:Data|Mesh|Surface|Vert\w+)\b|\bCellChange\b|"
                  r"\b(?:is|has)Grid\b|(?:\.|->)nominal\b|\b[tT]in(?![a-z])\w*|\b\w*[a-z0-9_]Tin(?![a-z])\w*|\b\w+_tin(?![a-z])\w*")


def without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def sources():
    return {str(path.relative_to(ROOT)): without_comments(path.read_text())
            for folder in product.folders() for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".cpp", ".hpp")}


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
    """Returns the files that ask for the TIN of a start."""
    return {path for path, text in files.items() if START.search(text)}


def knowing(files):
    """Returns the files outside sand/ and its drawing that know a kind of sand."""
    return {path for path, text in files.items()
            if not path.startswith(("sand/", "render_node/grid/", "render_node/tin/", "shapes/grid/", "shapes/tin/")) and KIND.search(text)}


class KindsOfSand(unittest.TestCase):
    files = sources()

    def test_five_places_tell_a_height_field_from_a_tin(self):
        found = {path: questions(path, text) for path, text in self.files.items() if questions(path, text)}
        more = {path: asked for path, asked in found.items() if path not in PLACES}
        self.assertEqual(more, {}, "call Surface, Replica or DrawnSurface, which know the kind of sand")
        self.assertEqual(sorted(found), sorted(PLACES), "remove a place that no longer asks from the list PLACES")

    def test_few_files_outside_sand_know_a_kind(self):
        self.assertEqual(sorted(knowing(self.files)), sorted(KNOWING),
                         "ask Start, FieldSize, Rules, Surface or Replica; remove a file that no longer knows")
        self.assertLessEqual(len(KNOWING), MOST_KNOWING)

    def test_two_files_of_sand_ask_for_the_tin_of_a_start(self):
        of_none = {path: text for path, text in self.files.items()
                   if path.startswith("sand/") and not path.startswith(("sand/grid/", "sand/tin/"))}
        self.assertEqual(sorted(starting(of_none)), sorted(STARTS))

    def test_a_fifth_place_is_found_however_it_asks(self):
        for path, text in {
            "render_node/tile_painter.cpp": "if (const auto* tin = std::get_if<sand::TinData>(&data)) {",
            "shapes/sand_box.cpp": "const auto& field = std::get<sand::GridData>(terrain.surface().data()).field;",
            "master/session.cpp": "if (std::holds_alternative<sand::GridData>(terrain.surface().data())) {",
            "lockstep/frame_barrier.cpp": "const sand::SurfaceChange change; std::visit(Send{}, change.parts);",
            "scene/model/scene.cpp": "const SurfaceData data; return data.index() == 1;",
            "sand/replica.cpp": "const auto* grid = dynamic_cast<const grid::GridSurface*>(surface_.get());",
            "replay/verify.cpp": "if (terrain.tinView() == nullptr) {",
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

    def test_a_further_question_to_a_start_is_found(self):
        for text in ("if (scene.tin != nullptr) {", "return nullptr == scene.tin;", "const bool tin = !(scene->tin);",
                     "return (scene.tin ? 1 : 2);", "if (scene.tin && more) {"):
            with self.subTest(text):
                self.assertEqual(starting({"sand/replica.cpp": text}), {"sand/replica.cpp"})

    def test_a_further_file_that_knows_a_kind_is_found(self):
        for text in ("#include \"sand/grid/erosion.hpp\"", "#include \"render_node/tin/mesh.hpp\"",
                     "const sand::grid::Erosion::Options& sweeps", "using namespace sand::tin;  tin::Mesh mesh;",
                     "if (rules.tin == 0) {", "return scene->tin;", "file.has(\"tin\")", "void check(int rows, bool tin);",
                     "bool isTin() const;", "const bool has_tin = true;", "sand::TinStart start;", "TinMesh mesh;", "bool tin_;",
                     "sand::GridData{scene.terrain}", "if (size.nominal) {", "std::get<sand::CellChange>(parts)"):
            for path in ("master/start_up.cpp", "scene/load/memory.hpp", "shapes/sand_box.cpp"):
                with self.subTest(text, path=path):
                    self.assertEqual(knowing({path: text}), {path})

    def test_other_words_are_free(self):
        for text in ("const walls::Grid& grid = *wall.grid;", "EsriGrid grid;", "MaterialGrid grid() const;", "drawGrid(target);",
                     "Pattern::grid", "int setting = min(latin, tint, hinting);", "kTinted", "sand::HeightField field;"):
            with self.subTest(text):
                self.assertEqual(knowing({"walls/wall.cpp": text}), set())


if __name__ == "__main__":
    unittest.main()
