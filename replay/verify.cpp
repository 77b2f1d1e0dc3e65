// SPDX-License-Identifier: Apache-2.0
#include "replay/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "base/input_error.hpp"
#include "host/print_line.hpp"
#include "master/journal/checkpoint.hpp"
#include "master/journal/journal.hpp"
#include "master/journal/resume.hpp"

namespace replay {
namespace {

class Verification {
public:
    explicit Verification(const std::filesystem::path& journal)
        : journal_(journal), reader_(journal), start_(master::sceneOf(reader_)), replica_(start_) {
        for (const std::uint64_t step : master::checkpointsOf(journal)) {
            checkpoints_.emplace(step, std::string());
        }
    }

    int run() {
        compareCheckpoint();
        while (const auto record = reader_.next()) {
            ++records_;
            std::visit(*this, *record);
        }
        say();
        return differing_ == 0 && badCheckpoints_ == 0 ? 0 : 1;
    }

    void operator()(const master::JournalFrame& frame) {
        firstFrame_ = firstFrame_ == 0 ? frame.frame : firstFrame_;
        lastFrame_ = std::max(lastFrame_, frame.frame);
        end_.reset();
        if (!frame.steps.empty() && !frame.doubted) {
            compare({frame.steps.front().number - 1, frame.hashBefore});
        }
        for (const sand::Step& step : frame.steps) {
            if (step.number != replica_.stepNumber() + 1) {
                throw base::InputError(fmt::format("{}: step {} follows step {}; a part of the session is missing",
                                                   journal_.string(), step.number, replica_.stepNumber()));
            }
            lastEpoch_ = std::max(lastEpoch_, step.epoch);
            replica_.apply(step);
            if (!replica_.leftOut().empty() && leftOut_++ == 0) {
                firstLeftOut_ = fmt::format(", the first is step {}: {}", step.number, replica_.leftOut());
            }
            compareCheckpoint();
        }
    }
    void operator()(const master::JournalEnd& end) {
        end_ = end;
        compare(end);
    }
    void operator()(const master::JournalResumed& resumed) {
        ++resumes_;
        cutBytes_ += resumed.cutBytes;
        end_.reset();
        compare(resumed.sand);
    }
    void operator()(const master::JournalTicks&) { ++ticks_; }
    void operator()(const scene::Material&) {}
    void operator()(const master::JournalContinued&) {}
    void operator()(const master::JournalDoubt& doubt) {
        ++doubts_;
        // Later steps of the majority's sand are not in the journal, so only this hash can be compared.
        outvoted_ += doubt.sand.step == replica_.stepNumber() && doubt.sand.hash != replica_.stateHash() ? 1 : 0;
    }
    void operator()(const master::JournalChecked& checked) { compare(checked.sand); }
    void operator()(const master::JournalForce&) {}

private:
    void compare(const master::JournalEnd& recorded) {
        ++hashes_;
        if (recorded.step == replica_.stepNumber() && recorded.hash == replica_.stateHash()) {
            return;
        }
        if (differing_++ == 0) {
            host::printLine("after step {}: the session had {:016x}, the replay has {:016x}", recorded.step,
                            recorded.hash, replica_.stateHash());
        }
    }
    void compareCheckpoint() {
        const auto found = checkpoints_.find(replica_.stepNumber());
        if (found == checkpoints_.end()) {
            return;
        }
        try {
            sand::Replica sand =
                master::sandOfCheckpoint(master::checkpointFile(journal_, found->first), reader_.header(), start_);
            found->second =
                sand.stateHash() == replica_.stateHash() ? "the replay's sand" : "differs from the replay's sand";
        } catch (const base::FormatError& error) {
            found->second = error.what();
        }
        badCheckpoints_ += found->second == "the replay's sand" ? 0 : 1;
    }
    void say() {
        const master::FileOrigin& origin = reader_.header().origin;
        fmt::print("origin       sandwall {}, journal format {}, algorithm {}\n", origin.release, origin.format,
                   origin.algorithm);
        fmt::print("records      {} whole, {} bytes\n", records_, reader_.wholeBytes());
        fmt::print("chain        whole: every checksum continues from the one before\n");
        fmt::print("parts        {}\n", reader_.parts());
        fmt::print("tail         {}\n", reader_.tornBytes() == 0
                                            ? std::string("whole")
                                            : fmt::format("{} bytes of an incomplete write", reader_.tornBytes()));
        fmt::print("steps        {} without a gap, in frames {} to {}, epochs to {}, {} pieces of ticks\n",
                   replica_.stepNumber(), firstFrame_, lastFrame_, lastEpoch_, ticks_);
        fmt::print("left out     {} steps{}\n", leftOut_, firstLeftOut_);
        fmt::print("hashes       {} of {} equal to the replay's\n", hashes_ - differing_, hashes_);
        fmt::print("majorities   {} decided which sand is right, {} of them against the journal\n", doubts_, outvoted_);
        for (const auto& [step, found] : checkpoints_) {
            fmt::print("checkpoint   of step {}: {}\n", step, found.empty() ? "beyond the journal's end" : found);
        }
        fmt::print("resumed      {} times, {} bytes were cut off\n", resumes_, cutBytes_);
        fmt::print("end          {}, at step {}, state hash {:016x}\n", end_ ? "orderly" : "cut off",
                   replica_.stepNumber(), replica_.stateHash());
    }

    std::filesystem::path journal_;
    master::JournalReader reader_;
    sand::Replica start_, replica_;
    std::map<std::uint64_t, std::string> checkpoints_;  // by step: the result for each
    std::uint64_t records_ = 0, ticks_ = 0, hashes_ = 0, differing_ = 0, badCheckpoints_ = 0, resumes_ = 0;
    std::uint64_t doubts_ = 0, outvoted_ = 0;
    std::uint64_t firstFrame_ = 0, lastFrame_ = 0;
    std::uint32_t lastEpoch_ = 0;
    std::uint64_t leftOut_ = 0;  // steps
    std::string firstLeftOut_;
    std::int64_t cutBytes_ = 0;
    std::optional<master::JournalEnd> end_;
};

}  // namespace

int verifyJournal(const std::filesystem::path& journal) { return Verification(journal).run(); }

}  // namespace replay
