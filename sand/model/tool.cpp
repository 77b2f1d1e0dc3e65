// SPDX-License-Identifier: Apache-2.0
#include "sand/model/tool.hpp"

namespace sand {
namespace {

constexpr int kMirroredBit = 0x80;  // bit of the byte whose lower bits are the kind

}  // namespace

void Tool::put(base::ByteWriter& writer) const {
    writer.put(plain() ? radius : -1 - radius);
    if (!plain()) {
        writer.put(static_cast<std::uint8_t>(static_cast<int>(kind) + (heading.mirrored ? kMirroredBit : 0)));
        writer.put(halfWidth);
        heading.encode(writer);
    }
}

void Tool::get(base::ByteReader& reader) {
    *this = {};
    radius = reader.get<std::int32_t>();
    if (radius < 0) {
        radius = -1 - radius;
        const auto coded = reader.get<std::uint8_t>();
        kind = static_cast<ToolKind>(coded & ~kMirroredBit);
        halfWidth = reader.get<std::int32_t>();
        heading = Heading::decode(reader, (coded & kMirroredBit) != 0);
        if (base::nameOf(kind).empty()) {
            throw base::FormatError("has an unknown kind");
        }
    }
    const std::int32_t widest = isRound(kind) ? 0 : radius;
    if (radius > kLargestToolRadius || halfWidth < 0 || halfWidth > widest) {
        throw base::FormatError("is larger or wider than a tool can be");
    }
}

}  // namespace sand
