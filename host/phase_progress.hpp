// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "host/clock.hpp"

namespace host {

/// Reports a long phase of a program's start: "reads the scene: 34 %". The first line comes after 2 s, and further ones
/// every 10 s. Each line has an event `phase` (docs/events.md). Shorter phases report nothing. Used by one thread.
class PhaseProgress {
public:
    using Clock = std::function<std::int64_t()>;  // [ns], monotonic

    /// `name` is the phase in events. `what` is the phase in words: "reads the scene". `print` prints a line for a
    /// person.
    PhaseProgress(std::string name, std::string what, std::function<void(const std::string&)> print,
                  Clock clock = monotonicNs);
    /// Notes the part of the work that is done, 0 to 1.
    void done(double share);

private:
    std::string name_, what_;
    std::function<void(const std::string&)> print_;
    Clock now_;
    std::int64_t dueNs_;  // time of the next line [ns]
};

}  // namespace host
