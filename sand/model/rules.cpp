// SPDX-License-Identifier: Apache-2.0
#include "sand/model/rules.hpp"

#include <xxhash.h>

#include <string>

namespace sand {
namespace {

constexpr unsigned kTinFlag =
    0x80;  // bit beside the scheme; a height field's rules do not have it and keep their old bytes

Scheme schemeOf(unsigned number) {
    const auto scheme = static_cast<Scheme>(number);
    if (base::nameOf(scheme).empty()) {
        throw base::FormatError("a scene with the unknown scheme " + std::to_string(number));
    }
    return scheme;
}

}  // namespace

void Rules::encode(base::ByteWriter& writer) const {
    for (const std::int32_t number :
         {columns, rows, aspect, tuning.threshold, tuning.startThreshold, tuning.sweepsPerStep, stepsPerSecond}) {
        writer.put(number);
    }
    tuning.tool.encode(writer);
    writer.put(static_cast<std::uint8_t>(static_cast<unsigned>(scheme) | (tin != 0 ? kTinFlag : 0U)));
    writer.put(static_cast<std::uint8_t>(rim));
    writer.put(ground);
    if (tin != 0) {
        writer.put(tin);
    }
}

Rules Rules::decode(base::ByteReader& reader) {
    Rules rules;
    for (std::int32_t* number : {&rules.columns, &rules.rows, &rules.aspect, &rules.tuning.threshold,
                                 &rules.tuning.startThreshold, &rules.tuning.sweepsPerStep, &rules.stepsPerSecond}) {
        *number = reader.get<std::int32_t>();
        if (*number < 0) {
            throw base::FormatError("a scene with a negative rule");
        }
    }
    rules.tuning.tool = Tool::decode(reader);
    const auto coded = reader.get<std::uint8_t>();
    rules.scheme = schemeOf(coded & ~kTinFlag);
    const auto rim = reader.get<std::uint8_t>();
    const bool sides = rules.columns >= 1 && rules.columns <= kMaxSide && rules.rows >= 1 && rules.rows <= kMaxSide;
    if (!sides || rules.aspect < 1 || rim > 1 || rules.stepsPerSecond < 1) {
        throw base::FormatError("a scene with rules out of range");
    }
    rules.rim = static_cast<Rim>(rim);
    rules.ground = reader.get<std::uint64_t>();
    if ((coded & kTinFlag) != 0 && (rules.tin = reader.get<std::uint64_t>()) == 0) {
        throw base::FormatError("a TIN without a digest");
    }
    return rules;
}

std::uint64_t Rules::digest() const {
    base::ByteWriter writer;
    encode(writer);
    return XXH3_64bits_withSeed(writer.bytes().data(), writer.bytes().size(), kAlgorithmVersion);
}

}  // namespace sand
