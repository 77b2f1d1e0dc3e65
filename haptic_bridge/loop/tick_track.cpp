// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/tick_track.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <iterator>
#include <limits>

namespace haptic_bridge {
namespace {

using sand::force::Vec3;

enum Flag : std::uint32_t {
    kEngaged = 1,
    kFirst = 2,
    kSecond = 4,
    kPresent = 8,
    kElsewhere = 16,
    kTuned = 32,
    kEdited = 64,
    // From here on a flag makes the varint of the flags longer.
    kSilent = 128,
    kTripped = 256,
    kNoFlag = 512
};

std::uint32_t flagsOf(const TickInput& tick) {
    return (tick.pose.engaged ? kEngaged : 0U) | (tick.reading.first ? kFirst : 0U) |
           (tick.reading.second ? kSecond : 0U) | (tick.reading.present ? kPresent : 0U) |
           (tick.edited ? kEdited : 0U) | (tick.silent ? kSilent : 0U) | (tick.tripped ? kTripped : 0U);
}

std::uint64_t getFlags(base::ByteReader& reader) {
    const std::uint64_t flags = reader.getVarint();
    if (flags >= kNoFlag) {
        throw base::FormatError(fmt::format("a tick with the flags {}", flags));
    }
    return flags;
}

void putVec(const Vec3& v, base::ByteWriter& writer) {
    writer.put(v.x);
    writer.put(v.y);
    writer.put(v.z);
}

Vec3 getVec(base::ByteReader& reader) {
    const double x = reader.get<double>(), y = reader.get<double>();
    return {x, y, reader.get<double>()};
}

std::int32_t getProbe(base::ByteReader& reader) {
    const std::int64_t value = reader.getSigned();
    if (value < -sand::kMaxProbe || value > sand::kMaxProbe) {
        throw base::FormatError(fmt::format("a tick that felt the sand at {}, which is beyond any field", value));
    }
    return static_cast<std::int32_t>(value);
}

// 36 years. Sums and differences of such times stay within 64 bits.
constexpr std::int64_t kMostNs = std::int64_t{1} << 60;  // [ns]

/// Reads a time from `beforeNs` on.
std::int64_t getNs(std::int64_t beforeNs, base::ByteReader& reader) {
    const std::int64_t span = reader.getSigned();
    if (span < -2 * kMostNs || span > 2 * kMostNs || std::abs(beforeNs + span) > kMostNs) {
        throw base::FormatError(fmt::format("a tick {} ns after {} ns, which no clock shows", span, beforeNs));
    }
    return beforeNs + span;
}

/// Reads a number from 0 to `most`.
double getBounded(double most, const char* what, base::ByteReader& reader) {
    const auto number = reader.get<double>();
    if (!(number >= 0 && number <= most)) {
        throw base::FormatError(fmt::format("a tick with {} of {}", what, number));
    }
    return number;
}

}  // namespace

TrackHeader headerOf(const HapticTick& hand) {
    TrackHeader header;
    if (const ArmPhysics* physics = hand.device().physics()) {
        header.body = true;
        header.physics = *physics;
    }
    header.scale = hand.device().scale();
    header.datum = hand.datum();
    header.literal = hand.guards().mode() == Guards::Mode::literal;
    return header;
}

std::string TrackHeader::refusal() const {
    return body ? complaintAbout(physics, "an arm").value_or("") : std::string();
}

base::Bytes encode(const TrackPiece& piece) {
    base::ByteWriter writer;
    writer.put(piece.sitting);
    writer.put(static_cast<std::uint8_t>(piece.begins));
    if (piece.begins) {
        base::putMember(writer, piece.header);
        return writer.take();
    }
    writer.putVarint(piece.ticks.size());
    std::int64_t beforeNs = 0;
    sand::ProbePoint surfaceProbe;  // of the previous tick
    double share = 0, talus = 0;    // of the previous tick
    for (const TickInput& tick : piece.ticks) {
        const bool elsewhere = tick.surfaceProbe != surfaceProbe, tuned = tick.share != share || tick.talus != talus;
        writer.put(tick.time);
        putVec({tick.pose.x, tick.pose.y, tick.pose.z}, writer);
        putVec(tick.reading.place, writer);
        writer.putVarint(flagsOf(tick) | (elsewhere ? kElsewhere : 0U) | (tuned ? kTuned : 0U));
        writer.putSigned(tick.nowNs - beforeNs);
        writer.putSigned(tick.surfaceAgeNs);
        writer.putSigned(tick.stepAgeNs);
        writer.putVarint(tick.surfaceStep);
        if (elsewhere) {
            writer.putSigned(tick.surfaceProbe.x);
            writer.putSigned(tick.surfaceProbe.y);
        }
        if (tuned) {
            writer.put(tick.share);
            writer.put(tick.talus);
        }
        beforeNs = tick.nowNs;
        surfaceProbe = tick.surfaceProbe;
        share = tick.share;
        talus = tick.talus;
    }
    return writer.take();
}

TrackPiece decodeTrackPiece(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    TrackPiece piece;
    piece.sitting = reader.get<std::uint32_t>();
    base::getMember(reader, piece.begins);
    if (piece.begins) {
        base::getMember(reader, piece.header);
    } else {
        const std::uint64_t count = reader.getVarint();
        if (count > kMostTicksInPiece) {
            throw base::FormatError(fmt::format("{} ticks in a piece", count));
        }
        std::int64_t beforeNs = 0;
        sand::ProbePoint surfaceProbe;
        double share = 0, talus = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            TickInput& tick = piece.ticks.emplace_back();
            tick.time = reader.get<double>();
            const Vec3 pose = getVec(reader);
            tick.reading.place = getVec(reader);
            const std::uint64_t flags = getFlags(reader);
            tick.pose = {pose.x, pose.y, pose.z, (flags & kEngaged) != 0};
            tick.reading.first = (flags & kFirst) != 0;
            tick.reading.second = (flags & kSecond) != 0;
            tick.reading.present = (flags & kPresent) != 0;
            tick.nowNs = beforeNs = getNs(beforeNs, reader);
            tick.edited = (flags & kEdited) != 0;
            tick.silent = (flags & kSilent) != 0;
            tick.tripped = (flags & kTripped) != 0;
            tick.surfaceAgeNs = getNs(0, reader);
            tick.stepAgeNs = getNs(0, reader);
            tick.surfaceStep = reader.getVarint();
            if ((flags & kElsewhere) != 0) {
                surfaceProbe.x = getProbe(reader);
                surfaceProbe.y = getProbe(reader);
            }
            tick.surfaceProbe = surfaceProbe;
            if ((flags & kTuned) != 0) {
                share = getBounded(1, "a share of the force", reader);
                talus = getBounded(std::numeric_limits<double>::max(), "a talus", reader);
            }
            tick.share = share;
            tick.talus = talus;
        }
    }
    base::requireEnd(reader);
    return piece;
}

std::string tickTitles() {
    return "time,arm_x,arm_y,arm_z,arm_vx,arm_vy,arm_vz,x,y,z,vx,vy,vz,law_x,law_y,law_z,sent_x,sent_y,sent_z,guards,"
           "surface_age,surface_step,step_age,share,talus,edited,engaged\n";
}

void appendRow(const Tick& tick, std::string& text) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{}", tick.time);
    for (const Vec3& v : {tick.armPlace, tick.armVelocity, tick.place, tick.velocity, tick.lawful, tick.sent}) {
        fmt::format_to(out, ",{},{},{}", v.x, v.y, v.z);
    }
    fmt::format_to(out, ",{},{},{},{},{},{},{},{}\n", tick.guards, tick.surfaceAge, tick.surfaceStep, tick.stepAge,
                   tick.share, tick.talus, tick.edited ? 1 : 0, tick.engaged ? 1 : 0);
}

}  // namespace haptic_bridge
