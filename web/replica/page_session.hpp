// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "journal/reader.hpp"
#include "journal/verification.hpp"
#include "web/replica/step_source.hpp"

namespace web {

/// Something in a session that a timeline marks.
struct Mark {
    std::uint64_t step = 0;  // at which it begins
    std::string_view what;   // "stroke", "resumed", or the name of an edit
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("step", it.step);
        visit("what", it.what);
    }
};

/// A recorded session and its sand, as a page computes it. Used by one thread.
///
/// The first pass computes every step once, as sandwall-replay --verify does, and compares every hash. After it the
/// sand can be put back to a kept state, and be computed forwards from there. Hashes that are passed again are compared
/// again, and counted once.
class PageSession : public StepSource {
public:
    /// Reads all records of a journal. If it is damaged or cut off, the session has what is intact before. Throws
    /// base::InputError if nothing can be read, or if its sand needs more than `memory` bytes.
    PageSession(std::string name, std::vector<base::Bytes> parts, std::string_view release, std::int64_t memory);

    [[nodiscard]] const scene::Scene& scene() const override { return scene_; }
    [[nodiscard]] std::uint64_t lastStep() const { return lastStep_; }
    /// Returns a line about missing parts of the session; empty if it is whole.
    [[nodiscard]] const std::string& shortcoming() const override { return shortcoming_; }
    [[nodiscard]] const std::vector<Mark>& marks() const { return marks_; }
    /// Returns the number of hashes that the journal has for its steps.
    [[nodiscard]] std::uint64_t hashes() const { return hashes_; }

    /// Returns the humidity of the sand as the session's operators had set it at the present step, 0 to 1.
    [[nodiscard]] double humidity() const override;

    /// Takes the next record of the first pass. Returns false behind the last one.
    [[nodiscard]] bool advance();
    [[nodiscard]] std::uint64_t matches() const;
    [[nodiscard]] std::uint64_t mismatches() const;

    /// Returns the sand of the present step. Only after the first pass may it be put back by decodeState().
    [[nodiscard]] sand::Replica& replica() override { return verification_->replica(); }
    [[nodiscard]] const sand::Replica& replica() const { return verification_->replica(); }
    /// Applies the next step after the first pass, and compares the hashes that its frame has. Returns false behind the
    /// last step.
    [[nodiscard]] bool stepOn();

private:
    void read(journal::JournalReader& reader);
    void note(journal::JournalRecord& record);
    void noteSteps(const journal::JournalFrame& frame);
    void compareAgain(std::uint64_t hash);
    /// Returns whether the first pass has ended.
    [[nodiscard]] bool passed() const { return next_ == records_.size(); }
    /// Returns what the first pass has counted.
    [[nodiscard]] const journal::Verification::Counts& counts() const { return verification_->counts(); }

    std::string name_;
    scene::Scene scene_;
    std::string shortcoming_;
    std::vector<journal::JournalRecord> records_;
    std::size_t next_ = 0;  // record of the first pass
    struct FirstStep {
        std::uint64_t step;
        std::size_t record;
    };
    std::vector<FirstStep> frames_;  // frames with steps, in the order of their steps
    std::vector<Mark> marks_;
    std::map<std::uint64_t, double> humidity_;  // by the first step that has it
    std::optional<journal::Verification> verification_;
    std::vector<std::uint64_t> differedAgain_;  // steps whose hash was right in the first pass and differed later
    std::uint64_t lastStep_ = 0, hashes_ = 0;
    bool engaged_ = false;  // while reading
};

}  // namespace web
