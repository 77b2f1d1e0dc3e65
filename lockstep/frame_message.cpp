// SPDX-License-Identifier: Apache-2.0
#include "lockstep/frame_message.hpp"

namespace lockstep {
namespace {

template <std::size_t kCount>
void putEach(const std::array<double, kCount>& numbers, base::ByteWriter& writer) {
    for (const double number : numbers) {
        writer.put(number);
    }
}

template <std::size_t kCount>
void getEach(base::ByteReader& reader, std::array<double, kCount>& numbers) {
    for (double& number : numbers) {
        number = reader.get<double>();
    }
}

}  // namespace

void ViewState::encode(base::ByteWriter& writer) const {
    putEach(head, writer);
    putEach(right, writer);
    writer.put(eyeSeparation);
    putEach(sceneToRoom, writer);
    writer.put(pattern);
    writer.put(layers.bits());
    writer.put(stereo);
}

ViewState ViewState::decode(base::ByteReader& reader) {
    ViewState view;
    getEach(reader, view.head);
    getEach(reader, view.right);
    view.eyeSeparation = reader.get<double>();
    getEach(reader, view.sceneToRoom);
    view.pattern = reader.get<std::uint8_t>();
    view.layers = Overlays(reader.get<std::uint8_t>());
    view.stereo = reader.get<std::uint8_t>();
    return view;
}

base::Bytes FrameMessage::encode() const {
    base::ByteWriter writer;
    writer.putVarint(frame);
    view.encode(writer);
    writer.putVarint(auditTiles);
    writer.put(static_cast<std::uint8_t>((capture ? 1 : 0) | (stop ? 2 : 0) | (figures ? 4 : 0)));
    writer.putVarint(steps.size());
    for (const sand::Step& step : steps) {
        sand::encode(step, writer);
    }
    if (figures) {
        figures->encode(writer);
    }
    return writer.take();
}

FrameMessage FrameMessage::decode(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    FrameMessage message;
    message.frame = reader.getVarint();
    message.view = ViewState::decode(reader);
    message.auditTiles = static_cast<std::uint32_t>(reader.getVarint());
    const auto flags = reader.get<std::uint8_t>();
    message.capture = (flags & 1) != 0;
    message.stop = (flags & 2) != 0;
    const std::uint64_t steps = reader.getVarint();
    for (std::uint64_t i = 0; i < steps; ++i) {
        message.steps.push_back(sand::decodeStep(reader));
    }
    if ((flags & 4) != 0) {
        message.figures = WallFigures::decode(reader);
    }
    return message;
}

}  // namespace lockstep
