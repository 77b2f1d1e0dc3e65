// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/byte_stream.hpp"
#include "lockstep/overlays.hpp"
#include "lockstep/wall_figures.hpp"
#include "sand/model/step.hpp"

namespace lockstep {

/// From where the wall is seen this frame; all of it in every frame, so that none ever shows an old eye, and part of
/// what the ranks must agree on.
struct ViewState {
    std::array<double, 3> head{};          // [m] in the room, between the eyes
    std::array<double, 3> right{1, 0, 0};  // unit vector from the left eye to the right one
    double eyeSeparation = 0;              // [m]
    // Column by column: scene units to metres in the room.
    std::array<double, 16> sceneToRoom{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::uint8_t pattern = 0;  // lockstep::Pattern shown instead of the sand
    Overlays layers{};         // shown beside the sand
    std::uint8_t stereo = 0;   // walls::Stereo, which an operator may change

    void encode(base::ByteWriter& writer) const;
    /// Throws base::FormatError when cut short.
    static ViewState decode(base::ByteReader& reader);
    friend bool operator==(const ViewState&, const ViewState&) = default;
};

/// All that a frame needs; sent by the master to every rank, once per frame.
struct FrameMessage {
    std::uint64_t frame = 0;
    ViewState view;
    std::uint32_t auditTiles = 0;  // hash tiles every rank reads again from memory
    bool capture = false;          // send the pictures of this frame to the master
    bool stop = false;             // the last frame
    std::vector<sand::Step> steps;
    std::optional<WallFigures> figures;  // while Overlay::statistics is shown; what they say need not agree

    [[nodiscard]] base::Bytes encode() const;
    /// Throws base::FormatError.
    static FrameMessage decode(std::span<const std::uint8_t> bytes);
    friend bool operator==(const FrameMessage&, const FrameMessage&) = default;
};

}  // namespace lockstep
