// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "base/byte_stream.hpp"

namespace sand {

/// Which way a tool is turned about the vertical: a direction in the plane, in whole numbers, so that no replica ever
/// computes with an angle. x runs east, y north.
struct Heading {
    static constexpr int kLength = 1 << 14;  // of the vector, but for the rounding of its ends

    std::int16_t x = kLength, y = 0;  // east, unless somebody turns it
    bool mirrored = false;            // left and right exchanged: the left foot of a pair

    /// Whether it is the rounded end of such a vector.
    [[nodiscard]] bool valid() const {
        const std::int64_t square = std::int64_t{x} * x + std::int64_t{y} * y;
        return square >= std::int64_t{kLength - 1} * (kLength - 1) &&
               square <= std::int64_t{kLength + 1} * (kLength + 1);
    }
    /// In whole numbers, for hashes.
    [[nodiscard]] std::uint64_t bits() const {
        return std::uint64_t{static_cast<std::uint16_t>(x)} | std::uint64_t{static_cast<std::uint16_t>(y)} << 16 |
               std::uint64_t{mirrored ? 1U : 0U} << 32;
    }
    void encode(base::ByteWriter& writer) const {
        writer.put(x);
        writer.put(y);
    }
    /// Without `mirrored`, for which others have a bit left. Throws base::FormatError for what is no direction.
    static Heading decode(base::ByteReader& reader, bool mirrored) {
        Heading heading;
        heading.x = reader.get<std::int16_t>();
        heading.y = reader.get<std::int16_t>();
        heading.mirrored = mirrored;
        if (!heading.valid()) {
            throw base::FormatError("a tool's heading that is no direction");
        }
        return heading;
    }
    friend bool operator==(const Heading&, const Heading&) = default;
};

/// Asked once, by whoever reads a scene, an operator's command or a device: libm's last digit differs from host to
/// host. Degrees count from east, counter-clockwise as seen from above. Nothing for a number that is none.
[[nodiscard]] std::optional<Heading> headingOf(double degrees, bool mirrored = false);
/// For people to read, within (-180, 180].
[[nodiscard]] double degreesOf(const Heading& heading);

}  // namespace sand
