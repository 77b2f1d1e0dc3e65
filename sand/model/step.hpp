// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/byte_stream.hpp"
#include "base/names.hpp"
#include "sand/model/probe_point.hpp"
#include "sand/model/rules.hpp"

namespace sand {

inline constexpr std::size_t kMaxPathPoints = 64;           // most points in one step
inline constexpr std::size_t kMostStepsOfAFrame = 1 << 20;  // in a frame message, and in a record of the journal

/// An operator's change to the sand: its number, kind and data.
struct Edit {
    enum class Kind : std::uint8_t {
        none,
        settle,  // lets the sand come to rest at once
        reset,   // restores the sand that the scene began with
        undo,    // restores the sand before the last stroke; ignored if no such sand is kept
        tune,    // changes tool and material
        load     // replaces the sand by saved sand
    };
    using enum Kind;

    /// Given by the master when an operator asks for the edit. It counts from 1 over a whole session, also over resumes
    /// and epochs; 0 for no edit. An edit has the same number in every message and in the journal. So it is found again
    /// without comparing its sand. The sand and its state hash never depend on the number.
    std::uint64_t number = 0;
    Kind kind = Kind::none;
    Tuning tuning;  // only for Kind::tune
    /// Only for Kind::load: bytes from SurfaceCopy::encode(). Copies of a step share them.
    std::shared_ptr<const base::Bytes> sand;

    Edit() = default;
    Edit(Kind what) : kind(what) {}  // not explicit, because most edits have no data
    static Edit tuned(const Tuning& tuning);
    static Edit loaded(base::Bytes sand);

    [[nodiscard]] bool any() const { return kind != Kind::none; }
    friend bool operator==(const Edit& a, const Edit& b);
};
/// Returns every kind with its name in commands and tables.
constexpr auto valuesOf(Edit::Kind /* type */) {
    using enum Edit::Kind;
    return std::array{base::Named{settle, "settle"}, base::Named{reset, "reset"}, base::Named{undo, "undo"},
                      base::Named{tune, "tune"}, base::Named{load, "load"}};
}
inline constexpr int kEdits = static_cast<int>(valuesOf(Edit::none).size()) + 1;  // number of kinds, with none

/// Writes number and data of an edit, without its kind.
void encodeDetails(const Edit& edit, base::ByteWriter& writer);
/// Reads number and data of an edit of this `kind`. Throws base::FormatError for an invalid tuning or truncated bytes.
/// Step::refusal() checks the size of the sand, and Replica::apply() the sand itself, because only they know the field.
[[nodiscard]] Edit decodeDetails(Edit::Kind kind, base::ByteReader& reader);

/// The only thing that changes sand: the path of the hand since the step before, and an operator's edit.
///
/// `number` counts 1, 2, 3 … over a whole session. In one `epoch` either the master or the haptic server numbers all
/// steps. `path` has at most kMaxPathPoints points, and is empty while the hand rests. The tool moves to its first
/// point from the last point of the earlier steps. If the tool hovered before, it touches the sand only from the first
/// point on.
struct Step {
    std::uint32_t epoch = 0;
    std::uint64_t number = 0;
    bool engaged = false;  // true: the tool may touch the sand; false: it hovers and leaves the sand alone
    std::vector<ProbePoint> path{};
    Edit edit = Edit::none;                         // done after the tool's displacement and before the sweeps
    std::optional<Heading> heading = std::nullopt;  // of the tool from this step on; nullopt: unchanged
    /// Sweeps of a height field that this step runs, at most kMostSweeps. 0 runs all that is owed, but of a
    /// settle only what Replica::wholeSweeps() returns. Steps of a TIN have 0, and so have steps that never become
    /// bytes.
    std::int32_t sweeps = 0;

    /// Writes the one format that link, frame message and journal share. A point is written as the difference from the
    /// point before, in integers of variable length: about 60 bytes for a step of 17 samples.
    void put(base::ByteWriter& writer) const;
    /// Reads what put() wrote. Throws base::FormatError for invalid bytes, for more than kMaxPathPoints points or
    /// kMostSweeps sweeps, and for a coordinate beyond kMaxProbe.
    void get(base::ByteReader& reader);
    /// Returns why a step of sand with these limits cannot have this number of sweeps, path or load. Returns an empty
    /// text if it can. Call it for each step that comes from a network or a file, with Rules::stepLimits().
    [[nodiscard]] std::string refusal(const StepLimits& limits) const;
    friend bool operator==(const Step&, const Step&) = default;
};

/// A part of a step that every step does whole. The sweeps, which may be spread over steps, come after these parts.
enum class StepPart : std::uint8_t { movement, coarsePhase };  // the first has the edit, too

/// Amount of work that a step asks of a replica.
struct StepWork {
    std::int64_t sweeps = 0;
    std::int64_t substeps = 0;  // of the tool, in which it displaces sand
    std::int64_t phases = 0;    // coarse phases, which cannot be divided (SweepPlan)

    StepWork& operator+=(const StepWork& other) {
        sweeps += other.sweeps;
        substeps += other.substeps;
        phases += other.phases;
        return *this;
    }
    friend bool operator==(const StepWork&, const StepWork&) = default;
};

/// Returns the path that a tool takes in sub-steps of `length` [probe unit]. Leaves out points of `path` that are less
/// than a sub-step apart along it. The first point, the last point and a press in place at the beginning stay.
/// With sub-steps of a cell it keeps all points.
[[nodiscard]] std::vector<ProbePoint> pathInSubsteps(std::vector<ProbePoint> path, std::int32_t length);

/// Returns the sub-steps of `step`, before which the tool is at `probe` and `engaged` or not. `length` is
/// Rules::substepLength().
[[nodiscard]] std::int64_t substepsOf(const Step& step, const ProbePoint& probe, bool engaged, std::int32_t length);

}  // namespace sand
