// SPDX-License-Identifier: Apache-2.0
#include "sand/model/tool.hpp"

namespace sand {
namespace {

constexpr int kMirroredBit = 0x80;  // bit of the byte whose lower bits are the kind

}  // namespace

void Tool::encode(base::ByteWriter& writer) const {
    writer.put(plain() ? radius : -1 - radius);
    if (!plain()) {
        writer.put(static_cast<std::uint8_t>(static_cast<int>(kind) + (heading.mirrored ? kMirroredBit : 0)));
        writer.put(halfWidth);
        heading.encode(writer);
    }
}

Tool Tool::decode(base::ByteReader& reader) {
    Tool tool;
    tool.radius = reader.get<std::int32_t>();
    if (tool.radius < 0) {
        tool.radius = -1 - tool.radius;
        const auto coded = reader.get<std::uint8_t>();
        tool.kind = static_cast<ToolKind>(coded & ~kMirroredBit);
        tool.halfWidth = reader.get<std::int32_t>();
        tool.heading = Heading::decode(reader, (coded & kMirroredBit) != 0);
        if (base::nameOf(tool.kind).empty()) {
            throw base::FormatError("a tool of an unknown shape");
        }
    }
    const std::int32_t widest = isRound(tool.kind) ? 0 : tool.radius;
    if (tool.radius > kLargestToolRadius || tool.halfWidth < 0 || tool.halfWidth > widest) {
        throw base::FormatError("a tool out of range");
    }
    return tool;
}

}  // namespace sand
