// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "sand/history.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace test {

/// Bytes of the sand at one moment, the hashes of its hash tiles, and the material. The bytes have the fluxes of a
/// grid.
struct Stop {
    base::Bytes sand;
    std::vector<std::uint64_t> hashes;
    std::int32_t threshold = 0;
    friend bool operator==(const Stop&, const Stop&) = default;
};

/// A session with a history, and the stops to which undos and redos must return.
class HistorySession {
public:
    explicit HistorySession(const scene::Scene& scene, std::int64_t mostBytes = sand::History::kMostBytes)
        : rules_(scene.rules), replica_(scene), history_(replica_, mostBytes) {
        for (const double share : {1.0, 0.7, 0.5, 0.9}) {
            thresholds_.push_back(static_cast<std::int32_t>(share * rules_.tuning.threshold));
        }
    }

    [[nodiscard]] Stop here() {
        (void)replica_.stateHash();
        return {replica_.copySand()->encode(), replica_.hashTiles().tileHashes(), replica_.rules().tuning.threshold};
    }
    [[nodiscard]] sand::Replica& replica() { return replica_; }
    [[nodiscard]] const sand::History& history() const { return history_; }
    [[nodiscard]] std::size_t undos() const { return undo_.size(); }
    [[nodiscard]] std::size_t redos() const { return redo_.size(); }

    void apply(sand::Step step, const sand::History::Intent& intent = {}) {
        step.epoch = 1;
        step.number = replica_.stepNumber() + 1;
        history_.begin(replica_, step, intent, label_);
        replica_.apply(step);
        history_.end(replica_);
        ASSERT_TRUE(replica_.leftOut().empty()) << replica_.leftOut();
    }
    void hover(int steps) {
        for (int i = 0; i < steps; ++i) {
            apply({});
        }
    }
    /// Makes a stroke of some steps. The tool then lifts, unless it `stays`.
    void stroke(std::mt19937& random, bool stays = false) {
        beginEntry();
        const auto within = [&](std::int32_t cells) {
            return static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(cells * sand::kProbePerCell));
        };
        sand::ProbePoint at{within(rules_.columns), within(rules_.rows), -2 * sand::kProbePerCell};
        for (unsigned steps = 1 + random() % 4; steps > 0; --steps) {
            at.x += within(8) - 4 * sand::kProbePerCell;
            at.y += within(8) - 4 * sand::kProbePerCell;
            apply({.engaged = true, .path = {at}});
        }
        if (!stays) {
            apply({});
        }
    }
    void edit(const sand::Edit& edit) {
        beginEntry();
        apply({.engaged = replica_.engaged(), .edit = edit});
    }
    void material(std::size_t label) {
        if (label != label_) {
            beginEntry();
        }
        tune(label, {});
    }
    /// Applies the change of the material alone, as of an undo whose load has not come yet.
    void tune(std::size_t label, const sand::History::Intent& intent) {
        label_ = label;
        sand::Tuning tuning = replica_.rules().tuning;
        tuning.threshold = tuning.startThreshold = thresholds_.at(label);
        apply({.engaged = replica_.engaged(), .edit = sand::Edit::tuned(tuning)}, intent);
    }
    void otherTool(std::int32_t radius) {
        sand::Tuning tuning = replica_.rules().tuning;
        tuning.tool.radius = radius;
        apply({.engaged = replica_.engaged(), .edit = sand::Edit::tuned(tuning)});
    }

    /// Undoes or redoes an entry as a master does, and hovers for some steps until the sand has been copied. Returns
    /// false if there is nothing to undo or redo.
    [[nodiscard]] bool move(sand::History::Move move, std::mt19937& random) {
        const auto how = history_.beginReturn(replica_, move);
        if (!how) {
            return false;
        }
        const bool engaged = replica_.engaged();
        if (how->edit == sand::Edit::undo) {
            note(move);
            apply({.engaged = engaged, .edit = sand::Edit::undo}, how->intent);
            return true;
        }
        while (!how->sand->complete()) {
            if (random() % 4 == 0) {
                apply({.engaged = engaged});
            }
            (void)replica_.continueCopy(4000);
        }
        const sand::Edit load = sand::Edit::loaded(how->sand->encode());
        note(move);
        if (how->label != label_) {
            tune(how->label, how->intent);
        }
        apply({.engaged = engaged, .edit = load}, how->intent);
        return true;
    }
    /// Returns the stop to which the last move must have returned.
    [[nodiscard]] const Stop& wanted() const { return wanted_; }

private:
    void beginEntry() {
        undo_.push_back(here());
        redo_.clear();
        returned_.reset();
        if (undo_.size() > sand::History::kMost) {
            undo_.erase(undo_.begin());
        }
    }
    /// Moves between the stops. Sand that slides after a move does not change them.
    void note(sand::History::Move move) {
        if (move == sand::History::Move::undo) {
            redo_.push_back(returned_ ? *returned_ : here());
            wanted_ = std::move(undo_.back());
            undo_.pop_back();
            returned_ = wanted_;
        } else {
            undo_.push_back(*returned_);
            wanted_ = std::move(redo_.back());
            redo_.pop_back();
            returned_ = redo_.empty() ? std::nullopt : std::optional(wanted_);
        }
    }
    sand::Rules rules_;
    sand::Replica replica_;
    sand::History history_;
    std::vector<std::int32_t> thresholds_;  // by label
    std::size_t label_ = 0;
    std::vector<Stop> undo_, redo_;
    std::optional<Stop> returned_;
    Stop wanted_;
};

inline scene::Scene gridScene() {
    std::mt19937 random(7);
    scene::Scene scene = samples::flatScene(150, 140);  // of nine tiles
    scene.terrain = samples::randomField(150, 140, 3 << 16, random);
    return scene;
}

inline scene::Scene tinScene() {
    scene::Scene scene = samples::tinScene();
    scene.rules.tuning.tool.radius = 2 * sand::kProbePerCell;
    return scene;
}

/// Makes an entry of some kind: strokes, and each edit.
inline void makeEntry(HistorySession& session, unsigned kind, const base::Bytes& saved, std::mt19937& random) {
    switch (kind % 8) {
        case 2:
            session.edit(sand::Edit::settle);
            return;
        case 3:
            session.material(1 + random() % 3);
            return;
        case 5:
            session.edit(sand::Edit::reset);
            return;
        case 6:
            session.edit(sand::Edit::loaded(saved));
            return;
        default:
            session.stroke(random);
    }
}

}  // namespace test
