// SPDX-License-Identifier: Apache-2.0
#include "journal/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/input_error.hpp"

namespace journal {
namespace {

std::string shortcomingOf(const Journal& journal, const std::string& file, std::uint64_t lastStep) {
    if (journal.tornBytes > 0) {
        return fmt::format("{}: the last {} bytes are an incomplete write and were left out; it ends at step {}", file,
                           journal.tornBytes, lastStep);
    }
    if (!journal.end) {
        return fmt::format("{}: has no orderly end, the session was cut off; it ends at step {}", file, lastStep);
    }
    return {};
}

}  // namespace

Recording::Recording(Journal journal, std::string file, int framesPerSecond, Span span)
    : scene_(std::move(journal.scene)), framesPerSecond_(framesPerSecond) {
    humidity_.emplace(0, scene_.material.humidity);
    auto material = journal.materials.begin();
    for (std::size_t i = 0; i < journal.frames.size(); ++i) {
        for (; material != journal.materials.end() && material->frame == i; ++material) {
            humidity_.insert_or_assign(steps_.size() + 1, material->material.humidity);
        }
        JournalFrame& frame = journal.frames[i];
        if (!frame.doubted) {
            hashes_.emplace(steps_.size(), frame.hashBefore);
        }
        for (sand::Step& step : frame.steps) {
            if (step.number != steps_.size() + 1) {
                throw base::InputError(fmt::format("{}: step {} follows step {}; a part of the session is missing",
                                                   file, step.number, steps_.size()));
            }
            steps_.push_back(std::move(step));
        }
    }
    if (steps_.empty()) {
        throw base::InputError(fmt::format("{}: the journal holds no steps, so it cannot be replayed", file));
    }
    if (journal.end) {
        if (journal.end->step != lastStep()) {
            throw base::InputError(fmt::format("{}: holds {} steps of a session that ended at step {}", file,
                                               lastStep(), journal.end->step));
        }
        hashes_.emplace(journal.end->step, journal.end->hash);
    }
    if (span.to == Span::kEnd) {
        shortcoming_ = shortcomingOf(journal, file, lastStep());
    }
    cutTo(span, file);
    const auto perSecond = static_cast<std::uint64_t>(scene_.rules.stepsPerSecond);
    framesBefore_ = (from_ + kLeadingSteps - 1) / kLeadingSteps;
    frames_ = framesBefore_ +
              ((lastStep() - from_) * static_cast<std::uint64_t>(framesPerSecond_) + perSecond - 1) / perSecond;
}

/// Leaves out the steps behind the span. A running session may write them already.
void Recording::cutTo(const Span& span, const std::string& file) {
    const std::uint64_t to = span.to == Span::kEnd ? lastStep() : span.to;
    if (to > lastStep() || span.from >= to) {
        throw base::InputError(
            fmt::format("{}: holds steps 1 to {}, and the film is to begin behind step {} and to end at step {}; "
                        "give --from a smaller step than --to, and --to a step of the session",
                        file, lastStep(), span.from, to));
    }
    steps_.resize(static_cast<std::size_t>(to));
    from_ = span.from;
}

std::uint64_t Recording::stepsUntil(std::uint64_t frame) const {
    if (frame <= framesBefore_) {
        return std::min(from_, frame * kLeadingSteps);
    }
    // Computed in whole numbers, so that a film of an hour loses no step to rounding.
    return std::min(lastStep(), from_ + (frame - framesBefore_) *
                                            static_cast<std::uint64_t>(scene_.rules.stepsPerSecond) /
                                            static_cast<std::uint64_t>(framesPerSecond_));
}

std::span<const sand::Step> Recording::stepsOf(std::uint64_t frame) const {
    const std::uint64_t from = stepsUntil(frame - 1);
    return std::span(steps_).subspan(from, stepsUntil(frame) - from);
}

double Recording::humidityOf(std::uint64_t frame) const {
    return std::prev(humidity_.upper_bound(stepsUntil(frame)))->second;
}

std::optional<std::uint64_t> Recording::hashAfter(std::uint64_t step) const {
    const auto found = hashes_.find(step);
    return found == hashes_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace journal
