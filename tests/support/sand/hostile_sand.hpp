// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "sand/replica.hpp"
#include "sand/tin/geometry/tin_start.hpp"

/// Sand that a hostile program could send.
namespace hostile_sand {

/// Returns `head` and behind it `zeros` zeros, compressed. The zeros are never in memory all at once.
inline base::Bytes packedZeros(const base::Bytes& head, std::uint64_t zeros) {
    const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
    const std::vector<std::uint8_t> none(1U << 20U, 0);
    base::Bytes packed, out(1U << 20U);
    const auto feed = [&](std::span<const std::uint8_t> bytes, ZSTD_EndDirective how) {
        ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
        std::size_t left = 1;
        while (how == ZSTD_e_end ? left != 0 : in.pos < in.size) {
            ZSTD_outBuffer to{out.data(), out.size(), 0};
            left = ZSTD_compressStream2(context.get(), &to, &in, how);
            if (ZSTD_isError(left) != 0) {
                throw std::runtime_error("zstd");
            }
            packed.insert(packed.end(), out.begin(), out.begin() + static_cast<std::ptrdiff_t>(to.pos));
        }
    };
    feed(head, ZSTD_e_continue);
    for (; zeros > none.size(); zeros -= none.size()) {
        feed(none, ZSTD_e_continue);
    }
    feed(std::span(none).first(zeros), ZSTD_e_end);
    return packed;
}

/// Returns bytes of a TIN's sand that claim `size` plain bytes, all but a few of them for vertices that do not exist.
/// Such a vertex takes one byte, and its compression a thousandth of that.
inline base::Bytes ofDeadVertices(const sand::tin::TinStart& start, std::uint64_t size) {
    base::ByteWriter head;
    head.put(start.width);
    head.put(start.depth);
    constexpr std::uint64_t kHead = 8 + 5;  // the number takes 5 bytes from 2^28 on
    head.putVarint(size - kHead);
    base::ByteWriter sand;
    sand.put(std::int64_t{0});  // outflow
    sand.put(std::int32_t{0});  // vertex at which coarsening continues
    sand.put(std::uint8_t{0});  // no imprint
    sand.put(size);
    sand.putBytes(packedZeros(head.bytes(), size - head.bytes().size()));
    return sand.take();
}

/// Returns the sand of a TIN with other plain bytes.
inline base::Bytes packedTin(const base::Bytes& plain, std::int64_t outflow = 0) {
    base::ByteWriter sand;
    sand.put(outflow);
    sand.put(std::int32_t{0});
    sand.put(std::uint8_t{0});
    sand.put(static_cast<std::uint64_t>(plain.size()));
    sand.putBytes(packedZeros(plain, 0));
    return sand.take();
}

/// Returns the bytes of saved sand with another outflow, with which they begin.
inline base::Bytes withOutflow(base::Bytes sand, std::int64_t outflow) {
    std::memcpy(sand.data(), &outflow, sizeof outflow);
    return sand;
}

/// Returns a state of `replica`, but with other sand.
inline base::Bytes stateWith(const sand::Replica& replica, const base::Bytes& sand) {
    base::ByteWriter state;
    const sand::StateCopy copy = replica.copyState();
    state.putBytes(copy.head);
    state.putBlock(copy.movement);
    state.putBlock({});  // no sand for an undo
    state.putBytes(sand);
    return state.take();
}

}  // namespace hostile_sand
