// SPDX-License-Identifier: Apache-2.0
#include "master/drills/injection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <csignal>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "base/input_error.hpp"

namespace master {
namespace {

constexpr std::uint64_t kMostMilliseconds = 10'000;   // [ms], of slow drawing
constexpr std::uint64_t kLongestPartition = 600'000;  // [ms]
constexpr std::uint64_t kMostSignal = 31;
// A process ignores the first four signals. The others only stop it, which hang does.
constexpr std::array<std::uint64_t, 8> kHarmless{SIGCHLD, SIGCONT, SIGURG,  SIGWINCH,
                                                 SIGSTOP, SIGTSTP, SIGTTIN, SIGTTOU};
constexpr std::uint64_t kHighestBit = 27;  // heights are below 2^28
constexpr std::uint64_t kMostFrames = std::numeric_limits<std::uint64_t>::max();

using Kind = lockstep::Fault::Kind;

/// Form of each kind of fault, in the order of Kind.
constexpr std::array<std::string_view, valuesOf(Kind{}).size()> kUsage{"slow:rank=R,ms=MS[,frame=FIRST][,frames=COUNT]",
                                                                       "diverge:rank=R,frame=F[,column=C,row=W,bit=B]",
                                                                       "movement:rank=R,frame=F[,column=C,row=W]",
                                                                       "die:rank=R,frame=F[,signal=S]",
                                                                       "hang:rank=R,frame=F",
                                                                       "garbage:frame=F[,rank=R]",
                                                                       "partition:ms=MS,frame=F[,rank=R]",
                                                                       "view:rank=R,frame=F",
                                                                       "shader:rank=R"};

/// A number that a kind of fault takes, with its range and the variable for it.
struct Key {
    std::string_view name;
    std::uint64_t least, most;
    std::uint64_t* value;
    bool needed = true;
    bool given = false;
};

void readNumber(std::string_view pair, std::span<Key> keys, const std::string& text, std::string_view usage) {
    const std::size_t equals = pair.find('=');
    for (Key& key : keys) {
        if (equals == std::string_view::npos || pair.substr(0, equals) != key.name || key.given) {
            continue;
        }
        const std::string_view digits = pair.substr(equals + 1);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), *key.value);
        if (error != std::errc() || end != digits.data() + digits.size() || *key.value < key.least ||
            *key.value > key.most) {
            const std::string most = key.most == kMostFrames ? fmt::format("a whole number from {}", key.least)
                                                             : fmt::format("{} to {}", key.least, key.most);
            throw base::InputError(fmt::format("--inject {}: {} must be {}, got '{}'", text, key.name, most, digits));
        }
        key.given = true;
        return;
    }
    throw base::InputError(fmt::format("--inject {}: '{}' is not understood; write {}", text, pair, usage));
}

/// Reads KEY=NUMBER,KEY=NUMBER,… into the values of the keys.
void readNumbers(std::string_view pairs, std::span<Key> keys, const std::string& text, std::string_view usage) {
    while (!pairs.empty()) {
        const std::size_t comma = pairs.find(',');
        readNumber(pairs.substr(0, comma), keys, text, usage);
        pairs = comma == std::string_view::npos ? std::string_view() : pairs.substr(comma + 1);
    }
    for (const Key& key : keys) {
        if (key.needed && !key.given) {
            throw base::InputError(fmt::format("--inject {}: {} is missing; write {}", text, key.name, usage));
        }
    }
}

Kind kindOf(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::optional<Kind> kind = base::valueNamed<Kind>(std::string_view(text).substr(0, colon));
    if (!kind || colon == std::string::npos) {
        throw base::InputError(fmt::format("--inject {}: no such fault; write {}", text, fmt::join(kUsage, ", or ")));
    }
    return *kind;
}

}  // namespace

lockstep::Fault parseFault(const std::string& text, const FaultTargets& targets) {
    lockstep::Fault fault;
    fault.kind = kindOf(text);
    const auto ranks = static_cast<std::uint64_t>(targets.ranks);
    const auto last = [](int count) { return static_cast<std::uint64_t>(count) - 1; };
    std::uint64_t rank = 0, milliseconds = 0, signal = static_cast<std::uint64_t>(fault.signal), column = 0, row = 0,
                  bit = 0;
    const Key frame{"frame", 1, kMostFrames, &fault.frame};
    const Key ofAll{"rank", 0, ranks, &rank};
    std::vector<Key> keys;
    switch (fault.kind) {
        case Kind::slow:
            keys = {{"rank", 1, ranks, &rank},
                    {"ms", 1, kMostMilliseconds, &milliseconds},
                    {"frame", 1, kMostFrames, &fault.frame, false},
                    {"frames", 1, kMostFrames, &fault.frames, false}};
            break;
        case Kind::diverge:
            keys = {ofAll,
                    frame,
                    {"column", 0, last(targets.columns), &column, false},
                    {"row", 0, last(targets.rows), &row, false},
                    {"bit", 0, kHighestBit, &bit, false}};
            break;
        case Kind::movement:
            keys = {ofAll,
                    frame,
                    {"column", 0, last(targets.columns), &column, false},
                    {"row", 0, last(targets.rows), &row, false}};
            break;
        case Kind::die:
            keys = {ofAll, frame, {"signal", 1, kMostSignal, &signal, false}};
            break;
        case Kind::hang:
            keys = {ofAll, frame};
            break;
        case Kind::view:
            keys = {{"rank", 1, ranks, &rank}, frame};
            break;
        case Kind::shader:
            keys = {{"rank", 1, ranks, &rank}};
            fault.frame = 0;  // before the first frame
            break;
        case Kind::garbage:
            keys = {{"rank", 1, ranks, &rank, false}, frame};
            break;
        case Kind::partition:
            keys = {{"rank", 1, ranks, &rank, false}, frame, {"ms", 1, kLongestPartition, &milliseconds}};
            break;
    }
    readNumbers(std::string_view(text).substr(text.find(':') + 1), keys, text,
                kUsage.at(static_cast<std::size_t>(fault.kind)));
    fault.rank = keys.front().given ? static_cast<int>(rank) : lockstep::Fault::kLink;
    if (fault.rank == lockstep::Fault::kLink && !targets.link) {
        throw base::InputError(
            fmt::format("--inject {}: without a rank the fault is for the link to a haptic server, but --haptic names "
                        "no server; add rank=R",
                        text));
    }
    if (fault.kind == Kind::movement && !targets.movement) {
        throw base::InputError(fmt::format("--inject {}: a TIN records no movement; take a scene with a grid", text));
    }
    if (std::find(kHarmless.begin(), kHarmless.end(), signal) != kHarmless.end()) {
        throw base::InputError(
            fmt::format("--inject {}: signal {} ends no process; write one that does, such as 9 or 11", text, signal));
    }
    fault.milliseconds = static_cast<std::uint32_t>(milliseconds);
    fault.signal = static_cast<int>(signal);
    fault.column = static_cast<int>(column);
    fault.row = static_cast<int>(row);
    fault.bit = static_cast<int>(bit);
    return fault;
}

}  // namespace master
