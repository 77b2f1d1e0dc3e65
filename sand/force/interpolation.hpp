// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "sand/force/response.hpp"

namespace sand::force {

/// Equation 9 of Purchart et al. 2012, reconstructed from its prose. It spreads each change of the force over the ticks
/// until the next surface:
///
///     F_out = F_old + (F − F_old) min(it/itp, 1)
///
/// - F: the law's response to the surface that arrived last.
/// - F_old: the response from which the change begins.
/// - it: number of ticks since that surface arrived, including this one.
/// - itp: number of ticks between the arrivals of the last two surfaces. It is 16 or 17 at 60 surfaces and 1000 ticks
///   per second, the rates of both papers.
///
/// The interpolation delays the force by a whole step of the sand.
///
/// The paper's F_old is the response to the surface before. If a surface arrives early, the output has not yet reached
/// that response, and jumps to it. With `literal`, F_old is the paper's, jump included. Without, F_old is the last
/// output, and the output never jumps.
class Interpolation {
public:
    /// Returns the response of this tick. Call it once per tick.
    ///
    /// @param replaced  Whether another surface has arrived. `next` is then the law's response to it.
    /// @param forget    Whether to begin at `next`, without a change.
    /// @param literal   ForceConstants::literal.
    /// @param next      Read only if `replaced` or `forget` is true.
    [[nodiscard]] const Response& at(bool replaced, bool forget, bool literal, const Response& next) {
        if (forget) {
            from_ = to_ = out_ = next;
            frames_ = previousFrames_ = 0;
        } else if (replaced) {
            from_ = literal ? to_ : out_;
            to_ = next;
            previousFrames_ = frames_;
            frames_ = 0;
        }
        ++frames_;
        const double part = frames_ < previousFrames_ ? static_cast<double>(frames_) / previousFrames_ : 1;
        out_ = to_;
        out_.push = from_.push + part * (to_.push - from_.push);
        out_.drag = from_.drag + part * (to_.drag - from_.drag);
        return out_;
    }

private:
    Response from_, to_, out_;
    int frames_ = 0, previousFrames_ = 0;  // it, itp
};

}  // namespace sand::force
