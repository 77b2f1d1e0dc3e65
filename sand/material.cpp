// SPDX-License-Identifier: Apache-2.0
#include "sand/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "files/input_error.hpp"
#include "sand/scene.hpp"

namespace sand {
namespace {

constexpr double kLargestTool = double{kLargestToolRadius} / kProbePerCell;  // [cell]

constexpr std::array<MaterialKey, 6> kKeys{{
    {"talus_deg", "talus", 0, 90, true, [](Material& m, double value) { m.dryTalus = value; }},
    {"wet_talus_deg", "wet-talus", 0, 90, true, [](Material& m, double value) { m.wetTalus = value; }},
    {"humidity", "humidity", 0, 1, false, [](Material& m, double value) { m.humidity = value; }},
    {"cohesion_length", "cohesion", 0, 1e9, false, [](Material& m, double value) { m.cohesionLength = value; }},
    {"band", "band", 0, 1, false, [](Material& m, double value) { m.band = value; }},
    {"settling_time", "settling-time", 0.001, 1e6, false, [](Material& m, double value) { m.settlingSeconds = value; }},
}};

double thresholdOf(const Material& material) {
    return std::min(std::floor(std::tan(material.talus() * std::numbers::pi / 180) * kUnitsPerCell + 0.5),
                    double{kLargestThreshold});
}

/// How many sweeps a step needs for sand beside the tool to rest after the settling time. A disturbance of R cells
/// needs about R² sweeps to come within a percent, and 2.4 R² without inertia (R = 12: 144 and 350). With fewer than
/// four a step, no inertia would arise.
std::int32_t sweepsFor(Scheme scheme, double radius /* [cell] */, double settlingSeconds, int stepsPerSecond) {
    const double perSquare = scheme == Scheme::isotropic ? 1.0 : 2.4;
    const double sweeps = perSquare * radius * radius / (settlingSeconds * stepsPerSecond);
    return static_cast<std::int32_t>(std::clamp(std::ceil(sweeps), 4.0, double{kMostSweeps}));
}

Material checked(const Material& material, const MaterialGrid& grid) {
    if (const auto fault = faultOf(material, grid)) {
        throw files::InputError(fault->message);
    }
    return material;
}

}  // namespace

double Material::talus() const { return dryTalus + humidity * (wetTalusNow() - dryTalus); }

std::span<const MaterialKey> materialKeys() { return kKeys; }

std::optional<MaterialFault> faultOf(const Material& material, const MaterialGrid& grid) {
    const double cells = material.toolRadius / grid.cellSize;
    if (!(cells <= kLargestTool)) {
        return MaterialFault{"radius", fmt::format("a tool of radius {} is {:.4g} cells of {}; {} is the most",
                                                   material.toolRadius, cells, grid.cellSize, kLargestTool)};
    }
    if (material.wetTalusNow() < material.dryTalus) {
        return MaterialFault{"wet_talus_deg", fmt::format("wet_talus_deg must be at least talus_deg = {}, got {}",
                                                          material.dryTalus, material.wetTalusNow())};
    }
    if (const double threshold = thresholdOf(material); grid.scheme == Scheme::n4 && threshold < 4) {
        return MaterialFault{"talus_deg", fmt::format("talus_deg is too flat for scheme n4: its threshold is {} units, "
                                                      "and 4 is the least; use scheme \"g\"",
                                                      threshold)};
    }
    return std::nullopt;
}

Tuning tuningOf(const Material& material, const MaterialGrid& grid) {
    const double threshold = thresholdOf(material);
    const double cohesion = material.humidity * material.cohesionLength / (grid.cellSize / kUnitsPerCell);
    const double start = std::max(std::floor(threshold * (1 + material.band)), std::floor(cohesion));
    Tuning tuning;
    tuning.threshold = static_cast<std::int32_t>(threshold);
    tuning.startThreshold = static_cast<std::int32_t>(std::min(start, double{kLargestThreshold}));
    tuning.toolRadius =
        static_cast<std::int32_t>(std::floor(material.toolRadius / grid.cellSize * kProbePerCell + 0.5));
    tuning.sweepsPerStep = sweepsFor(grid.scheme, static_cast<double>(tuning.toolRadius) / kProbePerCell,
                                     material.settlingSeconds, grid.stepsPerSecond);
    return tuning;
}

Material withNumber(Material material, std::string_view word, double value, const MaterialGrid& grid) {
    std::string known;
    for (const MaterialKey& key : kKeys) {
        if (word == key.word || word == key.key) {
            // Written so that what is no number is out of range.
            if (!(value >= key.lowest && value <= key.highest) || (key.highestIsOut && value == key.highest)) {
                throw files::InputError(fmt::format("{} must be within [{}, {}{}, got {}", key.word, key.lowest,
                                                    key.highest, key.highestIsOut ? ')' : ']', value));
            }
            key.set(material, value);
            return checked(material, grid);
        }
        known += fmt::format("{}{}", known.empty() ? "" : ", ", key.word);
    }
    throw files::InputError(fmt::format("a material has no '{}'; there are {}", word, known));
}

Material withTool(Material material, double radius, const MaterialGrid& grid) {
    // A scene without a tool to speak of may be; a tool that vanishes under somebody's hand may not.
    const double least = grid.cellSize / kProbePerCell;
    if (!(radius >= least)) {
        throw files::InputError(fmt::format("a tool's radius must be at least {:.3g}, got {}", least, radius));
    }
    material.toolRadius = radius;
    return checked(material, grid);
}

}  // namespace sand
