// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/input_error.hpp"
#include "files/toml_table.hpp"
#include "sand/dunes.hpp"
#include "sand/esri_grid.hpp"
#include "sand/scene.hpp"

namespace sand {
namespace {

constexpr double kPaperRadius = 0.01;  // [scene unit], the first paper's sphere
constexpr double kLargestTool = 2048;  // [cell]
constexpr int kTooCoarse = 4096;       // [unit]: below, rest slopes come out more than a percent too steep

HeightField levelField(const files::TomlTable& file) {
    const files::TomlTable field = file.requiredTable("field");
    const int columns = field.integerOr("columns", 512, 1, kMaxSide);
    const int rows = field.integerOr("rows", columns, 1, kMaxSide);
    const double width = field.numberOr("width", 2.0, files::kPositive);  // the paper's (-1, 1)
    field.finish();
    return {columns, rows, width / columns};
}

std::int32_t heightUnits(const files::TomlTable& terrain, const std::string& key, double height, double unit) {
    const double units = std::floor(height / unit + 0.5);
    if (!(std::abs(units) <= kMaxHeight)) {
        terrain.fail(key, fmt::format("a height of {} is beyond the range of ±{} (4096 cells); set 'datum'", height,
                                      kMaxHeight * unit));
    }
    return static_cast<std::int32_t>(units);
}

HeightField fromEsriGrid(const files::TomlTable& file, const files::TomlTable& terrain) {
    if (file.has("field")) {
        file.fail("field", "[field] is for flat and dunes; an ESRI grid brings its own columns, rows and cell size");
    }
    const EsriGrid grid = readEsriGrid(terrain.folder() / terrain.text("file"));
    const double datum = terrain.numberOr("datum", 0);
    HeightField field(grid.columns, grid.rows, grid.cellSize);
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) {
            const double height = grid.at(column, row) - datum;
            field.setHeight(column, row, heightUnits(terrain, "file", height, field.unit()));
        }
    }
    return field;
}

HeightField makeTerrain(const files::TomlTable& file) {
    const files::TomlTable terrain = file.requiredTable("terrain");
    const int kind = terrain.choiceOr("kind", {"flat", "dunes", "esri_ascii"}, 0);
    HeightField field = kind == 2 ? fromEsriGrid(file, terrain) : levelField(file);
    if (kind != 2) {
        const double bed = terrain.numberOr("height", 0);
        const std::int32_t units = heightUnits(terrain, "height", bed, field.unit());
        for (int row = 0; row < field.rows(); ++row) {
            std::fill_n(field.row(row), field.columns(), units);
        }
        if (kind == 1) {
            Dunes dunes;
            dunes.bed = bed;
            dunes.height = terrain.numberOr("dune_height", dunes.height, {0, 1e9});
            dunes.length = terrain.numberOr("dune_length", dunes.length, files::kPositive);
            dunes.seed = static_cast<std::uint32_t>(terrain.integerOr("seed", 1, 0, 1 << 30));
            heightUnits(terrain, "dune_height", bed + dunes.height, field.unit());
            makeDunes(dunes, field);
        }
    }
    terrain.finish();
    return field;
}

/// How many sweeps a step needs for sand beside the tool to rest after the settling time. A disturbance of R cells
/// needs about R² sweeps to come within a percent, and 2.4 R² without inertia (R = 12: 144 and 350). With fewer than
/// four a step, no inertia would arise.
std::int32_t sweepsFor(Scheme scheme, double radius /* [cell] */, double settlingSeconds, int stepsPerSecond) {
    const double perSquare = scheme == Scheme::isotropic ? 1.0 : 2.4;
    const double sweeps = perSquare * radius * radius / (settlingSeconds * stepsPerSecond);
    return static_cast<std::int32_t>(std::clamp(std::ceil(sweeps), 4.0, 4096.0));
}

