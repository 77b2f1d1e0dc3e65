// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/field_forms.hpp"
#include "sand/model/tuning.hpp"

namespace sand {
enum class Scheme : std::uint8_t;
}

namespace scene {

/// Material and tool in the units of a scene file. Only the process that has read the file holds it. Replicas get the
/// numbers that tuningOf() derives from it.
struct Material {
    double dryTalus = 34;            // [deg]
    std::optional<double> wetTalus;  // [deg]; nullopt: 45, or dryTalus if that is steeper
    double humidity = 0;             // w, from 0 (dry) to 1
    double cohesionLength = 0;       // [scene unit], height of the step that sand bears at w = 1
    double band = 0.001;             // share of the threshold beyond which sand at rest starts to slide
    double settlingSeconds = 0.1;    // until sand beside the tool rests
    double toolRadius = 0.01;        // [scene unit], half of its length; a scene without one has usualToolRadius()
    sand::ToolKind toolKind = sand::ToolKind::sphere;
    std::optional<double> toolWidth;  // ratio of width to length; nullopt: the kind's default
    double toolHeading = 0;           // [deg] from east, counter-clockwise; the toes of a footprint point there
    bool leftFoot = false;            // whether a footprint is that of a left foot

    /// Returns the talus dryTalus + w (wetTalus - dryTalus). A bank is stable if its step from one cell to the next is
    /// at most w · cohesionLength. Both grow with w; w = 0 is dry sand.
    [[nodiscard]] double talus() const;                                                                      // [deg]
    [[nodiscard]] double wetTalusNow() const { return wetTalus.value_or(dryTalus > 45 ? dryTalus : 45.0); }  // [deg]
    /// The order in a journal. The two optional numbers have their eight bytes in any case.
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("talus_deg", it.dryTalus);
        visit("humidity", it.humidity);
        visit("cohesion_length", it.cohesionLength);
        visit("band", it.band);
        visit("settling_time", it.settlingSeconds);
        visit("radius", it.toolRadius);
        visit("heading_deg", it.toolHeading);
        visit("wet_talus_deg", base::spacedOptional(it.wetTalus));
        visit("width", base::spacedOptional(it.toolWidth));
        visit("kind", it.toolKind);
        visit("left_foot", it.leftFoot);
    }
    friend bool operator==(const Material&, const Material&) = default;
};

/// A number of Material that has a key in [material].
struct MaterialKey {
    std::string_view key;   // in a scene file
    std::string_view word;  // in an operator's command
    double lowest, highest;
    bool highestIsOut;  // whether `highest` itself is out of range
    void (*set)(Material&, double);
    double (*get)(const Material&);
};
/// Returns all numbers. An operator's status and the controls of a page list them from here.
[[nodiscard]] std::span<const MaterialKey> materialKeys();
/// The numbers of a material by the words of an operator's command, in the units in which an operator types them.
struct MaterialNumbers {
    const Material& of;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        for (const MaterialKey& key : materialKeys()) {
            visit(key.word, key.get(it.of));
        }
    }
};

/// Numbers of a scene with which a material is used.
struct MaterialGrid {
    sand::Scheme scheme;
    int stepsPerSecond;
    double cellSize;  // [scene unit]
    int longerSide;   // longer side of the field [cell]
};
/// Reason why a material cannot be used.
struct MaterialFault {
    std::string key;  // key of [material], or "radius", "width" or "foot" of [tool]
    std::string message;
};
/// Returns why these numbers, each within its own range, do not fit together; nullopt if they do.
[[nodiscard]] std::optional<MaterialFault> faultOf(const Material& material, const MaterialGrid& grid);
/// Returns the whole numbers from which sand is computed. Requires that faultOf() is nullopt. Only the process that
/// reads the scene or the command calls this, because the last digit of libm's results differs between hosts.
[[nodiscard]] sand::Tuning tuningOf(const Material& material, const MaterialGrid& grid);

/// Returns the material with one number changed by an operator's command. Throws base::InputError in one line, with the
/// known keys or the range.
[[nodiscard]] Material withNumber(Material material, std::string_view word, double value, const MaterialGrid& grid);
inline constexpr double kNarrowestTool = 0.05;  // ratio of width to length
/// Returns the radius of a tool that is large enough to be seen and follows the hand: 1/40 of the shorter side of a
/// field of columns x rows cells, and from 2 to 128 cells [scene unit].
[[nodiscard]] double usualToolRadius(int columns, int rows, double cellSize);

/// An operator's change of the tool. A part that is nullopt does not change. If the kind changes, however, the width
/// becomes the default of the new kind.
struct ToolChange {
    std::optional<sand::ToolKind> kind{};
    std::optional<double> radius{};   // [scene unit]
    std::optional<double> width{};    // over the length
    std::optional<double> heading{};  // [deg]
    std::optional<bool> leftFoot{};
};
/// Returns the material with an operator's change of the tool. Throws base::InputError in one line.
[[nodiscard]] Material withTool(Material material, const ToolChange& change, const MaterialGrid& grid);

}  // namespace scene
