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

/// Tracker and its place in the room, read from the text of --track or of a wall file. The text is one of
///
///     none
///     trace:FILE.csv
///     opentrack:[HOST:]PORT
///     dtrack:[HOST:]PORT[:BODY]
///
/// After blanks, any of  origin=X,Y,Z  axes=x,-z,y  eyes=RIGHT,UP,BACK  from=ADDRESS  may follow
/// (docs/head_tracking.md).
struct Source {
    enum class Kind : std::uint8_t { none, trace, opentrack, dtrack };

    Kind kind = Kind::none;
    std::string text;                  // without the words origin=, axes=, eyes= and from=; for messages
    std::filesystem::path file;        // file of a trace
    std::string host = "127.0.0.1";    // address of this machine to listen on; for a sender, the address to send to
    std::string from;                  // only address from which packets are accepted; empty: any address, on loopback
    std::uint16_t port = 0;            // 0: any free port, for tests
    int body = 0;                      // DTrack's body, counted from 0 as in its packets
    std::optional<glm::dvec3> origin;  // [m]; nullopt: the usual origin of that kind of tracker
    glm::dmat3 axes{1.0};
    glm::dvec3 eyes{0};  // [m]

    /// Parses a source. Throws base::InputError that begins with `name`, such as "--track". A relative trace is in
    /// `folder`.
    static Source parse(std::string_view text, const std::string& name, const std::filesystem::path& folder = {});
    /// Returns the mapping to the room. Without origin=, opentrack's origin is `restingEye` [m], because opentrack
    /// counts from the place where the head was centred. The origin of other trackers is the room's.
    [[nodiscard]] RoomMapping mapping(glm::dvec3 restingEye) const;
};

}  // namespace tracking
