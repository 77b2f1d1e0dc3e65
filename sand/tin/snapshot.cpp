// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/snapshot.hpp"

#include <zstd.h>

#include <string>
#include <utility>

namespace sand::tin {
namespace {

constexpr std::uint64_t kMostPlain = std::uint64_t{1} << 30;  // [byte], enough for about thirty million vertices

}  // namespace

void TinState::encode(base::ByteWriter& writer) const {
    writer.put(outflow);
    writer.put(nextToGo);
    imprint.encode(writer);
}

TinState TinState::decode(base::ByteReader& reader) {
    TinState state;
    state.outflow = reader.get<std::int64_t>();
    state.nextToGo = reader.get<Vertex>();
    if (state.nextToGo < 0) {
        throw base::FormatError("a TIN whose coarsening continues at a negative vertex");
    }
    state.imprint = Imprint::decode(reader);
    return state;
}

Snapshot::Snapshot(const VertexSandParts& layer, TinState state) : holes_(layer.holes), state_(std::move(state)) {
    base::ByteWriter writer;
    layer.encode(writer);
    plain_ = writer.take();
}

Snapshot::Snapshot(std::span<const std::uint8_t> packed, std::int32_t width, std::int32_t depth,
                   std::shared_ptr<const Holes> holes)
    : holes_(std::move(holes)) {
    base::ByteReader reader(packed);
    state_ = TinState::decode(reader);
    const auto size = reader.get<std::uint64_t>();
    if (size > kMostPlain) {
        throw base::FormatError("a TIN of more than 2^30 bytes");
    }
    const auto rest = reader.rest();
    plain_.resize(size);
    if (ZSTD_decompress(plain_.data(), plain_.size(), rest.data(), rest.size()) != size) {
        throw base::FormatError("a TIN that does not unpack to its size");
    }
    const VertexSand whole = layer();  // throws if the bytes are not a VertexSand
    if (whole.triangles().width != width || whole.triangles().depth != depth) {
        throw base::FormatError("a TIN of another field");
    }
}

base::Bytes Snapshot::encode() const {
    base::ByteWriter writer;
    state_.encode(writer);
    writer.put(static_cast<std::uint64_t>(plain_.size()));
    base::Bytes packed(ZSTD_compressBound(plain_.size()));
    const std::size_t used = ZSTD_compress(packed.data(), packed.size(), plain_.data(), plain_.size(), 1);
    if (ZSTD_isError(used) != 0) {
        throw base::FormatError(std::string("zstd: ") + ZSTD_getErrorName(used));
    }
    packed.resize(used);
    writer.putBytes(packed);
    return writer.take();
}

VertexSand Snapshot::layer() const {
    base::ByteReader reader(plain_);
    VertexSand layer = VertexSand::decode(reader, holes_);
    if (!reader.atEnd()) {
        throw base::FormatError("a TIN with further bytes after its end");
    }
    return layer;
}

}  // namespace sand::tin
