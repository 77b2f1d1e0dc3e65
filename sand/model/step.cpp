// SPDX-License-Identifier: Apache-2.0
#include "sand/model/step.hpp"

#include <cstdlib>
#include <string>
#include <utility>

namespace sand {
namespace {

// Flags of a step. The bits between them hold the kind of the edit.
constexpr int kEngaged = 0x01, kTurned = 0x80;

int flagsOf(const Step& step) {
    const int edit = 2 * static_cast<int>(step.edit.kind);
    return edit + (step.engaged ? kEngaged : 0) + (step.heading ? kTurned : 0);
}

}  // namespace

Edit Edit::tuned(const Tuning& tuning) {
    Edit edit(Kind::tune);
    edit.tuning = tuning;
    return edit;
}

Edit Edit::loaded(base::Bytes sand) {
    Edit edit(Kind::load);
    edit.sand = std::make_shared<const base::Bytes>(std::move(sand));
    return edit;
}

bool operator==(const Edit& a, const Edit& b) {
    const bool sameSand = a.sand == b.sand || (a.sand && b.sand && *a.sand == *b.sand);
    return a.number == b.number && a.kind == b.kind && a.tuning == b.tuning && sameSand;
}

void encodeDetails(const Edit& edit, base::ByteWriter& writer) {
    if (edit.any()) {
        writer.putVarint(edit.number);
    }
    if (edit.kind == Edit::tune) {
        base::putMember(writer, edit.tuning);
    } else if (edit.kind == Edit::load) {
        writer.putBlock(edit.sand ? std::span(*edit.sand) : std::span<const std::uint8_t>());
    }
}

Edit decodeDetails(Edit::Kind kind, base::ByteReader& reader) {
    Edit edit = kind;
    edit.number = edit.any() ? reader.getVarint() : 0;
    if (kind == Edit::tune) {
        edit.tuning = base::read<Tuning>(reader);
    } else if (kind == Edit::load) {
        const auto sand = reader.getBlock();
        edit.sand = std::make_shared<const base::Bytes>(sand.begin(), sand.end());
    }
    return edit;
}

void Step::put(base::ByteWriter& writer) const {
    writer.putVarint(epoch);
    writer.putVarint(number);
    writer.putVarint(static_cast<std::uint64_t>(sweeps));
    writer.put(static_cast<std::uint8_t>(flagsOf(*this)));
    writer.put(static_cast<std::uint8_t>(path.size()));
    ProbePoint last;
    for (const ProbePoint& point : path) {
        writer.putSigned(std::int64_t{point.x} - last.x);
        writer.putSigned(std::int64_t{point.y} - last.y);
        writer.putSigned(std::int64_t{point.z} - last.z);
        last = point;
    }
    if (heading) {
        base::putMember(writer, *heading);
    }
    encodeDetails(edit, writer);
}

namespace {

std::int32_t addChecked(std::int32_t base, std::int64_t difference) {
    if (difference < -2LL * kMaxProbe || difference > 2LL * kMaxProbe || std::llabs(base + difference) > kMaxProbe) {
        throw base::FormatError("a step's point lies out of reach");
    }
    return static_cast<std::int32_t>(base + difference);
}

}  // namespace

void Step::get(base::ByteReader& reader) {
    const std::uint64_t readEpoch = reader.getVarint();
    if (readEpoch > UINT32_MAX) {
        throw base::FormatError("a step's epoch is out of range");
    }
    epoch = static_cast<std::uint32_t>(readEpoch);
    number = reader.getVarint();
    const std::uint64_t readSweeps = reader.getVarint();
    if (readSweeps > kMostSweeps) {
        throw base::FormatError("a step with " + std::to_string(readSweeps) + " sweeps; a step runs " +
                                std::to_string(kMostSweeps) + " at most");
    }
    sweeps = static_cast<std::int32_t>(readSweeps);
    const auto flags = reader.get<std::uint8_t>();
    const auto count = reader.get<std::uint8_t>();
    const int kind = flags % kTurned / 2;
    if (kind >= kEdits || count > kMaxPathPoints) {
        throw base::FormatError("a step with " + std::to_string(count) + " points, flags " + std::to_string(flags));
    }
    engaged = (flags & kEngaged) != 0;
    path.clear();
    path.reserve(count);
    ProbePoint last;
    for (int i = 0; i < count; ++i) {
        last.x = addChecked(last.x, reader.getSigned());
        last.y = addChecked(last.y, reader.getSigned());
        last.z = addChecked(last.z, reader.getSigned());
        path.push_back(last);
    }
    heading.reset();
    if ((flags & kTurned) != 0) {
        heading = base::read<Heading>(reader);
    }
    edit = decodeDetails(static_cast<Edit::Kind>(kind), reader);
}

std::vector<ProbePoint> pathInSubsteps(std::vector<ProbePoint> path, std::int32_t length) {
    if (length <= kProbePerCell) {
        return path;
    }
    std::int64_t since = 0;  // length of the path since the last point that stays
    std::size_t kept = 1;
    for (std::size_t i = 1; i < path.size(); ++i) {
        since += distanceAlongAxis(path[i - 1], path[i]);
        const bool pressesInPlace = i == 1 && since == 0;
        if (i + 1 == path.size() || pressesInPlace || since + distanceAlongAxis(path[i], path[i + 1]) > length) {
            path[kept++] = path[i];
            since = 0;
        }
    }
    path.resize(std::min(kept, path.size()));
    return path;
}

std::int64_t substepsOf(const Step& step, const ProbePoint& probe, bool engaged, std::int32_t length) {
    if (!step.engaged || step.path.empty()) {
        return 0;
    }
    std::vector<ProbePoint> path{engaged ? probe : step.path.front()};
    path.insert(path.end(), step.path.begin(), step.path.end());
    path = pathInSubsteps(std::move(path), length);
    std::int64_t substeps = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
        substeps += substepsBetween(path[i - 1], path[i], length);
    }
    return substeps;
}

std::string Step::refusal(const StepLimits& limits) const {
    const std::string step = "step " + std::to_string(number);
    if (sweeps < limits.leastSweeps || sweeps > limits.mostSweeps) {
        return step + " states " + std::to_string(sweeps) + " sweeps; a step of this sand states " +
               (limits.mostSweeps == 0
                    ? "none"
                    : std::to_string(limits.leastSweeps) + " to " + std::to_string(limits.mostSweeps));
    }
    if (const auto bytes = static_cast<std::int64_t>(edit.sand ? edit.sand->size() : 0); bytes > limits.mostSandBytes) {
        return step + " loads " + std::to_string(bytes) + " bytes of sand; a step of this sand loads at most " +
               std::to_string(limits.mostSandBytes);
    }
    // The way to the first point is not among them, because only a replica knows where the tool is.
    if (const std::int64_t substeps = substepsOf(*this, {}, false, kProbePerCell) - 1; substeps > limits.mostSubsteps) {
        return step + " has a path of " + std::to_string(substeps) + " sub-steps; a step of this sand has at most " +
               std::to_string(limits.mostSubsteps);
    }
    return {};
}

}  // namespace sand
