// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "haptic_bridge/link/protocol.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace haptic_bridge {

inline sand::Step someStep() { return {3, 77, true, {{100, -200, 300}, {101, -200, 299}, {110, 5, 299}}}; }

/// One message of each kind, with values that differ from all defaults.
inline std::vector<Message> oneOfEach() {
    const Identity identity{kProtocolVersion, sand::kAlgorithmVersion, 0x0123456789abcdefULL, "dunes"};
    Report report;
    report.hapticPeriodUsP50 = 1000.5;
    report.forceUsP99 = 2.25;
    report.toWall = {13.6, 9.8, 12, 40, 70};
    report.toMaster = {0.2, 0.1, 0.15, 1, 71};
    report.stepBytesMean = 84;
    report.steps = 9;
    report.stepsWithheld = {4, 3, 2, 1};
    report.samplesDropped = 1;
    report.ticksMissed = 3;
    report.guards.back() = 7;
    report.refused.back() = 6;
    report.handTicks = 5;
    report.feltTicks = 4;
    report.faultedTicks = 2;
    report.handSeconds = 1;
    report.asked.back() = 3;
    report.literal = true;
    report.deviceLosses = 3;
    report.deviceAway = true;
    report.audited = Audited::differed;
    return {Hello{identity, Role::watch, true, true, {1, 2}},
            Welcome{identity, 60, Role::watch, {3, 4}},
            Refusal{RefusalCode::busy, "busy"},
            StartMessage{2, 40, 99, {0.5, true}},
            Ready{0.25},
            NeedState{8, 9},
            State{{1, 2, 3}},
            StepMessage{-5, 17, someStep()},
            TimingTest{7, 50},
            Shown{41, 16'666'667, Held::pause},
            TimingEcho{7, Leg::shown},
            Ping{123},
            Pong{123, -9},
            report,
            Bye{"good night"},
            EditRequest{samples::withNumber(300, sand::Edit::undo)},
            ForceShare{0.25, true},
            TickPiece{{4, 5}},
            PositionGreeting{kProtocolVersion, "glove", {5}},
            Position{-7, 0.5, -0.25, 1.5, true},
            Challenge{identity, {6}},
            Proof{{7}},
            CatchUp{true, {someStep(), someStep()}},
            Loading{730, {1, 2, 3}}};
}

}  // namespace haptic_bridge
