// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/keystroke.hpp"
#include "host/clock.hpp"
#include "master/operator/window_desk.hpp"
#include "tests/master/operator/operator_desk_fixture.hpp"

namespace test {

using base::Keystroke;

constexpr Keystroke plain(char key) { return {static_cast<std::uint16_t>(key), 0, 0}; }
constexpr Keystroke control(char key) { return {static_cast<std::uint16_t>(key), Keystroke::kControl, 0}; }
inline constexpr Keystroke kShiftR{'r', Keystroke::kShift, 0};

/// The windows of a desk.
class WindowDeskTest : public OperatorDeskTest {
protected:
    using OperatorDeskTest::OperatorDeskTest;
    void openForPointer() {
        master::DeskOptions options;
        options.pointer = true;
        open(&force_, options);
    }
    /// Presses a key in the window of rank 1.
    void press(Keystroke key) {
        std::vector<lockstep::Arrival> arrivals(2);
        arrivals[1].key = key;
        desk_->obey(arrivals);
    }
    /// Returns the answer that the windows of a rank show.
    [[nodiscard]] std::string answerIn(int rank) {
        for (const lockstep::Answer& answer : desk_->windows().answers(host::monotonicNs())) {
            if (answer.rank == rank) {
                return answer.text;
            }
        }
        return {};
    }
    /// Returns the radius of the tool that was asked for last [1/256 cell].
    [[nodiscard]] int radiusAsked() { return edits().back().tuning.tool.radius; }
    /// Applies two steps with a stroke, so that there is one to undo.
    void stroke() {
        std::vector<ArrivedStep> steps(2);
        for (ArrivedStep& timed : steps) {
            timed.step.number = sand_.replica().stepNumber() + 1 + static_cast<std::uint64_t>(&timed - steps.data());
            timed.step.engaged = &timed != steps.data();
            timed.step.path = {sand::probePoint(16, 12, 0)};
        }
        sand_.apply(1, steps, 0, source_);
    }
};

}  // namespace test
