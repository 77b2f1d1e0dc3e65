// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/snapshot.hpp"

#include <zstd.h>

#include <string>
#include <utility>

namespace sand::tin {

void TinState::encode(base::ByteWriter& writer) const {
    writer.put(outflow);
    writer.put(nextToGo);
    imprint.encode(writer);
}

TinState TinState::decode(base::ByteReader& reader, std::size_t mostVertices) {
    TinState state;
    state.outflow = reader.get<std::int64_t>();
    state.nextToGo = reader.get<Vertex>();
    if (state.nextToGo < 0) {
        throw base::FormatError("a TIN whose coarsening continues at a negative vertex");
    }
    state.imprint = Imprint::decode(reader, mostVertices);
    return state;
}

Snapshot::Snapshot(const VertexSandParts& layer, TinState state) : holes_(layer.holes), state_(std::move(state)) {
    base::ByteWriter writer;
    layer.encode(writer);
    plain_ = writer.take();
}

Snapshot::Snapshot(std::span<const std::uint8_t> packed, const SandLimits& limits)
    : holes_(limits.holes), mostVertices_(limits.mostVertices) {
    base::ByteReader reader(packed);
    state_ = TinState::decode(reader, mostVertices_);
    const auto size = reader.get<std::uint64_t>();
    if (const std::uint64_t most = VertexSand::mostBytes(mostVertices_); size > most) {
        throw base::FormatError("a TIN of " + std::to_string(size) + " bytes; " + std::to_string(mostVertices_) +
                                " vertices take at most " + std::to_string(most));
    }
    const auto rest = reader.rest();
    plain_.resize(size);
    if (ZSTD_decompress(plain_.data(), plain_.size(), rest.data(), rest.size()) != size) {
        throw base::FormatError("a TIN that does not unpack to its size");
    }
    const VertexSand whole = layer();  // throws if the bytes are not a VertexSand
    if (whole.triangles().width != limits.width || whole.triangles().depth != limits.depth) {
        throw base::FormatError("a TIN of another field");
    }
    const Wide sum = whole.volume() + state_.outflow;
    if (sum > kMostSand || sum < -kMostSand) {
        throw base::FormatError("a TIN whose outflow is more than all of its sand");
    }
}

void Snapshot::encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const {
    if (between) {
        between();  // once, because a TIN is small
    }
    state_.encode(writer);
    writer.put(static_cast<std::uint64_t>(plain_.size()));
    base::Bytes packed(ZSTD_compressBound(plain_.size()));
    const std::size_t used = ZSTD_compress(packed.data(), packed.size(), plain_.data(), plain_.size(), 1);
    if (ZSTD_isError(used) != 0) {
        throw base::FormatError(std::string("zstd: ") + ZSTD_getErrorName(used));
    }
    packed.resize(used);
    writer.putBytes(packed);
}

VertexSand Snapshot::layer() const {
    base::ByteReader reader(plain_);
    VertexSand layer = VertexSand::decode(reader, holes_, mostVertices_);
    if (!reader.atEnd()) {
        throw base::FormatError("a TIN with further bytes after its end");
    }
    return layer;
}

}  // namespace sand::tin
