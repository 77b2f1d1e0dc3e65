// SPDX-License-Identifier: Apache-2.0
#include "sand/scene.hpp"

#include <xxhash.h>

#include "sand/grid_codec.hpp"

namespace sand {
namespace {

constexpr unsigned kTinFlag = 0x80;  // beside the scheme: scenes of height fields are the bytes they always were
/// What may stand at the end of a scene, each with its length in bytes.
enum class Part : std::uint8_t { georeference = 1 };

void decodePart(base::ByteReader& reader, Scene& scene) {
    const auto part = reader.get<std::uint8_t>();
    base::ByteReader bytes(reader.getBlock());
    if (part != static_cast<std::uint8_t>(Part::georeference)) {
        throw base::FormatError("a scene with a part that this version does not know");
    }
    scene.georeference = Georeference::decode(bytes);
    if (!bytes.atEnd()) {
        throw base::FormatError("a scene with a part that is longer than it should be");
    }
}

}  // namespace

void Rules::tune(const Tuning& tuning) {
    threshold = tuning.threshold;
    startThreshold = tuning.startThreshold;
    sweepsPerStep = tuning.sweepsPerStep;
    toolRadius = tuning.toolRadius;
    toolKind = tuning.toolKind;
    toolHalfWidth = tuning.toolHalfWidth;
    toolHeading = tuning.toolHeading;
}

void Rules::encode(base::ByteWriter& writer) const {
    for (const std::int32_t number :
         {columns, rows, aspect, threshold, startThreshold, sweepsPerStep, stepsPerSecond}) {
        writer.put(number);
    }
    tuning().tool().encode(writer);
    writer.put(static_cast<std::uint8_t>(static_cast<unsigned>(scheme) | (tin != 0 ? kTinFlag : 0U)));
    writer.put(static_cast<std::uint8_t>(rim));
    writer.put(ground);
    if (tin != 0) {
        writer.put(tin);
    }
}

Rules Rules::decode(base::ByteReader& reader) {
    Rules rules;
    for (std::int32_t* number : {&rules.columns, &rules.rows, &rules.aspect, &rules.threshold, &rules.startThreshold,
                                 &rules.sweepsPerStep, &rules.stepsPerSecond}) {
        *number = reader.get<std::int32_t>();
        if (*number < 0) {
            throw base::FormatError("a scene with a negative rule");
        }
    }
    const ToolRules tool = ToolRules::decode(reader);
    rules.toolRadius = tool.shape.radius;
    rules.toolKind = tool.shape.kind;
    rules.toolHalfWidth = tool.shape.halfWidth;
    rules.toolHeading = tool.heading;
    const auto coded = reader.get<std::uint8_t>();
    const unsigned scheme = coded & ~kTinFlag;
    const auto rim = reader.get<std::uint8_t>();
    const bool sides = rules.columns >= 1 && rules.columns <= kMaxSide && rules.rows >= 1 && rules.rows <= kMaxSide;
    if (!sides || rules.aspect < 1 || scheme > 2 || rim > 1 || rules.stepsPerSecond < 1) {
        throw base::FormatError("a scene with rules out of range");
    }
    rules.scheme = static_cast<Scheme>(scheme);
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

std::int32_t Scene::referenceHeight() const {
    if (tin != nullptr) {
        return tin->meanHeight;
    }
    const std::int64_t cells = std::int64_t{terrain.columns()} * terrain.rows();
    return static_cast<std::int32_t>(terrain.volume() / cells);
}

base::Bytes Scene::encode() const {
    base::ByteWriter writer;
    writer.putText(name);
    rules.encode(writer);
    for (const double constant : {force.stiffness, force.depthExponent, force.friction}) {
        writer.put(constant);
    }
    for (const auto* triple : {&look.sandColour, &look.backgroundColour, &look.sunDirection}) {
        for (const double number : *triple) {
            writer.put(number);
        }
    }
    writer.put(terrain.cellSize());
    encodeCells(terrain.cells(), terrain.bounds(), writer);
    if (tin != nullptr) {
        tin->encode(writer);
    }
    if (ground != nullptr) {
        encodeCells(ground->cells(), terrain.bounds(), writer);
    }
    writer.put(static_cast<std::uint8_t>((look.hillShade ? 1 : 0) | (look.flatShading ? 2 : 0)));
    writer.put(look.detail);
    force.encodeRest(writer);
    if (georeference != Georeference{}) {
        base::ByteWriter part;
        georeference.encode(part);
        writer.put(static_cast<std::uint8_t>(Part::georeference));
        writer.putBlock(part.bytes());
    }
    return writer.take();
}

Scene Scene::decode(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    Scene scene;
    scene.name = reader.getText();
    scene.rules = Rules::decode(reader);
    for (double* constant : {&scene.force.stiffness, &scene.force.depthExponent, &scene.force.friction}) {
        *constant = reader.get<double>();
    }
    for (auto* triple : {&scene.look.sandColour, &scene.look.backgroundColour, &scene.look.sunDirection}) {
        for (double& number : *triple) {
            number = reader.get<double>();
        }
    }
    const auto cellSize = reader.get<double>();
    if (!(cellSize > 0)) {
        throw base::FormatError("a scene without a cell size");
    }
    const bool grid = scene.rules.tin == 0;
    scene.terrain = HeightField(grid ? scene.rules.columns : 1, grid ? scene.rules.rows : 1, cellSize);
    decodeCells(reader, scene.terrain.bounds(), kMaxHeight, scene.terrain.cells());
    if (!grid) {
        scene.tin = std::make_shared<const tin::Start>(tin::Start::decode(reader));
        if (scene.tin->digest() != scene.rules.tin || scene.rules.ground != 0) {
            throw base::FormatError("a scene whose TIN is not that of its rules");
        }
    }
    if (scene.rules.ground != 0) {
        scene.ground = std::make_shared<const Ground>(Ground::decode(reader, scene.terrain));
        if (scene.ground->digest() != scene.rules.ground) {
            throw base::FormatError("a scene whose ground is not that of its rules");
        }
    }
    // Journals end where what came later had not been thought of: hill-shade and levels of detail, then more forces.
    if (!reader.atEnd()) {
        const auto flags = reader.get<std::uint8_t>();
        scene.look.hillShade = (flags & 1U) != 0;
        scene.look.flatShading = (flags & 2U) != 0;
        scene.look.detail = reader.get<double>();
    }
    if (!reader.atEnd()) {
        scene.force.decodeRest(reader);
    }
    while (!reader.atEnd()) {
        decodePart(reader, scene);
    }
    return scene;
}

}  // namespace sand
