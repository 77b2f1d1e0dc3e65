// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lockstep/cluster.hpp"
#include "sand/step.hpp"

namespace lockstep {

/// From where the wall is seen this frame; all of it in every frame, so that none ever shows an old eye.
struct ViewState {
    std::array<double, 3> head{};  // [m] in the room, between the eyes
    double eyeSeparation = 0;      // [m]
    friend bool operator==(const ViewState&, const ViewState&) = default;
};

/// All that a frame needs; broadcast by the master, once per frame.
struct FrameMessage {
    std::uint64_t frame = 0;
    ViewState view;
    std::uint32_t auditTiles = 0;  // hash tiles every rank reads again from memory
    bool capture = false;          // send the pictures of this frame to the master
    bool stop = false;             // the last frame
    std::vector<sand::Step> steps;

    [[nodiscard]] files::Bytes encode() const;
    /// Throws files::FormatError.
    static FrameMessage decode(std::span<const std::uint8_t> bytes);
    friend bool operator==(const FrameMessage&, const FrameMessage&) = default;
};

/// Messages up to this size go out in one broadcast of fixed length, so that nobody asks for the length first.
inline constexpr std::size_t kOneBroadcast = 1024;  // [byte]

/// Collective. The master gives the message; everyone gets it. Returns in `bytes` how long it was.
[[nodiscard]] FrameMessage broadcastFrame(const Cluster& cluster, const FrameMessage& fromMaster, std::size_t& bytes);

}  // namespace lockstep
