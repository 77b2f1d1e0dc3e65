// SPDX-License-Identifier: Apache-2.0
#include "scene/load/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/input_error.hpp"
#include "host/toml_table.hpp"
#include "sand/force/finite_law.hpp"
#include "sand/replica.hpp"
#include "sand/surface_factory.hpp"
#include "scene/load/colour.hpp"
#include "scene/load/progress.hpp"
#include "scene/load/terrain.hpp"
#include "scene/load/tin_settings.hpp"
#include "scene/load/tin_table.hpp"
#include "scene/model/material.hpp"

namespace scene {
namespace {

constexpr double kTerrain = 0.5;  // part of the time of reading a TIN that its heights take; the mesh takes the rest
constexpr int kTooCoarse = 4096;  // [unit]; below it, rest slopes are more than a percent too steep

/// Reads the keys of [material]. The table may be missing, because dry sand is the default.
void readMaterialKeys(const host::TomlTable& table, Scene& scene) {
    for (const MaterialKey& key : materialKeys()) {
        const double value = table.numberOr(key.key, key.lowest, {key.lowest, key.highest, key.highestIsOut});
        if (table.has(key.key)) {
            key.set(scene.material, value);
        }
    }
    scene.rules.scheme = table.valueOr("scheme", scene.rules.scheme);
    if (scene.tin != nullptr && scene.rules.scheme != sand::Scheme::isotropic) {
        table.fail("scheme", fmt::format("a TIN has no scheme \"{}\", only \"g\"; leave out 'scheme', or [tin]",
                                         table.text("scheme")));
    }
    if (const auto fault = faultOf(scene.material, scene.grid())) {
        table.fail(fault->key, fault->message);
    }
    table.finish();
}

void readMaterial(const host::TomlTable& file, Scene& scene) {
    if (const auto table = file.table("material")) {
        readMaterialKeys(*table, scene);
    }
    scene.rules.tuning = tuningOf(scene.material, scene.grid());
    if (scene.rules.tuning.threshold < kTooCoarse) {
        scene.warnings.push_back(fmt::format(
            "a talus of {} deg is {} height units per cell; below {} slopes rest more than a percent too steep",
            scene.material.talus(), scene.rules.tuning.threshold, kTooCoarse));
    }
}

void readShape(const host::TomlTable& tool, Material& material) {
    material.toolKind = tool.valueOr("shape", sand::ToolKind::sphere);
    if (const double width = tool.numberOr("width", 1, {kNarrowestTool, 1}); tool.has("width")) {
        material.toolWidth = width;
    }
    material.toolHeading = tool.numberOr("heading_deg", 0, {-360, 360});
    material.leftFoot = tool.choiceOr("foot", {"right", "left"}, 0) == 1;
}

void readTool(const host::TomlTable& file, Scene& scene) {
    const std::optional<host::TomlTable> tool = file.table("tool");
    double& radius = scene.material.toolRadius;
    radius = scene::usualToolRadius(scene.rules.columns, scene.rules.rows, scene.terrain.cellSize());
    radius = tool ? tool->numberOr("radius", radius, host::kPositive) : radius;
    if (tool) {
        readShape(*tool, scene.material);
    }
    const auto fault = faultOf(scene.material, scene.grid());
    if (fault && tool && tool->has(fault->key)) {
        tool->fail(fault->key, fault->message);
    }
    if (fault && fault->key == "radius") {
        const std::string message = fault->message + ": set radius in [tool]";
        tool ? tool->fail("radius", message) : file.fail("tool", message);
    }
    if (const double cells = radius / scene.terrain.cellSize(); cells < 1) {
        scene.warnings.push_back(
            fmt::format("a tool of radius {} is {:.2g} cells of {} and will hardly dig; set radius in [tool]", radius,
                        cells, scene.terrain.cellSize()));
    }
    if (tool) {
        tool->finish();
    }
}

void readForceKeys(const host::TomlTable& table, sand::ForceConstants& force) {
    for (const sand::ForceKey& key : sand::forceKeys()) {
        force.*key.constant = table.numberOr(key.name, force.*key.constant, {key.lowest, key.highest});
    }
    force.law = table.valueOr("law", force.law);
    force.between = table.valueOr("between", force.between);
    force.literal = table.flagOr("literal", false);
    force.frictionDirection = table.valueOr("friction_direction", force.frictionDirection);
    if (!force.literal && force.frictionDirection != sand::FrictionDirection::tangential) {
        table.fail("friction_direction",
                   "friction_direction other than tangential is for comparison: set literal = true beside it");
    }
    table.finish();
}

/// Refuses a law that is not finite wherever a tool can be. The default of depth_exponent gives way instead.
void requireFiniteLaw(const std::optional<host::TomlTable>& table, Scene& scene) {
    const MaterialGrid grid = scene.grid();
    const auto region = sand::force::LawRegion::of(grid.longerSide, grid.cellSize);
    if (!table || !table->has("depth_exponent")) {
        scene.force.depthExponent = sand::force::usualDepthExponent(scene.force, region);
    }
    const auto fault = sand::force::faultOf(scene.force, region);
    if (fault && table) {
        const std::string advice =
            fault->allowed ? fmt::format("give at {} {:g}", fault->atMost ? "most" : "least", *fault->allowed)
                           : "leave it out";
        table->fail(fault->key->name, fmt::format("{} {} gives a force that is not finite {:g} scene units deep; {}",
                                                  fault->key->name, fault->value, fault->depth, advice));
    }
}

void readForce(const host::TomlTable& file, Scene& scene) {
    scene.force.unitLength = std::max(scene.rules.columns, scene.rules.rows) * scene.terrain.cellSize();
    const std::optional<host::TomlTable> table = file.table("force");
    if (table) {
        readForceKeys(*table, scene.force);
    }
    requireFiniteLaw(table, scene);
}

// [pixel]: GL guarantees only that the grid of vertices is at least as fine as a sixteenth of a pixel.
constexpr double kLeastDetail = 1.0 / 16;

void readLook(const host::TomlTable& file, Scene& scene) {
    if (const auto look = file.table("look")) {
        scene.look.sandColour = colourOr(*look, "sand", scene.look.sandColour);
        scene.look.backgroundColour = colourOr(*look, "background", scene.look.backgroundColour);
        scene.look.sunDirection = look->numbersOr("sun", scene.look.sunDirection);
        scene.look.hillShade = look->flagOr("hill_shade", scene.look.hillShade);
        scene.look.flatShading = look->choiceOr("shading", {"smooth", "flat"}, 0) == 1;
        const auto& sun = scene.look.sunDirection;
        if (sun[0] == 0 && sun[1] == 0 && sun[2] == 0) {
            look->fail("sun", "sun must point somewhere, got [0, 0, 0]");
        }
        const double& detail = scene.look.detail = look->numberOr("detail", scene.look.detail, {0, Look::kMostDetail});
        if (detail > 0 && detail < kLeastDetail) {
            look->fail(
                "detail",
                fmt::format("detail must be 0 or at least {} pixels, which is what the graphics card can hold, got {}",
                            kLeastDetail, detail));
        }
        look->finish();
    }
}

}  // namespace

Scene loadScene(const std::filesystem::path& file, const SizeChecks& checks) {
    const host::TomlTable toml = host::TomlTable::load(file);
    Scene scene;
    scene.name = toml.textOr("name", file.stem().string());
    const auto control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
    if (std::any_of(scene.name.begin(), scene.name.end(), control)) {
        toml.fail("name", "name must be one line of plain text");
    }
    scene.rules.stepsPerSecond = toml.integerOr("steps_per_second", 60, 1, 1000);
    scene.rules.rim = toml.valueOr("rim", scene.rules.rim);
    const double terrain = toml.has("tin") ? kTerrain : 1;
    const bool settle = readTerrain(
        toml, scene, {checks.raster, checks.field, checks.fieldAtMost, partOf(checks.progress, 0, terrain)});
    readTin(toml, scene, partOf(checks.progress, terrain, 1));
    readTool(toml, scene);
    readMaterial(toml, scene);
    requireSpacing(toml, scene);
    readForce(toml, scene);
    readLook(toml, scene);
    toml.finish();
    if (settle) {
        sand::Replica replica(scene);
        replica.apply({.epoch = 1, .number = 1, .engaged = false, .path = {}, .edit = sand::Edit::settle});
        sand::startFrom(replica.surface(), scene);
    }
    return scene;
}

}  // namespace scene
