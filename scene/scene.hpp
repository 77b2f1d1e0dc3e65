// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/force/force_constants.hpp"
#include "sand/start.hpp"
#include "scene/georeference.hpp"
#include "scene/material.hpp"

namespace scene {

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

/// One session's world, read from a TOML file: what every replica starts with, material, force, look.
struct Scene : sand::Start {
    std::string name;
    sand::ForceConstants force;
    Look look;
    Georeference georeference;          // where the terrain came from; as it begins where it came from nowhere
    std::vector<std::string> warnings;  // one line each, for whoever loads it to print
    Material material;                  // what the rules were derived from; not encoded, as the warnings are not

    /// What a material is used with here.
    [[nodiscard]] MaterialGrid grid() const {
        return {rules.scheme, rules.stepsPerSecond, terrain.cellSize(), std::max(rules.columns, rules.rows)};
    }
    /// The whole scene as bytes: what the master broadcasts and the journal begins with.
    [[nodiscard]] base::Bytes encode() const;
    /// Throws base::FormatError.
    static Scene decode(std::span<const std::uint8_t> bytes);
    /// Decodes the rules only, which say how large the rest is. Throws base::FormatError.
    static sand::Rules decodeRules(std::span<const std::uint8_t> bytes);
};

}  // namespace scene
