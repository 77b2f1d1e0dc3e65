// SPDX-License-Identifier: Apache-2.0
#include "lockstep/session_message.hpp"

#include "lockstep/frame_barrier.hpp"

namespace lockstep {

base::Bytes SessionMessage::encode() const {
    base::ByteWriter writer;
    writer.putBlock(scene);
    writer.putBlock(wall);
    writer.put(frameTimeout);
    writer.putVarint(faults.size());
    for (const Fault& fault : faults) {
        fault.encode(writer);
    }
    writer.put(static_cast<std::uint8_t>(pointer ? 1 : 0));
    writer.putBlock(state);
    return writer.take();
}

SessionMessage SessionMessage::decode(std::span<const std::uint8_t> bytes) {
    base::ByteReader reader(bytes);
    SessionMessage session;
    const auto scene = reader.getBlock();
    session.scene.assign(scene.begin(), scene.end());
    const auto wall = reader.getBlock();
    session.wall.assign(wall.begin(), wall.end());
    session.frameTimeout = reader.get<double>();
    const std::uint64_t faults = reader.getVarint();
    for (std::uint64_t i = 0; i < faults; ++i) {
        session.faults.push_back(Fault::decode(reader));
    }
    session.pointer = reader.get<std::uint8_t>() != 0;
    const auto state = reader.getBlock();
    session.state.assign(state.begin(), state.end());
    return session;
}

std::optional<SessionMessage> broadcastSession(const Cluster& cluster,
                                               const std::optional<SessionMessage>& fromMaster) {
    cluster.mayTakeLong(true);
    const base::Bytes bytes = cluster.broadcast(fromMaster ? fromMaster->encode() : base::Bytes{});
    cluster.mayTakeLong(false);
    if (bytes.empty()) {
        return std::nullopt;
    }
    return SessionMessage::decode(bytes);
}

std::vector<Readiness> gatherReadiness(const Cluster& cluster, const Readiness& mine) {
    base::ByteWriter writer;
    for (const std::string& text : {mine.host, mine.buildId, mine.error, mine.renderer, mine.otherFloats, mine.tile}) {
        writer.putText(text);
    }
    writer.putVarint(mine.shortcomings.size());
    for (const std::string& line : mine.shortcomings) {
        writer.putText(line);
    }
    writer.put(mine.framesToIgnore);
    std::vector<Readiness> result;
    for (const base::Bytes& bytes : cluster.gather(writer.take())) {
        base::ByteReader reader(bytes);
        Readiness& rank = result.emplace_back();
        for (std::string* text :
             {&rank.host, &rank.buildId, &rank.error, &rank.renderer, &rank.otherFloats, &rank.tile}) {
            *text = reader.getText();
        }
        rank.shortcomings.resize(reader.getVarint());
        for (std::string& line : rank.shortcomings) {
            line = reader.getText();
        }
        rank.framesToIgnore = reader.get<std::uint32_t>();
    }
    return result;
}

bool agreeToGoOn(const Cluster& cluster, bool master) {
    int goOn = master ? 1 : 0;
    MPI_Bcast(&goOn, 1, MPI_INT, kMaster, cluster.frames());
    return goOn != 0;
}

std::vector<RankReport> gatherReports(FrameBarrier& barrier, const RankReport& mine) {
    base::ByteWriter writer;
    writer.putText(mine.host);
    writer.putText(mine.renderer);
    writer.putText(mine.swapLock);
    for (const double figure : {mine.drawP50, mine.drawP99, mine.drawMax, mine.waitP50, mine.waitP99}) {
        writer.put(figure);
    }
    writer.put(mine.residentBytes);
    for (const std::int64_t count : {mine.frameBufferBytes, mine.viewsSkipped, mine.viewsInPart, mine.viewsWhole}) {
        writer.put(count);
    }
    writer.put(mine.pixelShare);
    const std::vector<base::Bytes> all = barrier.collect(writer.take());
    std::vector<RankReport> result;
    for (std::size_t rank = 1; rank < all.size(); ++rank) {
        base::ByteReader reader(all[rank]);
        RankReport& report = result.emplace_back();
        report.host = reader.getText();
        report.renderer = reader.getText();
        report.swapLock = reader.getText();
        for (double* figure : {&report.drawP50, &report.drawP99, &report.drawMax, &report.waitP50, &report.waitP99}) {
            *figure = reader.get<double>();
        }
        report.residentBytes = reader.get<std::int64_t>();
        for (std::int64_t* count :
             {&report.frameBufferBytes, &report.viewsSkipped, &report.viewsInPart, &report.viewsWhole}) {
            *count = reader.get<std::int64_t>();
        }
        report.pixelShare = reader.get<double>();
    }
    return result;
}

}  // namespace lockstep
