// SPDX-License-Identifier: Apache-2.0
#include "scene/model/material.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/input_error.hpp"
#include "scene/model/scene.hpp"

namespace scene {
namespace {

constexpr double kLargestTool = double{sand::kLargestToolRadius} / sand::kProbePerCell;  // [cell]

/// Returns the key of a number. `kGet` is its member, or a function that returns it.
template <auto kMember, auto kGet = kMember>
constexpr MaterialKey keyOf(std::string_view key, std::string_view word, double lowest, double highest,
                            bool highestIsOut = false) {
    const auto set = [](Material& m, double value) { m.*kMember = value; };
    const auto get = [](const Material& m) -> double { return std::invoke(kGet, m); };
    return {key, word, lowest, highest, highestIsOut, set, get};
}

constexpr auto kMaterialKeys = std::to_array<MaterialKey>({
    keyOf<&Material::dryTalus>("talus_deg", "talus", 0, 90, true),
    keyOf<&Material::wetTalus, &Material::wetTalusNow>("wet_talus_deg", "wet-talus", 0, 90, true),
    keyOf<&Material::humidity>("humidity", "humidity", 0, 1),
    keyOf<&Material::cohesionLength>("cohesion_length", "cohesion", 0, 1e9),
    keyOf<&Material::band>("band", "band", 0, 1),
    keyOf<&Material::settlingSeconds>("settling_time", "settling-time", 0.001, 1e6),
});

double thresholdOf(const Material& material) {
    return std::min(std::floor(std::tan(material.talus() * std::numbers::pi / 180) * sand::kUnitsPerCell + 0.5),
                    double{sand::kLargestThreshold});
}

/// Returns how many sweeps a step needs so that sand beside the tool is at rest after the settling time. A disturbance
/// of R cells needs about R² sweeps to come within a percent, and 2.4 R² without inertia (R = 12: 144 and 350). With
/// fewer than four sweeps per step, no inertia would arise.
std::int32_t sweepsFor(sand::Scheme scheme, double radius /* [cell] */, double settlingSeconds, int stepsPerSecond) {
    const double perSquare = scheme == sand::Scheme::isotropic ? 1.0 : 2.4;
    const double sweeps = perSquare * radius * radius / (settlingSeconds * stepsPerSecond);
    return static_cast<std::int32_t>(std::clamp(std::ceil(sweeps), 4.0, double{sand::kMostSweepsToRest}));
}

/// Returns why the tool's shape is invalid, or nullopt if it is valid.
std::optional<MaterialFault> toolFaultOf(const Material& material, const MaterialGrid& grid) {
    const std::string_view name = base::nameOf(material.toolKind);
    if (material.toolWidth && sand::isRound(material.toolKind)) {
        return MaterialFault{"width", fmt::format("a {} is as wide as it is long; leave width out", name)};
    }
    // The comparison is written so that NaN is out of range.
    if (const double width = material.toolWidth.value_or(1); !(width >= kNarrowestTool && width <= 1)) {
        return MaterialFault{"width", fmt::format("a tool's width over its length must be within [{}, 1], got {}",
                                                  kNarrowestTool, width)};
    }
    if (material.leftFoot && material.toolKind != sand::ToolKind::footprint) {
        return MaterialFault{"foot", fmt::format("only a footprint is left or right, not this {}", name)};
    }
    const double length = 2 * material.toolRadius;
    if (const double side = grid.longerSide * grid.cellSize;
        material.toolKind != sand::ToolKind::sphere && length > side) {
        return MaterialFault{"radius", fmt::format("a {} of radius {} is {} long, but the field only {}", name,
                                                   material.toolRadius, length, side)};
    }
    return std::nullopt;
}

Material checked(const Material& material, const MaterialGrid& grid) {
    if (const auto fault = faultOf(material, grid)) {
        throw base::InputError(fault->message);
    }
    return material;
}

}  // namespace

double Material::talus() const { return dryTalus + humidity * (wetTalusNow() - dryTalus); }

std::span<const MaterialKey> materialKeys() { return kMaterialKeys; }

double usualToolRadius(int columns, int rows, double cellSize) {
    constexpr double kShare = 1.0 / 40, kFewest = 2, kMost = 128;  // of the shorter side; [cell]
    return std::clamp(kShare * std::min(columns, rows), kFewest, kMost) * cellSize;
}

std::optional<MaterialFault> faultOf(const Material& material, const MaterialGrid& grid) {
    const double cells = material.toolRadius / grid.cellSize;
    if (!(cells <= kLargestTool)) {
        return MaterialFault{"radius", fmt::format("a tool of radius {} is {:.4g} cells of {}; {} is the most",
                                                   material.toolRadius, cells, grid.cellSize, kLargestTool)};
    }
    if (auto fault = toolFaultOf(material, grid)) {
        return fault;
    }
    if (material.wetTalusNow() < material.dryTalus) {
        return MaterialFault{"wet_talus_deg", fmt::format("wet_talus_deg must be at least talus_deg = {}, got {}",
                                                          material.dryTalus, material.wetTalusNow())};
    }
    return std::nullopt;
}

sand::Tuning tuningOf(const Material& material, const MaterialGrid& grid) {
    const double threshold = thresholdOf(material);
    const double cohesion = material.humidity * material.cohesionLength / (grid.cellSize / sand::kUnitsPerCell);
    const double start = std::max(std::floor(threshold * (1 + material.band)), std::floor(cohesion));
    sand::Tuning tuning;
    tuning.threshold = static_cast<std::int32_t>(threshold);
    tuning.startThreshold = static_cast<std::int32_t>(std::min(start, double{sand::kLargestThreshold}));
    tuning.tool.radius =
        static_cast<std::int32_t>(std::floor(material.toolRadius / grid.cellSize * sand::kProbePerCell + 0.5));
    tuning.tool.kind = material.toolKind;
    if (!sand::isRound(material.toolKind)) {
        const double width = material.toolWidth.value_or(sand::usualWidth(material.toolKind));
        tuning.tool.halfWidth = static_cast<std::int32_t>(std::floor(width * tuning.tool.radius + 0.5));
    }
    tuning.tool.heading = sand::headingOf(material.toolHeading, material.leftFoot).value_or(sand::Heading{});
    tuning.sweepsPerStep = sweepsFor(grid.scheme, static_cast<double>(tuning.tool.radius) / sand::kProbePerCell,
                                     material.settlingSeconds, grid.stepsPerSecond);
    return tuning;
}

Material withNumber(Material material, std::string_view word, double value, const MaterialGrid& grid) {
    std::string known;
    for (const MaterialKey& key : kMaterialKeys) {
        if (word == key.word || word == key.key) {
            // The comparison is written so that NaN is out of range.
            if (!(value >= key.lowest && value <= key.highest) || (key.highestIsOut && value == key.highest)) {
                throw base::InputError(fmt::format("{} must be within [{}, {}{}, got {}", key.word, key.lowest,
                                                   key.highest, key.highestIsOut ? ')' : ']', value));
            }
            key.set(material, value);
            return checked(material, grid);
        }
        known += fmt::format("{}{}", known.empty() ? "" : ", ", key.word);
    }
    throw base::InputError(fmt::format("a material has no '{}'; there are {}", word, known));
}

Material withTool(Material material, const ToolChange& change, const MaterialGrid& grid) {
    // A scene may begin with a very small tool. A tool must not vanish while a hand uses it.
    const double least = sand::probeUnit(grid.cellSize);
    if (change.radius && !(*change.radius >= least)) {
        throw base::InputError(fmt::format("a tool's radius must be at least {:.3g}, got {}", least, *change.radius));
    }
    if (change.heading && !sand::headingOf(*change.heading)) {
        throw base::InputError("a tool's heading must be a number of degrees");
    }
    if (change.kind && *change.kind != material.toolKind) {
        material.toolKind = *change.kind;
        material.toolWidth.reset();
        material.leftFoot = false;
    }
    material.toolRadius = change.radius.value_or(material.toolRadius);
    material.toolWidth = change.width ? change.width : material.toolWidth;
    material.toolHeading = change.heading.value_or(material.toolHeading);
    material.leftFoot = change.leftFoot.value_or(material.leftFoot);
    return checked(material, grid);
}

}  // namespace scene
