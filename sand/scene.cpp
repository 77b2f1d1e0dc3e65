// SPDX-License-Identifier: Apache-2.0
#include "sand/scene.hpp"

#include <xxhash.h>

#include "sand/grid_codec.hpp"

namespace sand {

void Rules::tune(const Tuning& tuning) {
    threshold = tuning.threshold;
    startThreshold = tuning.startThreshold;
    sweepsPerStep = tuning.sweepsPerStep;
    toolRadius = tuning.toolRadius;
    toolKind = tuning.toolKind;
    toolHalfWidth = tuning.toolHalfWidth;
    toolHeading = tuning.toolHeading;
}

void Rules::encode(files::ByteWriter& writer) const {
    for (const std::int32_t number :
         {columns, rows, aspect, threshold, startThreshold, sweepsPerStep, stepsPerSecond}) {
        writer.put(number);
    }
    tuning().tool().encode(writer);
    writer.put(static_cast<std::uint8_t>(scheme));
    writer.put(static_cast<std::uint8_t>(rim));
    writer.put(ground);
}

Rules Rules::decode(files::ByteReader& reader) {
    Rules rules;
    for (std::int32_t* number : {&rules.columns, &rules.rows, &rules.aspect, &rules.threshold, &rules.startThreshold,
                                 &rules.sweepsPerStep, &rules.stepsPerSecond}) {
        *number = reader.get<std::int32_t>();
        if (*number < 0) {
            throw files::FormatError("a scene with a negative rule");
        }
    }
    const ToolRules tool = ToolRules::decode(reader);
    rules.toolRadius = tool.shape.radius;
    rules.toolKind = tool.shape.kind;
    rules.toolHalfWidth = tool.shape.halfWidth;
    rules.toolHeading = tool.heading;
    const auto scheme = reader.get<std::uint8_t>();
    const auto rim = reader.get<std::uint8_t>();
    const bool sides = rules.columns >= 1 && rules.columns <= kMaxSide && rules.rows >= 1 && rules.rows <= kMaxSide;
    if (!sides || rules.aspect < 1 || scheme > 2 || rim > 1 || rules.stepsPerSecond < 1) {
        throw files::FormatError("a scene with rules out of range");
    }
    rules.scheme = static_cast<Scheme>(scheme);
    rules.rim = static_cast<Rim>(rim);
    rules.ground = reader.get<std::uint64_t>();
    return rules;
}

std::uint64_t Rules::digest() const {
    files::ByteWriter writer;
    encode(writer);
    return XXH3_64bits_withSeed(writer.bytes().data(), writer.bytes().size(), kAlgorithmVersion);
}

std::int32_t Scene::referenceHeight() const {
    const std::int64_t cells = std::int64_t{terrain.columns()} * terrain.rows();
    return static_cast<std::int32_t>(terrain.volume() / cells);
}

files::Bytes Scene::encode() const {
    files::ByteWriter writer;
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
    if (ground != nullptr) {
        encodeCells(ground->cells(), terrain.bounds(), writer);
    }
    writer.put(static_cast<std::uint8_t>((look.hillShade ? 1 : 0) | (look.flatShading ? 2 : 0)));
    writer.put(look.detail);
    force.encodeRest(writer);
    return writer.take();
}

Scene Scene::decode(std::span<const std::uint8_t> bytes) {
    files::ByteReader reader(bytes);
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
        throw files::FormatError("a scene without a cell size");
    }
    scene.terrain = HeightField(scene.rules.columns, scene.rules.rows, cellSize);
    decodeCells(reader, scene.terrain.bounds(), kMaxHeight, scene.terrain.cells());
    if (scene.rules.ground != 0) {
        scene.ground = std::make_shared<const Ground>(Ground::decode(reader, scene.terrain));
        if (scene.ground->digest() != scene.rules.ground) {
            throw files::FormatError("a scene whose ground is not that of its rules");
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
    return scene;
}

}  // namespace sand
