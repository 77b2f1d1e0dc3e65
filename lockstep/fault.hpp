// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "base/fields.hpp"
#include "sand/replica.hpp"

namespace lockstep {

/// A fault that a drill injects on purpose. Operators and tests see how the session reacts (docs/operator.md).
struct Fault {
    enum class Kind : std::uint8_t {
        slow,       // drawing takes longer
        diverge,    // one bit of the rank's sand flips
        movement,   // the step that has last moved the sand of a hash tile changes
        die,        // the process gets a signal that ends it
        hang,       // the process stops and never continues
        garbage,    // random bytes are sent
        partition,  // no bytes arrive for a while
        view,       // one frame is drawn from another place
        shader      // one shader does not compile, before the first frame
    };
    friend constexpr auto valuesOf(Kind) {
        using enum Kind;
        return std::array{base::Named{slow, "slow"},           base::Named{diverge, "diverge"},
                          base::Named{movement, "movement"},   base::Named{die, "die"},
                          base::Named{hang, "hang"},           base::Named{garbage, "garbage"},
                          base::Named{partition, "partition"}, base::Named{view, "view"},
                          base::Named{shader, "shader"}};
    }
    static constexpr int kLink = -1;  // instead of a rank: the link to the haptic server

    Kind kind = Kind::slow;
    int rank = kLink;
    std::uint64_t frame = 1;  // the fault strikes at the beginning of this frame
    // Number of frames from `frame` on that are drawn slowly; only for `slow`.
    std::uint64_t frames = std::numeric_limits<std::uint64_t>::max();
    std::uint32_t milliseconds = 0;  // for `slow` and `partition`
    int signal = 9;                  // for `die`
    int column = 0, row = 0;         // for `diverge` and `movement`: the cell
    int bit = 0;                     // for `diverge`: the bit of the cell's height; bit 0 is the lowest

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("kind", it.kind);
        visit("rank", it.rank);
        visit("frame", it.frame);
        visit("frames", it.frames);
        visit("milliseconds", it.milliseconds);
        visit("signal", it.signal);
        visit("column", it.column);
        visit("row", it.row);
        visit("bit", it.bit);
    }
    friend bool operator==(const Fault&, const Fault&) = default;
};

/// The faults of one rank. Injects them when their frame comes.
class FaultsOfRank {
public:
    FaultsOfRank(const std::vector<Fault>& all, int rank);

    /// Injects the faults at the beginning of frame `frame`: ends the process, or never returns. Or flips a bit of
    /// the sand or of its movement, and does not update the hash.
    void strike(std::uint64_t frame, sand::Replica& replica) const;
    /// Sleeps after frame `frame` has been drawn, if a fault makes it slow. A sleep leaves the cores free, as a slow
    /// graphics card does.
    void delay(std::uint64_t frame) const;
    /// Returns whether this rank sends random bytes to the barrier of frame `frame`.
    [[nodiscard]] bool garbles(std::uint64_t frame) const;
    /// Returns whether this rank draws frame `frame` from another place.
    [[nodiscard]] bool movesView(std::uint64_t frame) const;
    /// Returns whether one of this rank's shaders must fail to compile.
    [[nodiscard]] bool spoilsShader() const;

private:
    [[nodiscard]] bool any(Fault::Kind kind, std::uint64_t frame) const;

    std::vector<Fault> faults_;
};

}  // namespace lockstep
