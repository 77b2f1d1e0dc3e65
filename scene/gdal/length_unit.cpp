// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/length_unit.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "base/text.hpp"

namespace scene {
namespace {

struct LengthUnit {
    std::string_view name;
    double metres;
};
constexpr double kUsFoot = 1200.0 / 3937;
constexpr std::array kLengthUnits = {
    LengthUnit{"m", 1},
    LengthUnit{"m.", 1},
    LengthUnit{"metre", 1},
    LengthUnit{"meter", 1},
    LengthUnit{"metres", 1},
    LengthUnit{"meters", 1},
    LengthUnit{"ft", 0.3048},
    LengthUnit{"foot", 0.3048},
    LengthUnit{"feet", 0.3048},
    LengthUnit{"international foot", 0.3048},
    LengthUnit{"foot_intl", 0.3048},
    LengthUnit{"us-ft", kUsFoot},
    LengthUnit{"ftus", kUsFoot},
    LengthUnit{"us survey foot", kUsFoot},
    LengthUnit{"us survey feet", kUsFoot},
    LengthUnit{"us_survey_foot", kUsFoot},
    LengthUnit{"foot_us", kUsFoot},
    LengthUnit{"cm", 0.01},
    LengthUnit{"centimetre", 0.01},
    LengthUnit{"centimeter", 0.01},
    LengthUnit{"centimetres", 0.01},
    LengthUnit{"centimeters", 0.01},
    LengthUnit{"mm", 0.001},
    LengthUnit{"millimetre", 0.001},
    LengthUnit{"millimeter", 0.001},
    LengthUnit{"millimetres", 0.001},
    LengthUnit{"millimeters", 0.001},
    LengthUnit{"km", 1000},
    LengthUnit{"kilometre", 1000},
    LengthUnit{"kilometer", 1000},
    LengthUnit{"kilometres", 1000},
    LengthUnit{"kilometers", 1000},
};

}  // namespace

std::optional<double> metresOf(std::string_view unit) {
    const std::string lower = base::lowerCase(base::trimmed(unit));
    const auto* found = std::find_if(kLengthUnits.begin(), kLengthUnits.end(),
                                     [&](const LengthUnit& candidate) { return candidate.name == lower; });
    return found == kLengthUnits.end() ? std::nullopt : std::optional(found->metres);
}

bool meansNoUnit(std::string_view unit) {
    constexpr std::array<std::string_view, 9> kNone{"",    "unspecified", "unknown", "none", "undefined",
                                                    "n/a", "na",          "-",       "unit"};
    return std::find(kNone.begin(), kNone.end(), base::lowerCase(base::trimmed(unit))) != kNone.end();
}

bool isAngle(std::string_view unit) {
    const std::string lower = base::lowerCase(base::trimmed(unit));
    return lower.starts_with("degree") || lower.starts_with("radian") || lower.starts_with("arc") ||
           lower.starts_with("grad") || lower == "deg" || lower == "rad";
}

}  // namespace scene
