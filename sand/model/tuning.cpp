// SPDX-License-Identifier: Apache-2.0
#include "sand/model/tuning.hpp"

namespace sand {
namespace {

bool within(std::int32_t number, std::int32_t most) { return number >= 0 && number <= most; }

}  // namespace

void Tuning::encode(base::ByteWriter& writer) const {
    writer.put(threshold);
    writer.put(startThreshold);
    writer.put(sweepsPerStep);
    tool.encode(writer);
}

Tuning Tuning::decode(base::ByteReader& reader) {
    Tuning tuning;
    for (std::int32_t* number : {&tuning.threshold, &tuning.startThreshold, &tuning.sweepsPerStep}) {
        *number = reader.get<std::int32_t>();
    }
    tuning.tool = Tool::decode(reader);
    if (!within(tuning.startThreshold, kLargestThreshold) || !within(tuning.threshold, tuning.startThreshold) ||
        !within(tuning.sweepsPerStep, kMostSweeps)) {
        throw base::FormatError("a material out of range");
    }
    return tuning;
}

}  // namespace sand
