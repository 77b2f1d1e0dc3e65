// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.hpp"

#include <algorithm>

namespace scene {
namespace {

/// Parts that may follow a scene, each with its length in bytes.
enum class Part : std::uint8_t { georeference = 1, statements = 2 };

constexpr std::size_t kMostStatements = 16;  // a terrain has two files at most

void encodePart(Part part, const base::ByteWriter& bytes, base::ByteWriter& writer) {
    writer.put(static_cast<std::uint8_t>(part));
    writer.putBlock(bytes.bytes());
}

void encodeStatements(const std::vector<RasterStatement>& statements, base::ByteWriter& writer) {
    base::ByteWriter part;
    base::upTo<std::uint32_t>(statements, kMostStatements).put(part);
    encodePart(Part::statements, part, writer);
}

std::vector<RasterStatement> decodeStatements(base::ByteReader& reader) {
    std::vector<RasterStatement> statements;
    base::upTo<std::uint32_t>(statements, kMostStatements).get(reader);
    return statements;
}

void decodePart(base::ByteReader& reader, Scene& scene) {
    const auto part = static_cast<Part>(reader.get<std::uint8_t>());
    base::ByteReader bytes(reader.getBlock());
    switch (part) {
        case Part::georeference:
            scene.georeference = Georeference::decode(bytes);
            break;
        case Part::statements:
            scene.statements = decodeStatements(bytes);
            break;
        default:
            throw base::FormatError("a scene with a part that this version does not know");
    }
    if (!bytes.atEnd()) {
        throw base::FormatError("a scene with a part that is longer than it should be");
    }
}

}  // namespace

base::ByteWriter Scene::encodeWithoutStatements() const {
    base::ByteWriter writer;
    writer.putText(name);
    base::putMember(writer, rules);
    for (const double constant : {force.stiffness, force.depthExponent, force.friction}) {
        writer.put(constant);
    }
    for (const auto* triple : {&look.sandColour, &look.backgroundColour, &look.sunDirection}) {
        for (const double number : *triple) {
            writer.put(number);
        }
    }
    writer.put(terrain.cellSize());
    encodeSand(writer);
    writer.put(static_cast<std::uint8_t>((look.hillShade ? 1 : 0) | (look.flatShading ? 2 : 0)));
    writer.put(look.detail);
    force.encodeRest(writer);
    if (georeference != Georeference{}) {
        base::ByteWriter part;
        georeference.encode(part);
        encodePart(Part::georeference, part, writer);
    }
    return writer;
}

base::Bytes Scene::encode() const {
    base::ByteWriter writer = encodeWithoutStatements();
    if (statements) {  // the last part, so that isEncodedAs() can leave it out
        encodeStatements(*statements, writer);
    }
    return writer.take();
}

bool Scene::isEncodedAs(std::span<const std::uint8_t> bytes) const {
    const base::Bytes own = encodeWithoutStatements().take();
    if (bytes.size() < own.size() || !std::equal(own.begin(), own.end(), bytes.begin())) {
        return false;
    }
    const auto rest = bytes.subspan(own.size());
    return rest.empty() || rest.front() == static_cast<std::uint8_t>(Part::statements);
}

sand::Rules Scene::decodeRules(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    (void)reader.getText();  // the name
    return base::read<sand::Rules>(reader);
}

Scene Scene::decode(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    Scene scene;
    scene.name = reader.getText();
    scene.rules = base::read<sand::Rules>(reader);
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
    scene.decodeSand(reader, cellSize);
    const auto flags = reader.get<std::uint8_t>();
    scene.look.hillShade = (flags & 1U) != 0;
    scene.look.flatShading = (flags & 2U) != 0;
    scene.look.detail = reader.get<double>();
    scene.force.decodeRest(reader);
    while (!reader.atEnd()) {
        decodePart(reader, scene);
    }
    return scene;
}

}  // namespace scene
