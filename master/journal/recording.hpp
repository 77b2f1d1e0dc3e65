// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "master/journal/journal.hpp"
#include "scene/scene.hpp"

namespace master {

/// A session that has been, cut into frames of another rate: frame n shows every step up to
/// floor(n * steps per second / frames per second), and the last one all that are left. Immutable: safe from any
/// thread.
class Recording {
public:
    /// Throws base::InputError, with `file` in it, when the journal holds no steps or one of them is missing.
    Recording(Journal journal, std::string file, int framesPerSecond);

    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] int framesPerSecond() const { return framesPerSecond_; }
    [[nodiscard]] std::uint64_t lastStep() const { return steps_.size(); }
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    /// The steps that frame `frame`, from 1, shows and the one before did not.
    [[nodiscard]] std::span<const sand::Step> stepsOf(std::uint64_t frame) const;
    /// The state hash that the session had after this step (0: at its start); it wrote one for every frame, and one at
    /// its end.
    [[nodiscard]] std::optional<std::uint64_t> hashAfter(std::uint64_t step) const;
    /// What the user should know, in one line; empty for a session that is whole.
    [[nodiscard]] const std::string& shortcoming() const { return shortcoming_; }

private:
    [[nodiscard]] std::uint64_t stepsUntil(std::uint64_t frame) const;

    scene::Scene scene_;
    int framesPerSecond_;
    std::vector<sand::Step> steps_;                  // number n at n - 1
    std::map<std::uint64_t, std::uint64_t> hashes_;  // by the step they were written after
    std::uint64_t frames_;
    std::string shortcoming_;
};

}  // namespace master
