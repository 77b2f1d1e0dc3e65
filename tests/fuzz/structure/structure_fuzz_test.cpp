// SPDX-License-Identifier: Apache-2.0
// Fuzzes states and journals by their structure: changes some of their numbers, and then makes lengths, compression and
// checksums right. An accepted input must be sand like any other: no step loses any of it, and the work of a step is
// bounded. scripts/checks/fuzz_structure.sh tries many more.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "base/input_error.hpp"
#include "journal/memory_parts.hpp"
#include "journal/reader.hpp"
#include "journal/recording.hpp"
#include "tests/fuzz/structure/journals.hpp"
#include "tests/fuzz/structure/states.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/seed.hpp"

namespace {

using namespace structure;
using sand::Replica;
using sand::Step;

std::uint64_t numberOf(const char* name, std::uint64_t usual) {
    const char* const given = std::getenv(name);
    return given == nullptr ? usual : std::strtoull(given, nullptr, 10);
}

/// Tries each input of this part of a run: SANDWALL_FUZZ_COUNT inputs from SANDWALL_FUZZ_FIRST on. `trial` returns
/// whether the input was accepted. A failure names the input.
template <class Trial>
void tryAll(const char* what, std::uint64_t usual, const Trial& trial) {
    const std::uint64_t first = numberOf("SANDWALL_FUZZ_FIRST", 0), count = numberOf("SANDWALL_FUZZ_COUNT", usual);
    const unsigned seed = test::randomSeed();
    std::uint64_t accepted = 0;
    for (std::uint64_t input = first; input < first + count; ++input) {
        Chance chance(seed, input);
        try {
            accepted += trial(chance) ? 1 : 0;
        } catch (const std::exception& error) {
            FAIL() << error.what() << "; run again with SANDWALL_SEED=" << seed << " SANDWALL_FUZZ_FIRST=" << input
                   << " SANDWALL_FUZZ_COUNT=1";
        }
    }
    fmt::print("{}: {} inputs from {} on, {} accepted; SANDWALL_SEED={}\n", what, count, first, accepted, seed);
    EXPECT_TRUE(accepted > 0 || count < 100) << "all inputs were refused";
    EXPECT_TRUE(accepted < count || count < 100) << "no input was refused";
}

TEST(StructureFuzz, AnAcceptedStateKeepsItsSand) {
    std::vector<Replica> replicas;
    for (const Session& session : sessions()) {
        replicas.emplace_back(session.scene);
    }
    tryAll("states", samples::kSlowBuild ? 1500 : 6000, [&](Chance& chance) {
        const std::size_t kind = chance.below(replicas.size());
        const Session& session = sessions()[kind];
        Replica& sand = replicas[kind];
        const std::uint64_t before = sand.stateHash();
        try {
            sand.decodeState(changedState(session, chance));
        } catch (const base::FormatError& refused) {
            require(sand.stateHash() == before, "a refused state has changed the replica");
            require(std::string_view(refused.what()).find('\n') == std::string_view::npos, "two lines");
            return false;
        }
        for (std::size_t steps = 1 + chance.below(4); steps > 0; --steps) {
            applyAndCheck(sand, shortStep(sand, chance));
        }
        const base::Bytes state = sand.encodeState();
        const std::uint64_t hash = sand.stateHash();
        sand.decodeState(state);  // throws if a state that can be reached is refused
        require(sand.stateHash() == hash, "a decoded state differs");
        return true;
    });
}

/// Reads the journal, and applies its steps in their order. Returns whether a step was applied.
bool play(std::vector<base::Bytes> parts) {
    std::optional<Replica> sand;
    bool applied = false;
    try {
        journal::JournalReader reader(std::make_unique<journal::MemoryParts>("JOURNAL", std::move(parts)), "1.2.3");
        sand.emplace(scene::Scene::decode(reader.header().scene));
        while (const auto record = reader.next()) {
            const auto* const frame = std::get_if<journal::JournalFrame>(&*record);
            for (std::size_t i = 0; frame != nullptr && i < frame->steps.size(); ++i) {
                if (frame->steps[i].number != sand->stepNumber() + 1) {
                    return applied;
                }
                applyAndCheck(*sand, frame->steps[i]);
                applied = true;
            }
        }
    } catch (const base::InputError& refused) {
        require(std::string_view(refused.what()).find('\n') == std::string_view::npos, "two lines");
    } catch (const base::FormatError&) {
    }
    return applied;
}

TEST(StructureFuzz, AnAcceptedJournalKeepsItsSand) {
    tryAll("journals", samples::kSlowBuild ? 300 : 1500, [&](Chance& chance) {
        const Session& session = sessions()[chance.below(sessions().size())];
        return play(changedJournal(session, chance));
    });
}

}  // namespace