void readMaterial(const files::TomlTable& file, Scene& scene) {
    const files::TomlTable material = file.requiredTable("material");
    Rules& rules = scene.rules;
    const double talus = material.numberOr("talus_deg", 34, {0, 90});
    if (talus >= 90) {
        material.fail("talus_deg", "talus_deg must be within [0, 90), got 90");
    }
    // Differences never exceed 2^29: a larger threshold means the same as this one, nothing slides.
    const double slope = std::tan(talus * std::numbers::pi / 180);
    const double threshold = std::min(std::floor(slope * kUnitsPerCell + 0.5), 1073741824.0);
    const double band = material.numberOr("band", 0.001, {0, 1});
    rules.threshold = static_cast<std::int32_t>(threshold);
    rules.startThreshold = static_cast<std::int32_t>(std::min(std::floor(threshold * (1 + band)), 1073741824.0));
    rules.scheme = static_cast<Scheme>(material.choiceOr("scheme", {"g", "n4", "g_plain"}, 0));
    if (rules.scheme == Scheme::n4 && rules.threshold < 4) {
        material.fail("talus_deg", fmt::format("talus_deg is too flat for scheme n4: its threshold is {} units, and "
                                               "4 is the least; use scheme \"g\"",
                                               rules.threshold));
    }
    if (rules.threshold < kTooCoarse) {
        scene.warnings.push_back(fmt::format(
            "a talus of {} deg is {} height units per cell; below {} slopes rest more than a percent too steep", talus,
            rules.threshold, kTooCoarse));
    }
    const double settling = material.numberOr("settling_time", 0.1, {0.001, 1e6});
    rules.sweepsPerStep =
        sweepsFor(rules.scheme, static_cast<double>(rules.toolRadius) / kProbePerCell, settling, rules.stepsPerSecond);
    material.finish();
}

void readTool(const files::TomlTable& file, Scene& scene) {
    const std::optional<files::TomlTable> tool = file.table("tool");
    const double radius = tool ? tool->numberOr("radius", kPaperRadius, files::kPositive) : kPaperRadius;
    const double cells = radius / scene.terrain.cellSize();
    if (!(cells <= kLargestTool)) {
        const std::string message = fmt::format(
            "a tool of radius {} is {:.4g} cells of {}; {} is the most: set radius "
            "in [tool]",
            radius, cells, scene.terrain.cellSize(), kLargestTool);
        tool ? tool->fail("radius", message) : file.fail("tool", message);
    }
    if (cells < 1) {
        scene.warnings.push_back(
            fmt::format("a tool of radius {} is {:.2g} cells of {} and will hardly dig; set radius in [tool]", radius,
                        cells, scene.terrain.cellSize()));
    }
    if (tool) {
        tool->finish();
    }
    scene.rules.toolRadius = static_cast<std::int32_t>(std::floor(cells * kProbePerCell + 0.5));
}

void readForce(const files::TomlTable& file, Scene& scene) {
    if (const auto force = file.table("force")) {
        scene.force.stiffness = force->numberOr("stiffness", scene.force.stiffness, {0, 1e9});
        scene.force.depthExponent = force->numberOr("depth_exponent", scene.force.depthExponent, {0, 1e6});
        scene.force.friction = force->numberOr("friction", scene.force.friction, {0, 1e9});
        force->finish();
    }
}

void readLook(const files::TomlTable& file, Scene& scene) {
    if (const auto look = file.table("look")) {
        scene.look.sandColour = look->numbersOr("sand", scene.look.sandColour);
        scene.look.backgroundColour = look->numbersOr("background", scene.look.backgroundColour);
        scene.look.sunDirection = look->numbersOr("sun", scene.look.sunDirection);
        const auto& sun = scene.look.sunDirection;
        if (sun[0] == 0 && sun[1] == 0 && sun[2] == 0) {
            look->fail("sun", "sun must point somewhere, got [0, 0, 0]");
        }
        look->finish();
    }
}

}  // namespace

Scene loadScene(const std::filesystem::path& file) {
    const files::TomlTable toml = files::TomlTable::load(file);
    Scene scene;
    scene.name = toml.textOr("name", file.stem().string());
    const auto control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
    if (std::any_of(scene.name.begin(), scene.name.end(), control)) {
        toml.fail("name", "name must be one line of plain text");
    }
    scene.rules.stepsPerSecond = toml.integerOr("steps_per_second", 60, 1, 1000);
    scene.rules.rim = static_cast<Rim>(toml.choiceOr("rim", {"closed", "open"}, 0));
    scene.terrain = makeTerrain(toml);
    scene.rules.columns = scene.terrain.columns();
    scene.rules.rows = scene.terrain.rows();
    readTool(toml, scene);
    readMaterial(toml, scene);
    readForce(toml, scene);
    readLook(toml, scene);
    toml.finish();
    return scene;
}

}  // namespace sand
