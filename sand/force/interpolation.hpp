// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "sand/force/response.hpp"

namespace sand::force {

/// Equation 9 of Purchart et al. 2012, reconstructed from its prose: F_out = F_old + (F − F_old) min(it/itp, 1).
///
/// F is the law's at the last surface's arrival, F_old the one before. `it` counts the haptic frames since, this
/// one included, `itp` those between the two surfaces before: 16 or 17 at 60 and 1000 a second, the rates of both
/// papers. It is a delay of a whole frame of the sand. Printed, F_old is F before the update; where the last frame was
/// short that jumps by what it had left to go, so that only `literal` starts there and otherwise F_old is what was sent
/// last.
class Interpolation {
public:
    /// Returns the response of this tick. Call it once per tick. `next` is read only if `replaced` or `forget` is true.
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
