// SPDX-License-Identifier: Apache-2.0
#include "sand/terrain.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>

#include "sand/grid_codec.hpp"
#include "sand/settle.hpp"

namespace sand {
namespace {

constexpr std::uint32_t kStateVersion = 5;
constexpr int kSweepsToRest = 1 << 20;  // more than any field that is worth waiting for

Rect around(const Rect& a, const Rect& b) {
    if (a.empty()) {
        return b;
    }
    if (b.empty()) {
        return a;
    }
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

/// The finaliser of MurmurHash3: every bit of the input reaches every bit of the result.
std::uint64_t mix(std::uint64_t value) {
    value = (value ^ (value >> 33)) * 0xff51afd7ed558ccdULL;
    value = (value ^ (value >> 33)) * 0xc4ceb9fe1a85ec53ULL;
    return value ^ (value >> 33);
}

Erosion::Options withGround(Erosion::Options options, const Ground* ground) {
    options.ground = ground;
    return options;
}

}  // namespace

Terrain::Terrain(const Scene& scene, const Erosion::Options& options)
    : rules_(scene.rules),
      sceneRules_(scene.rules),
      ground_(scene.ground),
      options_(withGround(options, ground_.get())),
      field_(scene.terrain),
      erosion_(field_, rules_, options_),
      hash_(field_),
      heading_(scene.rules.toolHeading),
      damage_(field_.bounds()) {
    files::ByteWriter writer;
    encodeCells(field_.cells(), field_.bounds(), writer);
    start_ = std::make_shared<const files::Bytes>(writer.take());
}

std::int64_t Terrain::leastBytes(int columns, int rows) {
    // The scene's heights, the replica's, and a flux through two faces of every cell.
    constexpr std::int64_t kPerCell = 4 * sizeof(std::int32_t);
    return kPerCell * columns * rows;
}

void Terrain::touch(const Rect& cells) {
    if (!cells.empty()) {
        hash_.touch(cells);
        beforeStroke_.touch(cells);
        damage_ = around(damage_, cells);
    }
}

void Terrain::apply(const Step& step) {
    if (step.number != stepNumber_ + 1) {
        throw std::logic_error("Terrain::apply: step " + std::to_string(step.number) + " after step " +
                               std::to_string(stepNumber_));
    }
    const bool wasEngaged = engaged_;
    const ProbePoint before = probe_;
    const Tool toolBefore(rules_.toolShape(), heading_);
    const bool turned = step.heading && *step.heading != heading_;
    heading_ = step.heading.value_or(heading_);
    const Tool tool(rules_.toolShape(), heading_);
    if (step.engaged && !wasEngaged) {
        beforeStroke_.keep(field_, erosion_.inertia(), outflow_);
    }
    for (std::size_t i = 0; i < step.path.size(); ++i) {
        const ProbePoint to = step.path[i];
        // A hand that has just engaged comes from nowhere: its first point presses and does not drag.
        const bool arrived = !wasEngaged && i == 0;
        if (step.engaged) {
            drag(tool, arrived ? to : probe_, to);
        }
        probe_ = to;
    }
    if (turned && wasEngaged && step.engaged && step.path.empty()) {
        drag(tool, probe_, probe_);  // turned on the spot
    }
    engaged_ = step.engaged;
    stepNumber_ = step.number;

    if (step.edit.kind == Edit::settle) {
        settleNow();
    } else if (step.edit.kind == Edit::tune) {
        tune(step.edit.tuning);
    } else if (putBack(step.edit)) {
        return;
    }
    const Obstacle here = engaged_ ? Tool(rules_.toolShape(), heading_).obstacle(field_, probe_) : Obstacle{};
    if (wasEngaged && (!engaged_ || turned || probe_ != before)) {
        // Sand that the tool held back may flow again.
        erosion_.touch(toolBefore.cells(field_, before));
    }
    outflow_ += erosion_.sweep(field_, rules_.sweepsPerStep, engaged_ ? &here : nullptr);
    for (const Rect& block : erosion_.takeMoved()) {
        touch(block);
    }
}

void Terrain::drag(const Tool& tool, const ProbePoint& from, const ProbePoint& to) {
    const Tool::Displacement done = tool.drag(field_, rules_.rim, ground_.get(), from, to);
    erosion_.touch(done.cells);
    touch(done.cells);
    outflow_ += done.outflow;
}

void Terrain::tune(const Tuning& tuning) {
    // A hand that has turned its tool keeps it turned, unless the operator turns it.
    heading_ = tuning.toolHeading != rules_.toolHeading ? tuning.toolHeading : heading_;
    const bool otherTool = tuning.tool() != rules_.tuning().tool();
    rules_.tune(tuning);
    // Wakes everything: sand may stand too steep now, or have been held back by a larger tool.
    erosion_.changeRules(rules_);
    if (engaged_ && otherTool) {
        drag(Tool(rules_.toolShape(), heading_), probe_, probe_);
    }
}

void Terrain::settleNow() {
    if (ground_ != nullptr) {
        // The projection knows no rock and no walls; sweeps do, and take longer.
        outflow_ += erosion_.sweep(field_, kSweepsToRest);
        return;
    }
    outflow_ += settle(field_, rules_).outflow;
    erosion_.touch(field_.bounds());
    touch(field_.bounds());
}

bool Terrain::putBack(const Edit& edit) {
    if (edit.kind == Edit::reset) {
        files::ByteReader reader(*start_);
        decodeCells(reader, field_.bounds(), kMaxHeight, field_.cells());
        erosion_.resume({});
        outflow_ = 0;
        touch(field_.bounds());
    } else if (edit.kind == Edit::undo && canUndo()) {
        for (const Rect& tile : beforeStroke_.putBackHeights(field_)) {
            touch(tile);
        }
        erosion_.resume(beforeStroke_.kept()->inertia);
        outflow_ = beforeStroke_.kept()->outflow;
    } else if (edit.kind == Edit::load && edit.sand) {
        try {
            replaceSand(SandCopy::decode(*edit.sand, field_));
        } catch (const files::FormatError&) {
            return false;  // alike in every replica; who asked for it has looked before
        }
    } else {
        return false;
    }
    // A hand that is still in the sand goes on with its stroke, which now begins here.
    if (engaged_) {
        beforeStroke_.keep(field_, erosion_.inertia(), outflow_);
    } else {
        beforeStroke_.forget();
    }
    return true;
}

void Terrain::replaceSand(const SandCopy& sand) {
    field_ = sand.field;
    erosion_.resume(sand.inertia);
    outflow_ = sand.outflow;
    touch(field_.bounds());
}

std::uint64_t Terrain::stateHash() {
    std::uint64_t hash = hash_.update(field_);
    const auto fold = [&hash](std::uint64_t value) { hash = mix(hash ^ value) + std::rotl(value, 17); };
    fold(stepNumber_);
    fold(static_cast<std::uint64_t>(outflow_));
    fold(engaged_ ? 1 : 0);
    fold(static_cast<std::uint64_t>(erosion_.undisturbed()));
    for (const std::int32_t coordinate : {probe_.x, probe_.y, probe_.z}) {
        fold(static_cast<std::uint32_t>(coordinate));
    }
    if (rules_ != sceneRules_) {  // only then: sessions in which nobody tuned keep the hashes they always had
        const Tuning now = rules_.tuning();
        for (const std::int32_t number : {now.threshold, now.startThreshold, now.sweepsPerStep, now.toolRadius}) {
            fold(static_cast<std::uint32_t>(number));
        }
        if (!now.tool().plain()) {
            fold(static_cast<std::uint64_t>(now.toolKind));
            fold(static_cast<std::uint32_t>(now.toolHalfWidth));
            fold(now.toolHeading.bits());
        }
    }
    if (heading_ != sceneRules_.toolHeading) {  // likewise
        fold(heading_.bits());
    }
    return hash;
}

void Terrain::audit(int tiles) {
    for (int i = 0; i < std::min(tiles, hash_.tileCount()); ++i) {
        const int tile = hash_.auditNext(field_);
        // A flux that went bad where nothing flows would make sand from nothing.
        if (erosion_.amiss(hash_.cellsOf(tile))) {
            hash_.spoil(tile);
        }
    }
}

Rect Terrain::takeDamage() { return std::exchange(damage_, Rect{}); }

StateCopy Terrain::copyState() const {
    files::ByteWriter writer;
    writer.put(kStateVersion);
    writer.put(stepNumber_);
    for (const std::int32_t coordinate : {probe_.x, probe_.y, probe_.z}) {
        writer.put(coordinate);
    }
    writer.put(std::int32_t{(engaged_ ? 1 : 0) + (heading_.mirrored ? 2 : 0)});
    heading_.encode(writer);
    rules_.tuning().encode(writer);
    return {writer.take(), canUndo() ? std::optional(*beforeStroke_.kept()) : std::nullopt, copySand()};
}

files::Bytes StateCopy::encode() const {
    files::ByteWriter writer;
    writer.putBytes(head);
    writer.putBlock(beforeStroke ? beforeStroke->encode() : files::Bytes());
    writer.putBytes(sand.encode());
    return writer.take();
}

void Terrain::decodeState(std::span<const std::uint8_t> bytes) {
    files::ByteReader reader(bytes);
    if (const auto version = reader.get<std::uint32_t>(); version != kStateVersion) {
        throw files::FormatError("a state of version " + std::to_string(version));
    }
    const auto number = reader.get<std::uint64_t>();
    ProbePoint probe;
    for (std::int32_t* coordinate : {&probe.x, &probe.y, &probe.z}) {
        *coordinate = reader.get<std::int32_t>();
        if (*coordinate > kMaxProbe || *coordinate < -kMaxProbe) {
            throw files::FormatError("a state with its tool out of reach");
        }
    }
    const auto flags = reader.get<std::int32_t>();
    const bool engaged = (flags & 1) != 0;
    const Heading heading = Heading::decode(reader, (flags & 2) != 0);
    const Tuning tuning = Tuning::decode(reader);
    const auto beforeStroke = reader.getBlock();
    std::optional<SandCopy> stroke;
    if (!beforeStroke.empty()) {
        // Now, and not when somebody wants to undo: then it would be too late to refuse it.
        stroke = SandCopy::decode(beforeStroke, field_);
    }
    const SandCopy sand = SandCopy::decode(reader.rest(), field_);
    // Nothing below throws.
    rules_.tune(tuning);
    erosion_.changeRules(rules_);
    replaceSand(sand);
    stepNumber_ = number;
    engaged_ = engaged;
    probe_ = probe;
    heading_ = heading;
    beforeStroke_ = {};
    if (stroke) {
        beforeStroke_.keep(std::move(*stroke));
    }
}

void Terrain::corrupt(int column, int row, int bit) {
    field_.setHeight(column, row, field_.height(column, row) ^ (std::int32_t{1} << bit));
}

}  // namespace sand
