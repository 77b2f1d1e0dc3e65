// SPDX-License-Identifier: Apache-2.0
#include "tests/hostile/frames.hpp"

#include <limits>

#include "tests/support/sand/sand_samples.hpp"

namespace hostile {

using namespace haptic_bridge;

Frames::Frames(std::uint32_t seed, Identity identity) : random_(seed), identity_(std::move(identity)) {
    sand::Step step{.epoch = 1, .number = 7, .engaged = true, .path = {{600, 700, 100}, {700, 650, 50}}};
    step.sweeps = 8;
    sand::Step loaded = step;
    loaded.edit = sand::Edit::loaded(base::Bytes(300, 9));
    for (const Message& message :
         std::vector<Message>{Hello{identity_, Role::move, true, false, {1}},
                              Hello{identity_, Role::watch, false, false, {}},
                              Challenge{identity_, {2}},
                              Proof{{3}},
                              Welcome{identity_, 60},
                              Refusal{RefusalCode::scene, "no"},
                              StartMessage{1, 0, 3},
                              Ready{},
                              NeedState{},
                              State{base::Bytes(200, 4)},
                              StepMessage{1, 2, step},
                              StepMessage{1, 2, loaded},
                              TimingTest{1, 20},
                              Shown{7, 16'000'000, Held::disk},
                              TimingEcho{1},
                              Ping{5},
                              Pong{5, 6},
                              Report{},
                              Bye{"enough"},
                              EditRequest{samples::withNumber(1, sand::Edit::undo)},
                              EditRequest{samples::withNumber(2, sand::Edit::loaded({1, 2, 3}))},
                              ForceShare{0},
                              TickPiece{base::Bytes(50, 1)},
                              PositionGreeting{kProtocolVersion, "glove"},
                              Position{0, 0, 0, 0, true},
                              CatchUp{true, {step, step}},
                              Loading{300, {8}}}) {
        real_.push_back(encode(message));
    }
    last_ = real_.front();
}

base::Bytes Frames::randomBytes() {
    base::Bytes bytes(1 + below(300));
    for (std::uint8_t& byte : bytes) {
        byte = static_cast<std::uint8_t>(below(256));
    }
    return bytes;
}

base::Bytes Frames::changed() {
    base::Bytes bytes = real_[below(static_cast<std::uint32_t>(real_.size()))];
    for (std::uint32_t flips = 1 + below(4); flips > 0; --flips) {
        bytes[below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<std::uint8_t>(below(256));
    }
    return bytes;
}

base::Bytes Frames::lying() {
    base::Bytes bytes = real_[below(static_cast<std::uint32_t>(real_.size()))];
    constexpr std::array<std::uint32_t, 6> kLengths{0, 1025, 64 * 1024 + 1, 1U << 28, 1U << 31, 0xffffffff};
    const std::uint32_t length = kLengths[below(kLengths.size())];
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[i] = static_cast<std::uint8_t>(length >> (8 * i));
    }
    return bytes;
}

base::Bytes Frames::next() {
    switch (below(5)) {
        case 0:
            last_ = randomBytes();
            break;
        case 1:
            last_ = changed();
            break;
        case 2:
            last_ = lying();
            break;
        case 3:
            break;  // the last message again
        default:
            last_ = real_[below(static_cast<std::uint32_t>(real_.size()))];
    }
    return last_;
}

base::Bytes Frames::position() {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN(), kFar = 1e308;
    const std::array<double, 5> values{0, 0.5, kNone, kFar, -kFar};
    const auto any = [&] { return values[below(values.size())]; };
    time_ += static_cast<std::int64_t>(below(2'000'000)) - 500'000;  // backwards at times
    return encode(Position{time_, any(), any(), any(), below(2) == 0});
}

}  // namespace hostile
