// SPDX-License-Identifier: Apache-2.0
#include "lockstep/frame_message.hpp"

#include <algorithm>

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

FrameMessage broadcastFrame(const Cluster& cluster, const FrameMessage& fromMaster, std::size_t& bytes) {
    std::array<std::uint8_t, kOneBroadcast> packet{};
    constexpr std::size_t kRoom = kOneBroadcast - sizeof(std::uint32_t);
    files::Bytes message;
    std::uint32_t length = 0;
    if (cluster.isMaster()) {
        message = fromMaster.encode();
        length = static_cast<std::uint32_t>(message.size());
        std::memcpy(packet.data(), &length, sizeof length);
        std::copy_n(message.begin(), std::min(message.size(), kRoom), packet.begin() + sizeof length);
    }
    MPI_Bcast(packet.data(), static_cast<int>(packet.size()), MPI_BYTE, kMaster, cluster.frames());
    std::memcpy(&length, packet.data(), sizeof length);
    bytes = length;
    message.resize(length);
    std::copy_n(packet.begin() + sizeof length, std::min<std::size_t>(length, kRoom), message.begin());
    if (length > kRoom) {  // a long catch-up
        MPI_Bcast(message.data() + kRoom, static_cast<int>(length - kRoom), MPI_BYTE, kMaster, cluster.frames());
    }
    return FrameMessage::decode(message);
}

}  // namespace lockstep
