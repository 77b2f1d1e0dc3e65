// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/field_forms.hpp"
#include "sand/force/force_constants.hpp"
#include "sand/start.hpp"
#include "scene/model/georeference.hpp"
#include "scene/model/material.hpp"
#include "scene/model/raster_statement.hpp"

namespace scene {

/// Appearance of a scene. It is never part of a digest, because the sand does not depend on it.
struct Look {
    std::vector<double> sandColour{0.80, 0.66, 0.45};        // of dry sand in full light, linear-light RGB
    std::vector<double> backgroundColour{0.10, 0.12, 0.15};  // linear-light RGB
    std::vector<double> sunDirection{-0.55, 0.35, 0.60};     // towards the sun, scene axes x east, y north, z up
    bool flatShading = false;                                // each triangle is lit as one facet
    bool hillShade = false;  // whether the sand is drawn as a map until an operator changes that
    /// Largest shift of the picture of any sand by a level of detail [pixel]; 0 draws every cell.
    double detail = 0.5;
    static constexpr double kMostDetail = 64;  // [pixel]

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("sand_colour", base::exactly(it.sandColour, 3));
        visit("background", base::exactly(it.backgroundColour, 3));
        visit("sun", base::exactly(it.sunDirection, 3));
        visit("shading", base::flags(it.hillShade, it.flatShading));
        visit("detail", base::limited(it.detail, 0, kMostDetail));
    }
};

/// Everything that a session begins with, read from a TOML file: rules, sand, ground, material, force and look.
struct Scene : sand::Start {
    std::string name;
    sand::ForceConstants force;
    Look look;
    Georeference georeference;  // origin of the terrain; default values if it came from no file
    /// Units and no data of the files of terrain, in the order in which they were read. nullopt if unknown, as in a
    /// scene from a journal of an earlier build.
    std::optional<std::vector<RasterStatement>> statements;
    std::vector<std::string> warnings;  // one line each, for the program that loads the scene to print
    Material material;                  // source of the rules; not encoded, and neither are the warnings

    /// Returns the numbers of this scene with which a material is used.
    [[nodiscard]] MaterialGrid grid() const {
        return {rules.scheme, rules.stepsPerSecond, terrain.cellSize(), std::max(rules.columns, rules.rows)};
    }
    /// Returns the whole scene as bytes, which the master broadcasts and with which the journal begins. The bytes name
    /// files without their folders.
    [[nodiscard]] base::Bytes encode() const;
    /// Reads what encode() wrote, except warnings and material. Throws base::FormatError for invalid bytes. Calls
    /// `decoded` as decodeSand() does.
    static Scene decode(std::span<const std::uint8_t> bytes, Keep keep = Keep::heights,
                        const std::function<void(std::size_t)>& decoded = {});
    /// Decodes only the rules, which give the size of the rest. Throws base::FormatError.
    static sand::Rules decodeRules(std::span<const std::uint8_t> bytes);
};

/// That by which another scene is recognised as the same one, without its heights in memory. Statements, warnings and
/// material do not count: the same scene may be read by another path, and journals of earlier builds have no
/// statements.
class SceneIdentity {
public:
    /// Shares Start::packed of `scene`, or makes it.
    explicit SceneIdentity(const Scene& scene);
    [[nodiscard]] bool isOf(const Scene& scene) const;
    [[nodiscard]] sand::FieldSize size() const { return size_; }

private:
    sand::FieldSize size_;
    base::Bytes settings_;
    std::shared_ptr<const base::Bytes> heights_;
};

}  // namespace scene
