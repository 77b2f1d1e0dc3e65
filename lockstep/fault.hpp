// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// A fault made on purpose, so that operators and tests can see what becomes of it (docs/operator.md).
struct Fault {
    enum class Kind : std::uint8_t {
        slow,       // takes longer to draw
        diverge,    // one bit of its sand flips
        die,        // of a signal
        hang,       // never comes back
        garbage,    // sends random bytes
        partition,  // nothing is heard of it for a while
        view,       // draws one frame from another place
        shader      // finds that one of its shaders does not compile, before the first frame
    };
    static constexpr int kLink = -1;  // not a rank: the link to the haptic server

    Kind kind = Kind::slow;
    int rank = kLink;
    std::uint64_t frame = 1;  // at the beginning of which it strikes
    // Of `slow` alone: in how many frames from then on.
    std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
    std::uint32_t milliseconds = 0;    // of `slow` and `partition`
    int signal = 9;                    // of `die`
    int column = 0, row = 0, bit = 0;  // of `diverge`: of the cell's height, 0 being the lowest

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError when cut short.
    static Fault decode(base::ByteReader& reader);
    friend bool operator==(const Fault&, const Fault&) = default;
};

inline constexpr std::array<std::string_view, 8> kFaultNames{"slow",    "diverge",   "die",  "hang",
                                                             "garbage", "partition", "view", "shader"};

/// The faults that strike one rank, and how they do.
class FaultsOfRank {
public:
    FaultsOfRank(const std::vector<Fault>& all, int rank);

    /// When a frame begins: dies, never returns, or flips a bit of a cell behind the hash's back.
    void strike(std::uint64_t frame, sand::Replica& terrain) const;
    /// When it has been drawn: sleeps, which leaves the cores alone as a slow graphics card does.
    void delay(std::uint64_t frame) const;
    /// Whether this rank comes to the frame's barrier with random bytes.
    [[nodiscard]] bool garbles(std::uint64_t frame) const;
    /// Whether it draws this frame from elsewhere.
    [[nodiscard]] bool movesView(std::uint64_t frame) const;
    /// Whether a shader is to fail.
    [[nodiscard]] bool spoilsShader() const;

private:
    [[nodiscard]] bool any(Fault::Kind kind, std::uint64_t frame) const;

    std::vector<Fault> faults_;
};

}  // namespace lockstep
