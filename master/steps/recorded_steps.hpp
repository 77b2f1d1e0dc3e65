// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "journal/recording.hpp"
#include "master/steps/step_source.hpp"

namespace master {

/// The steps of a recording. Compares the sand with the hashes in the recording. Used by one thread.
class RecordedSteps : public StepSource {
public:
    /// Returns no steps after step `last`.
    RecordedSteps(std::shared_ptr<const journal::Recording> recording, std::uint64_t last);

    /// Returns the steps that the recording has for the next frame. Ignores `most`.
    [[nodiscard]] ArrivedSteps next(const sand::Replica& sand, std::uint64_t hash, std::size_t most) override;
    [[nodiscard]] std::size_t mostPerFrame() const override { return static_cast<std::size_t>(-1); }
    void reached(sand::Replica& sand) override;
    void healed(sand::Replica& sand) override;
    [[nodiscard]] bool strayed() const override { return strayed_; }
    [[nodiscard]] std::string takeStrayLine() override;
    [[nodiscard]] const char* hand() const override { return "recorded"; }

private:
    std::shared_ptr<const journal::Recording> recording_;
    std::uint64_t last_;
    std::uint64_t frame_ = 0;
    bool strayed_ = false;
    std::string line_;  // not printed yet, because the master's own memory may be wrong and may be healed
};

}  // namespace master
