// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lockstep/frame_message.hpp"

namespace master {

/// Answers to keys and wheels that the windows show now. A window shows the latest one. Used by one thread.
class Answers {
public:
    static constexpr std::int64_t kLife = 2'000'000'000;       // [ns], for which an answer is shown
    static constexpr std::int64_t kHintLife = 10'000'000'000;  // [ns]
    static constexpr int kLowestRow = 0;                       // lockstep::Answer::rank of the hint

    /// Shows a text in the windows of `rank` from `nowNs` on, in place of the one before. A text that is longer than
    /// lockstep::Answer::kLongest is cut.
    void show(int rank, std::string text, std::int64_t nowNs, std::int64_t life = kLife);
    /// Returns the answers at `nowNs`, in the order of ranks. Forgets the ones that have ended.
    [[nodiscard]] std::vector<lockstep::Answer> at(std::int64_t nowNs);

private:
    struct Shown {
        std::string text;
        std::int64_t until = 0;  // [ns]
    };
    std::map<int, Shown> shown_;  // by rank
};

}  // namespace master
