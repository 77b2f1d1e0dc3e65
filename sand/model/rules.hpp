// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/byte_stream.hpp"
#include "sand/model/tuning.hpp"
#include "sand/model/units.hpp"

namespace sand {

/// Version of the algorithm. It increases with every change to what a step does to the sand. Programs of different
/// versions refuse to run together.
inline constexpr std::uint32_t kAlgorithmVersion = 9;

/// Law by which sand slides on a height field. The documents call `isotropic` G and `plainIsotropic` plain G;
/// docs/sand.md states both laws.
///
/// A scheme keeps its number forever, because digests, messages, journals and checkpoints contain the number. Number 1
/// belonged to a scheme that was removed; Rules::decode() refuses it.
enum class Scheme : std::uint8_t { isotropic = 0, plainIsotropic = 2 };

/// A scheme and its name in scene files and on command lines.
struct NamedScheme {
    Scheme scheme;
    std::string_view name;
};
/// All schemes, the default first.
inline constexpr std::array<NamedScheme, 2> kSchemes{{{Scheme::isotropic, "g"}, {Scheme::plainIsotropic, "g_plain"}}};

/// Border of the field.
enum class Rim : std::uint8_t {
    closed,  // keeps all sand on the field
    open     // lets sand fall over it, as outflow
};

/// The rules by which every replica computes its sand, as numbers. The process that loads the scene derives them once
/// and sends them to all other processes. These never derive them again, because the last digit of libm's results
/// differs between hosts.
struct Rules {
    std::int32_t columns = 0, rows = 0;  // [cell]
    /// Side of a cell from south to north, divided by its side from west to east [2^-16].
    std::int32_t aspect = kUnitsPerCell;
    /// Largest stable height difference over one cell from west to east: tan(talus) · cell size [unit].
    std::int32_t threshold = 0;
    /// Height difference, over the same distance, beyond which sand at rest starts to slide [unit]. It is at least
    /// `threshold`; a larger value gives hysteresis.
    std::int32_t startThreshold = 0;
    std::int32_t sweepsPerStep = 0;
    std::int32_t stepsPerSecond = 0;
    std::int32_t toolRadius = 0;  // [probe unit]
    ToolKind toolKind = ToolKind::sphere;
    std::int32_t toolHalfWidth = 0;  // [probe unit], see ToolShape::halfWidth
    Heading toolHeading{};           // the tool's heading until a hand turns it
    Scheme scheme = Scheme::isotropic;
    Rim rim = Rim::closed;
    std::uint64_t ground = 0;  // Ground::digest(); 0 without rock and wall cells
    std::uint64_t tin = 0;     // tin::TinStart::digest(), which makes columns and rows nominal; 0 for a height field

    [[nodiscard]] ToolShape toolShape() const { return {toolKind, toolRadius, toolHalfWidth}; }
    [[nodiscard]] Tuning tuning() const {
        return {threshold, startThreshold, sweepsPerStep, toolRadius, toolKind, toolHalfWidth, toolHeading};
    }
    /// Replaces the rules that an operator may change.
    void tune(const Tuning& tuning);

    /// Returns a digest of what heights belong to, beside the size: rock and walls of a height field, or the start of a
    /// TIN.
    [[nodiscard]] std::uint64_t siteDigest() const { return ground ^ tin; }

    void encode(base::ByteWriter& writer) const;
    /// Reads what encode() wrote. Throws base::FormatError for an unknown scheme or numbers out of range.
    static Rules decode(base::ByteReader& reader);
    /// Returns a hash of the encoded rules and kAlgorithmVersion. Server and master compare it: replicas with equal
    /// digests and equal sand stay equal under equal steps.
    [[nodiscard]] std::uint64_t digest() const;
    friend bool operator==(const Rules&, const Rules&) = default;
};

}  // namespace sand
