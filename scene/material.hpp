// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sand/model/tuning.hpp"

namespace sand {
enum class Scheme : std::uint8_t;
}

namespace scene {

/// Material and tool in the units of a scene file. Stays with whoever has read the file: replicas get what follows.
struct Material {
    double dryTalus = 34;            // [deg]
    std::optional<double> wetTalus;  // [deg]; none: 45, or the dry one where that is steeper
    double humidity = 0;             // w, from 0 (dry) to 1
    double cohesionLength = 0;       // [scene unit], how high a bank stands at w = 1
    double band = 0.001;             // share of the threshold beyond which sand at rest starts to slide
    double settlingSeconds = 0.1;    // until sand beside the tool rests
    double toolRadius = 0.01;        // [scene unit], half of its length; default: the sphere of Dorjgotov et al. 2007
    sand::ToolKind toolKind = sand::ToolKind::sphere;
    std::optional<double> toolWidth;  // over its length; none: the kind's usual one
    double toolHeading = 0;           // [deg] from east, counter-clockwise; where a footprint's toes point
    bool leftFoot = false;            // a footprint is of a right foot, unless

    /// The talus is dryTalus + w (wetTalus - dryTalus), and a bank whose step from a cell to the next is at most
    /// w · cohesionLength stands. Both grow with w, and w = 0 is dry sand.
    [[nodiscard]] double talus() const;                                                                      // [deg]
    [[nodiscard]] double wetTalusNow() const { return wetTalus.value_or(dryTalus > 45 ? dryTalus : 45.0); }  // [deg]
    friend bool operator==(const Material&, const Material&) = default;
};

/// A number of Material that has a key in [material].
struct MaterialKey {
    std::string_view key;   // in a scene file
    std::string_view word;  // in an operator's command
    double lowest, highest;
    bool highestIsOut;  // the range is half open
    void (*set)(Material&, double);
};
[[nodiscard]] std::span<const MaterialKey> materialKeys();

/// What the numbers are used with.
struct MaterialGrid {
    sand::Scheme scheme;
    int stepsPerSecond;
    double cellSize;  // [scene unit]
    int longerSide;   // of the field [cell]
};
struct MaterialFault {
    std::string key;  // of [material], or "radius", "width" or "foot" of [tool]
    std::string message;
};
/// Why these numbers, each within its own range, cannot stand together.
[[nodiscard]] std::optional<MaterialFault> faultOf(const Material& material, const MaterialGrid& grid);
/// The integers that sand is computed from, of a material without fault. Nobody else may compute them again: libm's
/// last digit differs from host to host.
[[nodiscard]] sand::Tuning tuningOf(const Material& material, const MaterialGrid& grid);

/// An operator's command: the material with one number changed. Throws base::InputError with the keys there are or
/// the range, in one line.
[[nodiscard]] Material withNumber(Material material, std::string_view word, double value, const MaterialGrid& grid);
inline constexpr double kNarrowestTool = 0.05;  // width over length

/// What an operator changes of the tool; what is left out stays as it is, but for the width of another kind, which is
/// then its usual one.
struct ToolChange {
    std::optional<sand::ToolKind> kind{};
    std::optional<double> radius{};   // [scene unit]
    std::optional<double> width{};    // over the length
    std::optional<double> heading{};  // [deg]
    std::optional<bool> leftFoot{};
};
/// The same for the tool.
[[nodiscard]] Material withTool(Material material, const ToolChange& change, const MaterialGrid& grid);

}  // namespace scene
