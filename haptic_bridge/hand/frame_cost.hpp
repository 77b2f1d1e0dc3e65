// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "base/field_forms.hpp"

namespace haptic_bridge {

/// Work of a frame's steps, and the wall time that it took on the slowest host (master::costOf).
struct FrameCost {
    std::int64_t sweeps = 0, substeps = 0, phases = 0;  // as in sand::StepWork
    std::int64_t sweepNs = 0;                           // [ns], of all sweeps
    std::int64_t dragNs = 0;                            // [ns], of all movements and edits
    std::int64_t phaseNs = 0;                           // [ns], of all coarse phases
    std::int64_t hashNs = 0;                            // [ns], of the hash and the audit
    std::int64_t drawNs = 0;                            // [ns], of the drawing

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        constexpr std::int64_t kMost = std::int64_t{1} << 48;  // so that no sum overflows
        visit("sweeps", base::limited(it.sweeps, 0, kMost));
        visit("substeps", base::limited(it.substeps, 0, kMost));
        visit("phases", base::limited(it.phases, 0, kMost));
        visit("sweep_ns", base::limited(it.sweepNs, 0, kMost));
        visit("drag_ns", base::limited(it.dragNs, 0, kMost));
        visit("phase_ns", base::limited(it.phaseNs, 0, kMost));
        visit("hash_ns", base::limited(it.hashNs, 0, kMost));
        visit("draw_ns", base::limited(it.drawNs, 0, kMost));
    }
    friend bool operator==(const FrameCost&, const FrameCost&) = default;
};

}  // namespace haptic_bridge
