// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "journal/journal.hpp"
#include "scene/model/scene.hpp"

namespace journal {

/// The steps of a session that a film shows: those behind step `from`, up to step `to`.
struct Span {
    static constexpr std::uint64_t kEnd = std::numeric_limits<std::uint64_t>::max();

    std::uint64_t from = 0;
    std::uint64_t to = kEnd;  // kEnd: the last step of the session
};

/// A recorded session, cut into frames of another rate. Frame n shows all steps up to floor(n * steps per second /
/// frames per second). The last frame shows all steps that are left. Immutable, so any thread may use it.
///
/// If a span begins later than the session, framesBefore() frames lead to its beginning, with kLeadingSteps steps in
/// each. The frames of the span follow, and steps count from its beginning.
class Recording {
public:
    static constexpr std::uint64_t kLeadingSteps = 60;

    /// Throws base::InputError, which names `file`, if the journal holds no steps, if a step is missing, or if `span`
    /// is empty or ends behind the last step.
    Recording(Journal journal, std::string file, int framesPerSecond, Span span = {});

    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] int framesPerSecond() const { return framesPerSecond_; }
    [[nodiscard]] std::uint64_t lastStep() const { return steps_.size(); }
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    /// Returns the number of frames that lead to the span. Frame framesBefore() + 1 is its first one.
    [[nodiscard]] std::uint64_t framesBefore() const { return framesBefore_; }
    /// Returns the steps that frame `frame` shows and the frame before did not. Frames count from 1.
    [[nodiscard]] std::span<const sand::Step> stepsOf(std::uint64_t frame) const;
    /// Returns the humidity of the sand in frame `frame`, 0 to 1, as the session's operators had set it.
    [[nodiscard]] double humidityOf(std::uint64_t frame) const;
    /// Returns the session's state hash after step `step`; 0 is its start. Returns nullopt if the journal has no hash
    /// for this step. It has one for every frame with steps, and one at its end.
    [[nodiscard]] std::optional<std::uint64_t> hashAfter(std::uint64_t step) const;
    /// Returns a line for the user about missing parts of the session; empty if the session is whole.
    [[nodiscard]] const std::string& shortcoming() const { return shortcoming_; }

private:
    void cutTo(const Span& span, const std::string& file);
    [[nodiscard]] std::uint64_t stepsUntil(std::uint64_t frame) const;

    scene::Scene scene_;
    int framesPerSecond_;
    std::vector<sand::Step> steps_;                  // number n at n - 1
    std::map<std::uint64_t, double> humidity_;       // by the first step that has it
    std::map<std::uint64_t, std::uint64_t> hashes_;  // by the step after which they were written
    std::uint64_t frames_ = 0, framesBefore_ = 0;
    std::uint64_t from_ = 0;  // step before the span
    std::string shortcoming_;
};

}  // namespace journal
