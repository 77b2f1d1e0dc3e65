// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/input_error.hpp"
#include "files/toml_table.hpp"
#include "sand/scene.hpp"
#include "sand/scene_terrain.hpp"
#include "sand/terrain.hpp"

namespace sand {
namespace {

constexpr double kPaperRadius = 0.01;  // [scene unit], the first paper's sphere
constexpr double kLargestTool = 2048;  // [cell]
// Differences never exceed 2^29: a larger threshold means the same as this one, nothing slides.
constexpr double kLargestThreshold = 1 << 30;  // [unit]
constexpr int kTooCoarse = 4096;               // [unit]: below, rest slopes come out more than a percent too steep

/// How many sweeps a step needs for sand beside the tool to rest after the settling time. A disturbance of R cells
/// needs about R² sweeps to come within a percent, and 2.4 R² without inertia (R = 12: 144 and 350). With fewer than
/// four a step, no inertia would arise.
std::int32_t sweepsFor(Scheme scheme, double radius /* [cell] */, double settlingSeconds, int stepsPerSecond) {
    const double perSquare = scheme == Scheme::isotropic ? 1.0 : 2.4;
    const double sweeps = perSquare * radius * radius / (settlingSeconds * stepsPerSecond);
    return static_cast<std::int32_t>(std::clamp(std::ceil(sweeps), 4.0, 4096.0));
}

double slopeAngle(const files::TomlTable& material, const std::string& key, double fallback) {
    const double angle = material.numberOr(key, fallback, {0, 90});
    if (angle >= 90) {
        material.fail(key, fmt::format("{} must be within [0, 90), got 90", key));
    }
    return angle;
}

/// Humidity w, from 0 (dry) to 1: the talus is talus_deg + w (wet_talus_deg - talus_deg), and a bank whose step from a
/// cell to the next is at most w · cohesion_length stands. Both grow with w, and w = 0 is dry sand.
void readMaterial(const files::TomlTable& file, Scene& scene) {
    const files::TomlTable material = file.requiredTable("material");
    Rules& rules = scene.rules;
    const double humidity = material.numberOr("humidity", 0, {0, 1});
    const double dryTalus = slopeAngle(material, "talus_deg", 34);
    const double wetTalus = slopeAngle(material, "wet_talus_deg", std::max(dryTalus, 45.0));
    if (wetTalus < dryTalus) {
        material.fail("wet_talus_deg",
                      fmt::format("wet_talus_deg must be at least talus_deg = {}, got {}", dryTalus, wetTalus));
    }
    const double talus = dryTalus + humidity * (wetTalus - dryTalus);
    const double cohesion = humidity * material.numberOr("cohesion_length", 0, {0, 1e9}) / scene.terrain.unit();
    const double threshold =
        std::min(std::floor(std::tan(talus * std::numbers::pi / 180) * kUnitsPerCell + 0.5), kLargestThreshold);
    const double band = material.numberOr("band", 0.001, {0, 1});
    const double start = std::max(std::floor(threshold * (1 + band)), std::floor(cohesion));
    rules.threshold = static_cast<std::int32_t>(threshold);
    rules.startThreshold = static_cast<std::int32_t>(std::min(start, kLargestThreshold));
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

// [pixel]: GL promises vertices no finer than a sixteenth of a pixel.
constexpr double kLeastDetail = 1.0 / 16;

void readLook(const files::TomlTable& file, Scene& scene) {
    if (const auto look = file.table("look")) {
        scene.look.sandColour = look->numbersOr("sand", scene.look.sandColour);
        scene.look.backgroundColour = look->numbersOr("background", scene.look.backgroundColour);
        scene.look.sunDirection = look->numbersOr("sun", scene.look.sunDirection);
        scene.look.hillShade = look->flagOr("hill_shade", scene.look.hillShade);
        const auto& sun = scene.look.sunDirection;
        if (sun[0] == 0 && sun[1] == 0 && sun[2] == 0) {
            look->fail("sun", "sun must point somewhere, got [0, 0, 0]");
        }
        const double& detail = scene.look.detail = look->numberOr("detail", scene.look.detail, {0, 64});
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
    const bool settle = readTerrain(toml, scene);
    readTool(toml, scene);
    readMaterial(toml, scene);
    readForce(toml, scene);
    readLook(toml, scene);
    toml.finish();
    if (settle) {
        Terrain terrain(scene);
        terrain.apply({.epoch = 1, .number = 1, .engaged = false, .path = {}, .edit = Edit::settle});
        scene.terrain = terrain.field();
    }
    return scene;
}

}  // namespace sand
