// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/field_forms.hpp"
#include "lockstep/overlays.hpp"
#include "lockstep/wall_figures.hpp"
#include "sand/model/step.hpp"

namespace lockstep {

/// View of the wall in one frame: the eyes, the place of the scene in the room, and what is shown.
///
/// Every frame message holds all of it, so that no rank draws with the eyes of an earlier frame. At the barrier the
/// ranks prove that they drew the same view.
struct ViewState {
    std::array<double, 3> head{};          // [m] in the room, the midpoint of the eyes
    std::array<double, 3> right{1, 0, 0};  // unit vector from the left eye to the right one
    double eyeSeparation = 0;              // [m]
    // Matrix from scene units to metres in the room, column by column.
    std::array<double, 16> sceneToRoom{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::uint8_t pattern = 0;  // lockstep::Pattern that is shown instead of the sand; 0: the sand
    Overlays layers{};         // overlays that are shown with the sand
    std::uint8_t stereo = 0;   // walls::Stereo, which an operator may change
    bool swapEyes = false;     // walls::Wall::swapEyes, which an operator may change
    double humidity = 0;       // scene::Material::humidity, 0 to 1; wet sand is drawn darker
    // [pixel] of the window that the picture follows; 0: the size in the wall file (walls::shownInWindow)
    std::array<std::int32_t, 2> window{};

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("head", it.head);
        visit("right", it.right);
        visit("eye_separation", it.eyeSeparation);
        visit("scene_to_room", it.sceneToRoom);
        visit("pattern", it.pattern);
        visit("layers", it.layers);
        visit("stereo", it.stereo);
        visit("swap_eyes", it.swapEyes);
        visit("humidity", base::limited(it.humidity, 0, 1));
        visit("window", it.window);
    }
    friend bool operator==(const ViewState&, const ViewState&) = default;
};

/// A sentence for the people at one window, such as the answer to a key.
///
/// It is not part of the view that the ranks prove, so that a wall whose tiles show different answers agrees.
struct Answer {
    static constexpr std::size_t kLongest = 200;  // [byte]

    std::int32_t rank = 0;  // rank whose windows show it; 0: all tiles of the wall's lowest row
    std::string text;       // in UTF-8

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("rank", base::varint(it.rank));
        visit("text", base::text(it.text, kLongest));
    }
    friend bool operator==(const Answer&, const Answer&) = default;
};
inline constexpr std::size_t kMostAnswers = 64;  // in one frame message

/// Message that begins a frame: the master sends it to every rank once per frame.
struct FrameMessage {
    std::uint64_t frame = 0;
    ViewState view;
    std::uint32_t auditTiles = 0;        // number of hash tiles that each rank hashes again from memory
    bool capture = false;                // each render rank sends its pictures of this frame to the master
    bool stop = false;                   // this is the last frame
    bool sharp = false;                  // moving sand is drawn as finely as sand at rest
    std::vector<sand::Step> steps;       // to be applied before the frame is drawn
    std::vector<Answer> answers{};       // at most one for each rank; none in a frame with pictures
    std::optional<WallFigures> figures;  // only while Overlay::statistics is shown; the barrier does not compare them

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("frame", base::varint(it.frame));
        visit("view", it.view);
        visit("audit_tiles", base::varint(it.auditTiles));
        visit("flags", base::flags(it.capture, it.stop, it.sharp));
        visit("steps", base::upTo(it.steps, sand::kMostStepsOfAFrame));
        visit("answers", base::upTo(it.answers, kMostAnswers));
        visit("figures", it.figures);
    }
    friend bool operator==(const FrameMessage&, const FrameMessage&) = default;
};

}  // namespace lockstep
