// SPDX-License-Identifier: Apache-2.0
#include "master/operator/answers.hpp"

#include <utility>

namespace master {
namespace {

/// Cuts a text to what a message holds, between two characters.
std::string cut(std::string text) {
    std::size_t length = text.size();
    if (length > lockstep::Answer::kLongest) {
        length = lockstep::Answer::kLongest;
        while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xc0U) == 0x80) {
            --length;
        }
    }
    text.resize(length);
    return text;
}

}  // namespace

void Answers::show(int rank, std::string text, std::int64_t nowNs, std::int64_t life) {
    if (!text.empty()) {
        shown_[rank] = {cut(std::move(text)), nowNs + life};
    }
}

std::vector<lockstep::Answer> Answers::at(std::int64_t nowNs) {
    std::erase_if(shown_, [&](const auto& entry) { return entry.second.until <= nowNs; });
    std::vector<lockstep::Answer> answers;
    for (const auto& [rank, shown] : shown_) {
        if (answers.size() < lockstep::kMostAnswers) {
            answers.push_back({rank, shown.text});
        }
    }
    return answers;
}

}  // namespace master
