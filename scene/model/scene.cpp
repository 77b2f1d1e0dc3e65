// SPDX-License-Identifier: Apache-2.0
#include "scene/model/scene.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include "sand/model/grid_codec.hpp"

namespace scene {
namespace {

/// Part that may follow a scene, with its length in bytes.
struct Part {
    enum class Kind : std::uint8_t { georeference = 1, statements = 2 };
    friend constexpr auto valuesOf(Kind) {
        return std::array{base::Named{Kind::georeference, "georeference"}, base::Named{Kind::statements, "statements"}};
    }
    Kind kind{};
    base::Bytes bytes;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("kind", it.kind);
        visit("bytes", base::block(it.bytes));
    }
};

/// Bytes of Part::statements.
struct Statements {
    std::vector<RasterStatement> statements;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        constexpr std::size_t kMost = 16;  // a terrain has two files at most
        visit("statements", base::upTo<std::uint32_t>(it.statements, kMost));
    }
};

/// What is written of a scene. `settings` is all without sand and statements.
enum class Content : bool { settings, all };

/// Form of the parts of a scene. Statements are the last part, so that a scene without them has the same first bytes.
template <class AnyScene>
struct Parts {
    AnyScene& scene;
    Content content;
    void put(base::ByteWriter& writer) const {
        if (scene.georeference != Georeference{}) {
            base::putMember(writer, Part{Part::Kind::georeference, base::encoded(scene.georeference)});
        }
        if (scene.statements && content == Content::all) {
            Statements named{*scene.statements};
            for (RasterStatement& statement : named.statements) {
                // A journal is given to other people, and its reader has no use for the folders of this machine.
                statement.file.erase(0, statement.file.rfind('/') + 1);
            }
            base::putMember(writer, Part{Part::Kind::statements, base::encoded(named)});
        }
    }
    void get(base::ByteReader& reader) const requires(!std::is_const_v<AnyScene>) {
        while (!reader.atEnd()) {
            const Part part = base::read<Part>(reader);
            if (part.kind == Part::Kind::georeference) {
                scene.georeference = base::decoded<Georeference>(part.bytes);
            } else {
                scene.statements = base::decoded<Statements>(part.bytes).statements;
            }
        }
    }
};

/// Form of the sand and the ground of a scene, whose size and kind are in the rules.
template <class AnyScene>
struct Sand {
    AnyScene& scene;
    double cellSize;  // [scene unit]
    Content content;
    sand::Start::Keep keep;
    const std::function<void(std::size_t)>& decoded;
    void put(base::ByteWriter& writer) const {
        if (content == Content::all) {
            scene.encodeSand(writer);
        }
    }
    void get(base::ByteReader& reader) const requires(!std::is_const_v<AnyScene>) {
        scene.decodeSand(reader, cellSize, keep, decoded);
    }
};

/// The first fields of a scene. The rules give the size of the rest.
struct Head {
    std::string name;
    sand::Rules rules;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("name", base::text(it.name, kLongestText));
        visit("rules", it.rules);
    }
};

/// All fields of a scene.
template <class AnyScene>
struct Whole {
    AnyScene& scene;
    Content content = Content::all;
    sand::Start::Keep keep = sand::Start::Keep::heights;
    std::function<void(std::size_t)> decoded{};
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        AnyScene& scene = it.scene;
        Head::fields(scene, visit);
        double cellSize = scene.terrain.cellSize();
        visit("cell_size",
              base::limited(cellSize, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()));
        visit("sand", Sand<AnyScene>{scene, cellSize, it.content, it.keep, it.decoded});
        Look::fields(scene.look, visit);
        sand::ForceConstants::fields(scene.force, visit);
        visit("parts", Parts<AnyScene>{scene, it.content});
    }
};

}  // namespace

base::Bytes Scene::encode() const {
    constexpr std::size_t kRest = 1 << 16;  // [byte], a usual size of all but the heights
    base::ByteWriter writer;
    writer.reserve((packed != nullptr ? packed->size() : 0) + kRest);
    base::putMember(writer, Whole<const Scene>{*this});
    return writer.take();
}

SceneIdentity::SceneIdentity(const Scene& scene)
    : size_(sand::FieldSize::of(scene.rules)),
      settings_(base::encoded(Whole<const Scene>{scene, Content::settings})),
      heights_(scene.packed != nullptr ? scene.packed
                                       : sand::packedCells(scene.terrain.cells(), scene.terrain.bounds())) {}

bool SceneIdentity::isOf(const Scene& scene) const {
    // The rules have digests of the mesh of a TIN and of the ground.
    return settings_ == base::encoded(Whole<const Scene>{scene, Content::settings}) && scene.hasHeights(*heights_);
}

sand::Rules Scene::decodeRules(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    return base::read<Head>(reader).rules;
}

Scene Scene::decode(std::span<const std::uint8_t> bytes, Keep keep, const std::function<void(std::size_t)>& decoded) {
    base::ByteReader reader(bytes);
    Scene scene;
    base::getMember(reader, Whole<Scene>{scene, Content::all, keep, decoded});
    return scene;
}

}  // namespace scene
