// SPDX-License-Identifier: Apache-2.0
#include "sand/step.hpp"

#include <cstdlib>
#include <string>

namespace sand {

void encode(const Step& step, files::ByteWriter& writer) {
    writer.putVarint(step.epoch);
    writer.putVarint(step.number);
    writer.put(static_cast<std::uint8_t>((step.engaged ? 1 : 0) + 2 * static_cast<int>(step.edit)));
    writer.put(static_cast<std::uint8_t>(step.path.size()));
    ProbePoint last;
    for (const ProbePoint& point : step.path) {
        writer.putSigned(std::int64_t{point.x} - last.x);
        writer.putSigned(std::int64_t{point.y} - last.y);
        writer.putSigned(std::int64_t{point.z} - last.z);
        last = point;
    }
}

namespace {

std::int32_t addChecked(std::int32_t base, std::int64_t difference) {
    if (difference < -2LL * kMaxProbe || difference > 2LL * kMaxProbe || std::llabs(base + difference) > kMaxProbe) {
        throw files::FormatError("a step's point lies out of reach");
    }
    return static_cast<std::int32_t>(base + difference);
}

}  // namespace

Step decodeStep(files::ByteReader& reader) {
    Step step;
    const std::uint64_t epoch = reader.getVarint();
    if (epoch > UINT32_MAX) {
        throw files::FormatError("a step's epoch is out of range");
    }
    step.epoch = static_cast<std::uint32_t>(epoch);
    step.number = reader.getVarint();
    const auto flags = reader.get<std::uint8_t>();
    const auto count = reader.get<std::uint8_t>();
    if (flags >= 2 * kEdits || count > kMaxPathPoints) {
        throw files::FormatError("a step with " + std::to_string(count) + " points, flags " + std::to_string(flags));
    }
    step.engaged = flags % 2 == 1;
    step.edit = static_cast<Edit>(flags / 2);
    step.path.reserve(count);
    ProbePoint last;
    for (int i = 0; i < count; ++i) {
        last.x = addChecked(last.x, reader.getSigned());
        last.y = addChecked(last.y, reader.getSigned());
        last.z = addChecked(last.z, reader.getSigned());
        step.path.push_back(last);
    }
    return step;
}

}  // namespace sand
