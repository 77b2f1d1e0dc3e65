// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/byte_stream.hpp"
#include "sand/model/tuning.hpp"
#include "sand/model/units.hpp"

namespace sand {

/// Changes with anything that changes what a step does to the sand; replicas of different versions refuse each other.
inline constexpr std::uint32_t kAlgorithmVersion = 7;

/// docs/sand.md states both laws. The documents call `isotropic` G and `plainIsotropic` plain G.
///
/// The numbers enter digests, messages, journals and checkpoints, so a scheme keeps its number for good. Number 1
/// belonged to a scheme that was removed; decode() refuses it.
enum class Scheme : std::uint8_t { isotropic = 0, plainIsotropic = 2 };

struct NamedScheme {
    Scheme scheme;
    std::string_view name;
};
/// Every scheme, the default first, by its name in scene files and on command lines.
inline constexpr std::array<NamedScheme, 2> kSchemes{{{Scheme::isotropic, "g"}, {Scheme::plainIsotropic, "g_plain"}}};

enum class Rim : std::uint8_t { closed, open };

/// Every number the sand is computed from: derived once by whoever loads the scene, then broadcast, never recomputed.
struct Rules {
    std::int32_t columns = 0, rows = 0;
    std::int32_t aspect = kUnitsPerCell;  // length of a cell from south to north over that from west to east [2^-16]
    std::int32_t threshold = 0;           // [unit], largest stable difference between neighbours: tan(talus) · cell
    std::int32_t startThreshold = 0;  // [unit], ≥ threshold: sand at rest starts to slide beyond this (hysteresis)
    std::int32_t sweepsPerStep = 0;
    std::int32_t stepsPerSecond = 0;
    std::int32_t toolRadius = 0;  // [probe unit]
    ToolKind toolKind = ToolKind::sphere;
    std::int32_t toolHalfWidth = 0;  // [probe unit], as in ToolShape
    Heading toolHeading{};           // until a hand turns it
    Scheme scheme = Scheme::isotropic;
    Rim rim = Rim::closed;
    std::uint64_t ground = 0;  // Ground::digest(), 0 without rock and walls
    std::uint64_t tin = 0;     // tin::TinStart::digest(), 0 for a height field; then columns and rows are nominal

    [[nodiscard]] ToolShape toolShape() const { return {toolKind, toolRadius, toolHalfWidth}; }
    [[nodiscard]] Tuning tuning() const {
        return {threshold, startThreshold, sweepsPerStep, toolRadius, toolKind, toolHalfWidth, toolHeading};
    }
    void tune(const Tuning& tuning);

    void encode(base::ByteWriter& writer) const;
    static Rules decode(base::ByteReader& reader);
    /// What server and master compare: equal digests mean equal sand from equal steps.
    [[nodiscard]] std::uint64_t digest() const;
    friend bool operator==(const Rules&, const Rules&) = default;
};

}  // namespace sand
