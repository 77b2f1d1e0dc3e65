// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/fuzz/structure/chance.hpp"

/// Small live sessions, whose states and steps are changed.
namespace structure {

/// A scene, and replicas in the middle of a session on it.
struct Session {
    scene::Scene scene;
    std::vector<sand::Replica> states;
    std::vector<sand::Step> steps;  // of the whole session, from the first on
};

/// Returns sessions on small fields of all kinds: grids and TINs with either rim, with rock and walls, of one row and
/// of one cell. They are the same in every run.
[[nodiscard]] const std::vector<Session>& sessions();

/// Returns a random step whose work is small. It often has an edit.
[[nodiscard]] sand::Step shortStep(const sand::Replica& sand, Chance& chance);

/// Throws std::logic_error with `what` unless `good`.
inline void require(bool good, const std::string& what) {
    if (!good) {
        throw std::logic_error(what);
    }
}

/// Applies `step` as the next one. Throws std::logic_error if it loses sand, leaves the range of heights, or does more
/// work than a step may.
void applyAndCheck(sand::Replica& sand, sand::Step step);

}  // namespace structure
