// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "base/field_forms.hpp"
#include "sand/model/tuning.hpp"

namespace sand {

/// Consecutive sweeps of one step. Their inertia depends on their place in the step, and not on how the step is divided
/// into parts.
struct SweepPart {
    int sweeps = 0;      // to run now
    int first = 0;       // sweeps of the same step that ran earlier
    int whole = sweeps;  // sweeps of the whole step

    /// Returns all `sweeps` sweeps of a step.
    static constexpr SweepPart all(int sweeps) { return {sweeps, 0, sweeps}; }
};

/// Sweeps of the last step that has begun, as far as they have not run yet. Later steps pay them.
///
/// They are state of a replica, and no part of its sand: a snapshot does not contain them.
struct Owed {
    /// `whole` of a settle, which ends when all sand is at rest. No sand slides for so long.
    static constexpr std::int32_t kUntilRest = 1 << 30;

    std::int32_t whole = 0;  // sweeps of the whole step; 0 if nothing is owed
    std::int32_t done = 0;   // of these, sweeps that have run; below `whole` if anything is owed

    [[nodiscard]] std::int32_t left() const { return whole - done; }
    [[nodiscard]] bool any() const { return whole > 0; }
    [[nodiscard]] bool untilRest() const { return whole == kUntilRest; }
    /// Returns what is owed after `sweeps` more sweeps, which are at most left().
    [[nodiscard]] Owed after(std::int32_t sweeps) const {
        return sweeps < left() ? Owed{whole, done + sweeps} : Owed{};
    }

    [[nodiscard]] std::string refusal() const {
        const bool ofSome = whole <= kMostSweeps || untilRest();
        return ofSome && (done == 0 || done < whole) ? "" : "a step that owes more sweeps than a step has";
    }
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("owed by a step of", base::limited(it.whole, 0, kUntilRest));
        visit("sweeps done", base::limited(it.done, 0, kUntilRest));
    }
    friend bool operator==(const Owed&, const Owed&) = default;
};

}  // namespace sand
