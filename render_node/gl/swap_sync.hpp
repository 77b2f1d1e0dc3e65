// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render_node/gl/glx_loader.hpp"

namespace render_node {

/// Hardware lock of the swaps of several windows, cards and hosts. Uses GLX_NV_swap_group if the driver has it.
///
/// The software barrier stays in use, because the driver answers "joined" even if no sync cable is plugged in. The
/// destructor leaves the group; the windows must still exist then.
class SwapGroup {
public:
    SwapGroup(GlxLoader loader, const std::vector<GlxDrawable>& windows);
    ~SwapGroup();
    SwapGroup(const SwapGroup&) = delete;
    SwapGroup& operator=(const SwapGroup&) = delete;

    /// Returns "no extension", "refused", "joined, no barrier" or "joined".
    [[nodiscard]] const std::string& state() const { return state_; }
    [[nodiscard]] bool joined() const { return !joined_.empty(); }
    /// Returns the number of first frames in which a hardware barrier finds the cards out of step.
    [[nodiscard]] int framesToIgnore() const { return bound_ ? 8 : 0; }

private:
    [[nodiscard]] std::string join(const std::vector<GlxDrawable>& windows);
    void leave();

    GlxLoader loader_;
    std::vector<GlxDrawable> joined_;
    bool bound_ = false;
    std::string state_;
};

/// Swaps each eye's picture at a retrace of that eye. Uses GLX_OML_sync_control if the driver has it.
///
/// Shutter glasses change eyes with every retrace, even if a frame is late. So each swap is requested for a retrace of
/// the right parity. A late swap waits one more retrace, and no eye sees the other eye's picture.
class EyesByRetrace {
public:
    EyesByRetrace(GlxLoader loader, GlxDrawable window);

    [[nodiscard]] bool available() const { return swap_ != nullptr; }
    /// Requests the swap for the wall's frame `frame`. Returns false if that is not possible. The caller must then
    /// swap.
    [[nodiscard]] bool swap(std::uint64_t frame);

private:
    using Counts = int (*)(void* display, GlxDrawable, std::int64_t* ust, std::int64_t* msc, std::int64_t* sbc);
    using SwapAt = std::int64_t (*)(void* display, GlxDrawable, std::int64_t target, std::int64_t divisor,
                                    std::int64_t remainder);

    GlxLoader loader_;
    GlxDrawable window_;
    Counts counts_ = nullptr;
    SwapAt swap_ = nullptr;
    std::optional<std::int64_t> phase_;  // 0 or 1: parity of the retrace that shows frame 0
};

}  // namespace render_node
