// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "tracking/room_mapping.hpp"

namespace tracking {

/// Which tracker, and how it stands in the room: the text of --track, or of a wall file.
///
///     none
///     trace:FILE.csv
///     opentrack:[HOST:]PORT
///     dtrack:[HOST:]PORT[:BODY]
///
/// and behind it, after blanks, any of  origin=X,Y,Z  axes=x,-z,y  eyes=RIGHT,UP,BACK  from=ADDRESS
/// (docs/head_tracking.md).
struct Source {
    enum class Kind : std::uint8_t { none, trace, opentrack, dtrack };

    Kind kind = Kind::none;
    std::string text;                  // without what stands behind it; for messages
    std::filesystem::path file;        // of a trace
    std::string host = "127.0.0.1";    // an address of this machine to listen on; to send to, for a sender
    std::string from;                  // the only address that packets are taken from; empty: any, on loopback
    std::uint16_t port = 0;            // 0: any free one, for tests
    int body = 0;                      // of DTrack, counted from 0 as in its packets
    std::optional<glm::dvec3> origin;  // [m]; nothing: where that kind of tracker usually has it
    glm::dmat3 axes{1.0};
    glm::dvec3 eyes{0};  // [m]

    /// Throws base::InputError that begins with `who`, such as "--track". `folder` is where a relative trace lies.
    static Source parse(std::string_view text, const std::string& who, const std::filesystem::path& folder = {});
    /// opentrack counts from where the head was when it was centred: from `restingEye` [m]; others from the room's 0.
    [[nodiscard]] RoomMapping mapping(glm::dvec3 restingEye) const;
};

}  // namespace tracking
