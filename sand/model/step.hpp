// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/model/tuning.hpp"

namespace sand {

inline constexpr std::size_t kMaxPathPoints = 64;

/// A pose of the tool's centre, quantised before anybody uses it [probe unit = cellSize / 256].
///
/// x runs east from the south-west corner of the field, y north, z up from height 0.
struct ProbePoint {
    std::int32_t x = 0, y = 0, z = 0;
    friend bool operator==(const ProbePoint&, const ProbePoint&) = default;
};

/// The largest magnitude of a probe coordinate: any further out, and the tool is clamped by whoever quantises it.
inline constexpr std::int32_t kMaxProbe = 1 << 24;  // [probe unit], four times the longest field

inline constexpr std::size_t kMaxSandBytes = 192U << 20;  // [byte], compressed, of sand that is loaded

/// What an operator may ask of the sand, with what it takes.
struct Edit {
    enum class Kind : std::uint8_t {
        none,
        settle,  // let it come to rest at once
        reset,   // as the scene began
        undo,    // as it was before the last stroke began; nothing when there is none
        tune,    // another tool, another material
        load     // as it was saved
    };
    using enum Kind;

    Kind kind = Kind::none;
    Tuning tuning;                            // of Kind::tune
    std::shared_ptr<const base::Bytes> sand;  // of Kind::load, Replica::encodeSand(); copies of a step share it

    Edit() = default;
    Edit(Kind what) : kind(what) {}  // not explicit: most edits are nothing but their kind
    static Edit tuned(const Tuning& tuning);
    static Edit loaded(base::Bytes sand);

    [[nodiscard]] bool any() const { return kind != Kind::none; }
    friend bool operator==(const Edit& a, const Edit& b);
};
inline constexpr int kEdits = 6;

/// What an edit takes, behind its kind. Throws base::FormatError, as decodeStep() does.
void encodeDetails(const Edit& edit, base::ByteWriter& writer);
[[nodiscard]] Edit decodeDetails(Edit::Kind kind, base::ByteReader& reader);

/// The only thing that changes sand: where the hand has been since the step before, and what an operator asked.
///
/// `number` counts 1, 2, 3 … over a whole session. In one `epoch` either the master or the haptic server numbers all
/// steps. The path starts at the last point of the step before and may be empty (the hand rests); at most
/// kMaxPathPoints.
struct Step {
    std::uint32_t epoch = 0;
    std::uint64_t number = 0;
    bool engaged = false;  // the tool touches; otherwise it hovers and leaves the sand alone
    std::vector<ProbePoint> path;
    Edit edit = Edit::none;                         // done after the tool's displacement, before the sweeps
    std::optional<Heading> heading = std::nullopt;  // of the tool from the path's first point on; none: as it was
    friend bool operator==(const Step&, const Step&) = default;
};

/// The one encoding of a step, on the wire, in the broadcast and in the journal: differences in short integers, about
/// 60 bytes at 17 samples a step.
void encode(const Step& step, base::ByteWriter& writer);
/// Throws base::FormatError for bytes that are no step, a path too long or a point beyond kMaxProbe.
[[nodiscard]] Step decodeStep(base::ByteReader& reader);

}  // namespace sand
