// SPDX-License-Identifier: Apache-2.0
#include "sand/model/tuning.hpp"

namespace sand {
namespace {

bool within(std::int32_t number, std::int32_t most) { return number >= 0 && number <= most; }

}  // namespace

void ToolRules::encode(base::ByteWriter& writer) const {
    writer.put(plain() ? shape.radius : -1 - shape.radius);
    if (!plain()) {
        // The kind takes three bits of its byte. The highest bit says whether the tool is mirrored.
        writer.put(static_cast<std::uint8_t>(static_cast<int>(shape.kind) + (heading.mirrored ? 0x80 : 0)));
        writer.put(shape.halfWidth);
        heading.encode(writer);
    }
}

ToolRules ToolRules::decode(base::ByteReader& reader) {
    ToolRules tool;
    tool.shape.radius = reader.get<std::int32_t>();
    if (tool.shape.radius < 0) {
        tool.shape.radius = -1 - tool.shape.radius;
        const auto kind = reader.get<std::uint8_t>();
        tool.shape.halfWidth = reader.get<std::int32_t>();
        tool.heading = Heading::decode(reader, (kind & 0x80) != 0);
        if ((kind & 0x7f) >= kToolKinds) {
            throw base::FormatError("a tool of an unknown shape");
        }
        tool.shape.kind = static_cast<ToolKind>(kind & 0x7f);
    }
    if (!within(tool.shape.radius, kLargestToolRadius) ||
        !within(tool.shape.halfWidth, isRound(tool.shape.kind) ? 0 : tool.shape.radius)) {
        throw base::FormatError("a tool out of range");
    }
    return tool;
}

void Tuning::encode(base::ByteWriter& writer) const {
    writer.put(threshold);
    writer.put(startThreshold);
    writer.put(sweepsPerStep);
    tool().encode(writer);
}

Tuning Tuning::decode(base::ByteReader& reader) {
    Tuning tuning;
    for (std::int32_t* number : {&tuning.threshold, &tuning.startThreshold, &tuning.sweepsPerStep}) {
        *number = reader.get<std::int32_t>();
    }
    const ToolRules tool = ToolRules::decode(reader);
    tuning.toolRadius = tool.shape.radius;
    tuning.toolKind = tool.shape.kind;
    tuning.toolHalfWidth = tool.shape.halfWidth;
    tuning.toolHeading = tool.heading;
    if (!within(tuning.startThreshold, kLargestThreshold) || !within(tuning.threshold, tuning.startThreshold) ||
        !within(tuning.sweepsPerStep, kMostSweeps)) {
        throw base::FormatError("a material out of range");
    }
    return tuning;
}

}  // namespace sand
