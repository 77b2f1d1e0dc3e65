// SPDX-License-Identifier: Apache-2.0
#include "sand/model/movement.hpp"

#include <xxhash.h>

#include <algorithm>
#include <string>

namespace sand {

std::uint64_t Movement::digest() const { return XXH3_64bits(moved.data(), moved.size() * sizeof moved[0]); }

void Movement::encode(base::ByteWriter& writer) const {
    for (auto run = moved.begin(); run != moved.end();) {
        const auto end = std::find_if(run, moved.end(), [run](std::uint64_t number) { return number != *run; });
        writer.putVarint(static_cast<std::uint64_t>(end - run));
        writer.putVarint(*run);
        run = end;
    }
}

Movement Movement::decode(std::span<const std::uint8_t> bytes, std::uint64_t step, std::size_t tiles) {
    Movement read;
    read.step = step;
    base::ByteReader reader(bytes);
    while (!reader.atEnd()) {
        const std::uint64_t length = reader.getVarint();
        const std::uint64_t number = reader.getVarint();
        if (length == 0 || length > tiles - read.moved.size()) {
            throw base::FormatError("movement: a run of " + std::to_string(length) + " after " +
                                    std::to_string(read.moved.size()) + " of " + std::to_string(tiles) + " hash tiles");
        }
        if (number > step) {
            throw base::FormatError("movement: step " + std::to_string(number) + " moved the sand of hash tile " +
                                    std::to_string(read.moved.size()) + ", but the state is of step " +
                                    std::to_string(step));
        }
        if (!read.moved.empty() && read.moved.back() == number) {
            throw base::FormatError("movement: two runs of step " + std::to_string(number) + " beside each other");
        }
        read.moved.resize(read.moved.size() + length, number);
        read.newest = std::max(read.newest, number);
    }
    if (read.moved.size() != tiles) {
        throw base::FormatError("movement: numbers for " + std::to_string(read.moved.size()) + " of " +
                                std::to_string(tiles) + " hash tiles");
    }
    return read;
}

}  // namespace sand
