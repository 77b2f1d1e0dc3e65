// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "lockstep/frame_message.hpp"
#include "sand/scene.hpp"
#include "walls/wall.hpp"

namespace master {

/// From where the wall is seen, frame by frame: the viewer of the wall file, where the sand stands, the test pattern.
class ViewSource {
public:
    ViewSource(const walls::Wall& wall, const sand::Scene& scene);

    /// For this frame of the session.
    [[nodiscard]] lockstep::ViewState next(std::uint64_t frame);

    void showPattern(std::uint8_t pattern) { state_.pattern = pattern; }
    [[nodiscard]] std::uint8_t pattern() const { return state_.pattern; }

private:
    lockstep::ViewState state_;
};

}  // namespace master
