// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/force_constants.hpp"
#include "sand/georeference.hpp"
#include "sand/ground.hpp"
#include "sand/height_field.hpp"
#include "sand/material.hpp"
#include "sand/tin/start.hpp"
#include "sand/tuning.hpp"

namespace sand {

/// Changes with anything that changes what a step does to the sand; replicas of different versions refuse each other.
inline constexpr std::uint32_t kAlgorithmVersion = 6;

/// sand/erosion.hpp says what they are; plainIsotropic is called G elsewhere, n4 N4.
enum class Scheme : std::uint8_t { isotropic, n4, plainIsotropic };
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
    std::uint64_t tin = 0;     // tin::Start::digest(), 0 for a height field; then columns and rows are nominal

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

/// What to look at, not what to compute: never part of a digest.
struct Look {
    std::vector<double> sandColour{0.80, 0.66, 0.45};        // linear-light RGB, of dry sand in full light
    std::vector<double> backgroundColour{0.10, 0.12, 0.15};  // linear-light RGB
    std::vector<double> sunDirection{-0.55, 0.35, 0.60};     // towards the sun, scene axes x east, y north, z up
    bool flatShading = false;                                // each triangle is lit as one facet
    bool hillShade = false;                                  // shown as a map, until an operator says otherwise
    double detail =
        0.5;  // [pixel], how far a level of detail may shift the picture of any sand; 0: every cell is drawn
};

/// One session's world, read from a TOML file: terrain, material, tool, force, look.
struct Scene {
    std::string name;
    Rules rules;
    ForceConstants force;
    Look look;
    HeightField terrain{1, 1, 1.0};         // as the session starts; of a TIN one cell, for its nominal size
    std::shared_ptr<const tin::Start> tin;  // likewise; null for a height field
    std::shared_ptr<const Ground> ground;   // null without rock and walls
    Georeference georeference;              // where the terrain came from; as it begins where it came from nowhere
    std::vector<std::string> warnings;      // one line each, for whoever loads it to print
    Material material;                      // what the rules were derived from; not encoded, as the warnings are not

    [[nodiscard]] double toolRadius() const {  // [scene unit]
        return rules.toolRadius * terrain.cellSize() / kProbePerCell;
    }
    /// What a material is used with here.
    [[nodiscard]] MaterialGrid grid() const {
        return {rules.scheme, rules.stepsPerSecond, terrain.cellSize(), std::max(rules.columns, rules.rows)};
    }
    /// The mean height the session starts with [unit]: devices hover and dig relative to it.
    [[nodiscard]] std::int32_t referenceHeight() const;

    /// The whole scene as bytes: what the master broadcasts and the journal begins with.
    [[nodiscard]] base::Bytes encode() const;
    /// Throws base::FormatError.
    static Scene decode(std::span<const std::uint8_t> bytes);
};

/// Looks at the size of a height field before its heights are made, and throws if there is no room for it.
using FieldCheck = std::function<void(int columns, int rows)>;

/// Reads a scene file. Throws base::InputError with file, line and key; a DEM's errors name the DEM's line.
/// `check` is called once for a height field, and not for a TIN.
[[nodiscard]] Scene loadScene(const std::filesystem::path& file, const FieldCheck& check = {});

}  // namespace sand
