// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/text.hpp"

namespace lockstep {

/// Something that a wall can show with the sand. Documents and commands call it a layer (docs/look.md).
/// ViewState::layers has a bit for each overlay.
enum class Overlay : std::uint8_t {
    wireframe,   // the triangles' edges
    hillShade,   // light and dark by slope, as on maps
    force,       // the tool's force, as an arrow
    statistics,  // frame times and agreement of the wall, on every tile
    help         // a list of buttons and keys, on the tiles of the lowest row
};

inline constexpr std::array<std::string_view, 5> kOverlayNames{"wireframe", "hill-shade", "force", "statistics",
                                                               "help"};

/// Bit mask of the overlays that are shown. All are off at first.
class Overlays {
public:
    constexpr Overlays() = default;
    constexpr explicit Overlays(std::uint8_t bits) : bits_(bits) {}
    [[nodiscard]] constexpr bool shows(Overlay layer) const { return (bits_ & bit(layer)) != 0; }
    constexpr void set(Overlay layer, bool shown) {
        bits_ = static_cast<std::uint8_t>(shown ? bits_ | bit(layer) : bits_ & ~bit(layer));
    }
    [[nodiscard]] constexpr std::uint8_t bits() const { return bits_; }
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("bits", it.bits_);
    }
    friend constexpr bool operator==(Overlays, Overlays) = default;

private:
    static constexpr unsigned bit(Overlay layer) { return 1U << static_cast<unsigned>(layer); }
    std::uint8_t bits_ = 0;
};

/// Returns the overlay with the name `name`. Throws base::InputError, which lists all names, if there is no such
/// overlay.
[[nodiscard]] inline Overlay parseOverlay(std::string_view name) {
    return static_cast<Overlay>(base::indexOf(name, kOverlayNames, "layer"));
}

}  // namespace lockstep
