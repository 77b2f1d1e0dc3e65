// SPDX-License-Identifier: Apache-2.0
#include "lockstep/frame_message.hpp"

namespace lockstep {

files::Bytes FrameMessage::encode() const {
    files::ByteWriter writer;
    writer.putVarint(frame);
    for (const double coordinate : view.head) {
        writer.put(coordinate);
    }
    writer.put(view.eyeSeparation);
    writer.putVarint(auditTiles);
    writer.put(static_cast<std::uint8_t>((capture ? 1 : 0) | (stop ? 2 : 0)));
    writer.putVarint(steps.size());
    for (const sand::Step& step : steps) {
        sand::encode(step, writer);
    }
    return writer.take();
}

FrameMessage FrameMessage::decode(std::span<const std::uint8_t> bytes) {
    files::ByteReader reader(bytes);
    FrameMessage message;
    message.frame = reader.getVarint();
    for (double& coordinate : message.view.head) {
        coordinate = reader.get<double>();
    }
    message.view.eyeSeparation = reader.get<double>();
    message.auditTiles = static_cast<std::uint32_t>(reader.getVarint());
    const auto flags = reader.get<std::uint8_t>();
    message.capture = (flags & 1) != 0;
    message.stop = (flags & 2) != 0;
    const std::uint64_t steps = reader.getVarint();
    for (std::uint64_t i = 0; i < steps; ++i) {
        message.steps.push_back(sand::decodeStep(reader));
    }
    return message;
}

}  // namespace lockstep
