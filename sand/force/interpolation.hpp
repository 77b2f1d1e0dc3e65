// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "sand/force/response.hpp"

namespace sand::force {

/// Equation 9 of Purchart et al. 2012, reconstructed from its prose: F_out = F_old + (F − F_old) min(it/itp, 1).
///
/// F is the law's response when the last surface arrived, and F_old its response when the surface before arrived. `it`
/// is the number of haptic frames since then, including this one. `itp` is the number of haptic frames between the
/// arrivals of the last two surfaces. At 60 and 1000 per second, the rates of both papers, it is 16 or 17. The
/// interpolation is a delay of a whole frame of the sand.
///
/// As printed, F_old is F before the update. After a short frame, the output has not yet reached this F, and jumps to
/// it. Only `literal` does that. Otherwise F_old is the response that was sent last.
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
