// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/byte_stream.hpp"
#include "haptic_bridge/hand/device.hpp"
#include "haptic_bridge/hand/hand_settings.hpp"
#include "haptic_bridge/loop/tick.hpp"

namespace haptic_bridge {

/// What a hand was told at one tick: with the steps of a session, all that its forces follow from.
struct TickInput {
    double time = 0;  // [s], of the device
    Pose pose;
    ArmReading reading;
    std::int64_t nowNs = 0;         // of the loop's clock
    std::int64_t surfaceAgeNs = 0;  // then
    std::uint64_t surfaceStep = 0;
    sand::ProbePoint around;  // FeltSand's, at height 0
};

/// What a device was, from a link's start to its end.
struct TrackHeader {
    bool body = false;  // false: a recording, which has no physics
    ArmPhysics physics;
    double scale = 1;  // Device::scale()
    HandSettings::Datum datum = HandSettings::Datum::surface;
    bool literal = false;  // Guards::Mode::literal
};

/// A piece of the track, as a message carries it and a journal keeps it: of one sitting, from a link's start to its
/// end, its header, or ticks that follow each other.
struct TrackPiece {
    std::uint32_t sitting = 0;
    bool begins = false;
    TrackHeader header;            // when it begins
    std::vector<TickInput> ticks;  // otherwise
};

[[nodiscard]] base::Bytes encode(const TrackPiece& piece);
/// Throws base::FormatError for bytes that encode() does not write.
[[nodiscard]] TrackPiece decodeTrackPiece(std::span<const std::uint8_t> bytes);

/// The most ticks of a piece, so that it is a message of usual length.
inline constexpr std::size_t kMostTicksInPiece = 400;

/// Passes everything on to a device, and remembers what it answered.
class NotedDevice : public Device {
public:
    explicit NotedDevice(std::unique_ptr<Device> device) : device_(std::move(device)) {}
    [[nodiscard]] Pose read(double time) override { return pose_ = device_->read(time); }
    void sendForce(sand::force::Vec3 force) override { device_->sendForce(force); }
    [[nodiscard]] const ArmPhysics* physics() const override { return device_->physics(); }
    [[nodiscard]] double scale() const override { return device_->scale(); }
    [[nodiscard]] ArmReading reading() const override { return device_->reading(); }
    [[nodiscard]] const TroubleCounts* troubles() const override { return device_->troubles(); }
    void shareForce(double share) override { device_->shareForce(share); }
    [[nodiscard]] SandWatcher* watcher() override { return device_->watcher(); }
    [[nodiscard]] bool finished(double time) const override { return device_->finished(time); }

    [[nodiscard]] const Pose& pose() const { return pose_; }
    [[nodiscard]] TrackHeader header(HandSettings::Datum datum, bool literal) const;

private:
    std::unique_ptr<Device> device_;
    Pose pose_;
};

/// The title line of --record's file, and one row: numbers in the shortest digits that give the same doubles again.
[[nodiscard]] std::string tickTitles();
void appendRow(const Tick& tick, std::string& text);

}  // namespace haptic_bridge
