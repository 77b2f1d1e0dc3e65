// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "sand/ground.hpp"
#include "sand/height_field.hpp"
#include "sand/surface.hpp"
#include "sand/tin/start.hpp"

namespace sand {

/// What TINs need of the module they live in. Only scenes that name a TIN load it, and the library it needs.
class TinModule {
public:
    virtual ~TinModule() = default;

    /// The sand of scene.tin, as a replica starts with it.
    [[nodiscard]] virtual std::unique_ptr<Surface> surface(const Scene& scene) const = 0;
    /// The TIN with the fewest points that greedy insertion needs to come as near to every cell's middle, and to those
    /// of the rim, as settings.maxError, or that settings.mostVertices allows beside those at settings.widest. Walls,
    /// which may be null, are holes: throws std::length_error when what their outline needs is more.
    [[nodiscard]] virtual tin::Start follow(const HeightField& field, const Ground* walls,
                                            const tin::Settings& settings) const = 0;
    /// The TIN of given places and heights; the corners of the field are added where they are missing, as high as the
    /// nearest place. start.places need not begin with them, and constraints are by place.
    [[nodiscard]] virtual tin::Start join(const tin::Start& start) const = 0;
    /// The TIN of a surface as it is now, for a scene that starts at rest.
    [[nodiscard]] virtual tin::Start startOf(const Surface& surface) const = 0;
};

/// Loads sandwall-tin.so from beside the program, once. Throws base::InputError when it is not there or not whole.
[[nodiscard]] const TinModule& tinModule();

/// The module's only symbol.
inline constexpr const char* kTinSymbol = "sandwallTin1";
using GetTinModule = const TinModule*();

}  // namespace sand
