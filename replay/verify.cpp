// SPDX-License-Identifier: Apache-2.0
#include "replay/verify.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>

#include "host/print_line.hpp"
#include "journal/verification.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/resume.hpp"

namespace replay {
namespace {

class JournalCheck {
public:
    explicit JournalCheck(const std::filesystem::path& journal)
        : journal_(journal),
          reader_(master::openJournal(journal)),
          start_(journal::sceneOf(reader_)),
          verification_(journal.string(), start_) {
        for (const std::uint64_t step : master::checkpointsOf(journal)) {
            checkpoints_.emplace(step, std::string());
        }
    }

    int run() {
        compareCheckpoint(start_);
        while (const auto record = reader_.next()) {
            const bool differed = differs();
            verification_.take(*record, [this](sand::Replica& replica) { compareCheckpoint(replica); });
            if (differs() && !differed) {
                const auto& first = *verification_.counts().firstDifference;
                host::printLine("after step {}: the session had {:016x}, the replay has {:016x}", first.recorded.step,
                                first.recorded.hash, first.replayed);
            }
        }
        say();
        return differs() || badCheckpoints_ > 0 ? 1 : 0;
    }

private:
    [[nodiscard]] bool differs() const { return verification_.counts().differing > 0; }
    void compareCheckpoint(sand::Replica& replica) {
        const auto found = checkpoints_.find(replica.stepNumber());
        if (found == checkpoints_.end()) {
            return;
        }
        try {
            sand::Replica sand = start_;
            master::replaceByCheckpoint(master::checkpointFile(journal_, found->first), reader_.header(), sand);
            found->second =
                sand.stateHash() == replica.stateHash() ? "the replay's sand" : "differs from the replay's sand";
        } catch (const base::FormatError& error) {
            found->second = error.what();
        }
        badCheckpoints_ += found->second == "the replay's sand" ? 0 : 1;
    }
    void say() {
        const journal::FileOrigin& origin = reader_.header().origin;
        const journal::Verification::Counts& counts = verification_.counts();
        sand::Replica& replica = verification_.replica();
        fmt::print("origin       sandwall {}, journal format {}, algorithm {}\n", origin.release, origin.format,
                   origin.algorithm);
        fmt::print("records      {} whole, {} bytes\n", counts.records, reader_.wholeBytes());
        fmt::print("chain        whole: every checksum continues from the one before\n");
        fmt::print("parts        {}\n", reader_.parts());
        fmt::print("tail         {}\n", reader_.tornBytes() == 0
                                            ? std::string("whole")
                                            : fmt::format("{} bytes of an incomplete write", reader_.tornBytes()));
        fmt::print("steps        {} without a gap, in frames {} to {}, epochs to {}, {} pieces of ticks\n",
                   replica.stepNumber(), counts.firstFrame, counts.lastFrame, counts.lastEpoch, counts.ticks);
        fmt::print("left out     {} steps{}{}\n", counts.leftOut, counts.leftOut > 0 ? ", the first is " : "",
                   counts.firstLeftOut);
        fmt::print("hashes       {} of {} equal to the replay's\n", counts.hashes - counts.differing, counts.hashes);
        fmt::print("majorities   {} decided which sand is right, {} of them against the journal\n", counts.doubts,
                   counts.outvoted);
        for (const auto& [step, found] : checkpoints_) {
            fmt::print("checkpoint   of step {}: {}\n", step, found.empty() ? "beyond the journal's end" : found);
        }
        fmt::print("resumed      {} times, {} bytes were cut off\n", counts.resumes, counts.cutBytes);
        fmt::print("end          {}, at step {}, state hash {:016x}\n", counts.end ? "orderly" : "cut off",
                   replica.stepNumber(), replica.stateHash());
    }

    std::filesystem::path journal_;
    journal::JournalReader reader_;
    sand::Replica start_;
    journal::Verification verification_;
    std::map<std::uint64_t, std::string> checkpoints_;  // by step: the result for each
    std::uint64_t badCheckpoints_ = 0;
};

}  // namespace

int verifyJournal(const std::filesystem::path& journal) { return JournalCheck(journal).run(); }

}  // namespace replay
