// SPDX-License-Identifier: Apache-2.0
// States of a replica: copies, bytes, and their return.
#include <limits>
#include <utility>

#include "base/float_environment.hpp"
#include "sand/replica.hpp"

namespace sand {

StateHead Replica::head() const { return {stepNumber_, probe_, heading_, engaged_, owed_, rules_.tuning}; }

base::Bytes Replica::encodedMovement() const {
    base::ByteWriter movement;
    if (surface_->movement() != nullptr) {
        surface_->movement()->encode(movement);
    }
    return movement.take();
}

StateCopy Replica::copyState() const {
    StateCopy copy = beginCopy();
    while (!copy.complete()) {
        (void)continueCopy(std::numeric_limits<std::int64_t>::max());
    }
    return copy;
}

StateCopy Replica::beginCopy() const {
    Surface::Copies copies = surface_->beginCopy();
    return {base::encoded(head()), encodedMovement(), std::move(copies.kept), std::move(copies.sand)};
}

base::Bytes Replica::encodeState(std::size_t expected) const {
    base::ByteWriter writer;
    writer.reserve(expected);
    writer.putBytes(base::encoded(head()));
    writer.putBlock(encodedMovement());
    const std::uint64_t stroke = writer.beginBlock();
    if (canUndo()) {
        surface_->encodeKept(writer);
    }
    writer.endBlock(stroke);
    surface_->encodeInto(writer);
    return writer.take();
}

void StateCopy::encodeInto(base::ByteWriter& writer, const std::function<void()>& between) const {
    writer.putBytes(head);
    writer.putBlock(movement);
    const std::uint64_t stroke = writer.beginBlock();
    if (beforeStroke) {
        beforeStroke->encodeInto(writer, between);
    }
    writer.endBlock(stroke);
    sand->encodeInto(writer, between);
}

base::Bytes StateCopy::encode(const std::function<void()>& between) const {
    base::ByteWriter writer;
    encodeInto(writer, between);
    return writer.take();
}

void Replica::takeState(std::span<const std::uint8_t> bytes, const Surface::Decoding& how) {
    (void)base::needDefaultFloats();
    base::ByteReader reader(bytes);
    const auto head = base::read<StateHead>(reader);
    const bool grid = surface_->movement() != nullptr;
    const std::size_t tiles = grid ? static_cast<std::size_t>(hashTiles().tileCount()) : 0;
    const Movement movement = Movement::decode(reader.getBlock(), head.number, tiles);
    const auto beforeStroke = reader.getBlock();
    const auto forget = [this] {
        surface_->forget();    // before the sand changes, so that nothing of it is kept
        surface_->follow({});  // the sand may have been wrong
    };
    if (how.inPlace) {
        forget();
    }
    const std::function<void()> replace = surface_->decode(reader.rest(), beforeStroke, how);
    // From here on only std::bad_alloc can be thrown.
    forget();
    rules_.tuning = head.tuning;
    surface_->changeRules(rules_);
    replace();
    (void)surface_->hash();  // so that the next step does not count as the one that changed this sand
    surface_->resumeMovement(movement);
    stepNumber_ = head.number;
    engaged_ = head.engaged;
    owed_ = head.owed;
    probe_ = head.probe;
    heading_ = head.heading;
    leftOut_.clear();
    refusedStep_ = refusedPress_ = settleCameToRest_ = false;
    lastWork_ = {};
}

}  // namespace sand
