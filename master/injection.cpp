// SPDX-License-Identifier: Apache-2.0
#include "master/injection.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <limits>
#include <span>
#include <string_view>

#include "files/input_error.hpp"

namespace master {
namespace {

constexpr std::string_view kInjections = "slow:rank=R,ms=MS[,frame=FIRST][,frames=COUNT]";
constexpr std::uint64_t kMostMilliseconds = 10'000;
constexpr std::uint64_t kMostFrames = std::numeric_limits<std::uint64_t>::max();

/// A number that a kind of fault takes.
struct Key {
    std::string_view name;
    std::uint64_t most;  // 1 is the least of every one
    std::uint64_t* value;
    bool needed = true;
    bool given = false;
};

void readNumber(std::string_view pair, std::span<Key> keys, const std::string& text) {
    const std::size_t equals = pair.find('=');
    for (Key& key : keys) {
        if (equals == std::string_view::npos || pair.substr(0, equals) != key.name || key.given) {
            continue;
        }
        const std::string_view digits = pair.substr(equals + 1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), *key.value);
        if (error != std::errc() || end != digits.data() + digits.size() || *key.value < 1 || *key.value > key.most) {
            const std::string most =
                key.most == kMostFrames ? "a whole number from 1" : fmt::format("1 to {}", key.most);
            throw files::InputError(fmt::format("--inject {}: {} must be {}, got '{}'", text, key.name, most, digits));
        }
        key.given = true;
        return;
    }
    throw files::InputError(fmt::format("--inject {}: '{}' is not understood; write {}", text, pair, kInjections));
}

/// Reads KEY=NUMBER,KEY=NUMBER,… into the values of the keys.
void readNumbers(std::string_view pairs, std::span<Key> keys, const std::string& text) {
    while (!pairs.empty()) {
        const std::size_t comma = pairs.find(',');
        readNumber(pairs.substr(0, comma), keys, text);
        pairs = comma == std::string_view::npos ? std::string_view() : pairs.substr(comma + 1);
    }
    for (const Key& key : keys) {
        if (key.needed && !key.given) {
            throw files::InputError(fmt::format("--inject {}: {} is missing; write {}", text, key.name, kInjections));
        }
    }
}

lockstep::SlowDrawing readSlow(std::string_view pairs, int ranks, const std::string& text) {
    lockstep::SlowDrawing slow;
    std::uint64_t rank = 0, milliseconds = 0;
    std::array<Key, 4> keys{{{"rank", static_cast<std::uint64_t>(ranks), &rank},
                             {"ms", kMostMilliseconds, &milliseconds},
                             {"frame", kMostFrames, &slow.frame, false},
                             {"frames", kMostFrames, &slow.frames, false}}};
    readNumbers(pairs, keys, text);
    slow.rank = static_cast<int>(rank);
    slow.milliseconds = static_cast<std::uint32_t>(milliseconds);
    return slow;
}

}  // namespace

void inject(const std::string& text, int ranks, lockstep::SessionMessage& message) {
    const std::size_t colon = text.find(':');
    if (text.substr(0, colon) != "slow" || colon == std::string::npos) {
        throw files::InputError(fmt::format("--inject {}: no such fault; write {}", text, kInjections));
    }
    message.slow.push_back(readSlow(std::string_view(text).substr(colon + 1), ranks, text));
}

}  // namespace master
