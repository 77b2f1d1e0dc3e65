// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace render_node {

/// Where GLX's extensions come from; a test brings its own. Drawables and displays are GLX's, opaque here.
struct GlxLoader {
    std::function<bool(const char* extension)> supports;
    std::function<void (*(const char* function))()> functionNamed;
    void* display = nullptr;
    int screen = 0;
};
using GlxDrawable = unsigned long;

/// Swaps of several windows, cards and hosts locked in hardware: GLX_NV_swap_group, where the driver has it.
///
/// It comes on top of the software barrier, never instead: the driver answers "joined" also where no sync cable is
/// plugged in. Leaves the group when it goes; the windows must still be there.
class SwapGroup {
public:
    SwapGroup(GlxLoader loader, const std::vector<GlxDrawable>& windows);
    ~SwapGroup();
    SwapGroup(const SwapGroup&) = delete;
    SwapGroup& operator=(const SwapGroup&) = delete;

    /// "no extension", "refused", "joined, no barrier", "joined".
    [[nodiscard]] const std::string& state() const { return state_; }
    [[nodiscard]] bool joined() const { return !joined_.empty(); }
    /// The first frames of a hardware barrier find the cards out of step.
    [[nodiscard]] int framesToIgnore() const { return bound_ ? 8 : 0; }

private:
    [[nodiscard]] std::string join(const std::vector<GlxDrawable>& windows);
    void leave();

    GlxLoader loader_;
    std::vector<GlxDrawable> joined_;
    bool bound_ = false;
    std::string state_;
};

/// Keeps eyes in turn on the retraces they belong to: GLX_OML_sync_control, where the driver has it.
///
/// Glasses change eyes with every retrace, seen or missed. So a swap is asked for a retrace of the right parity: one
/// that comes late waits one retrace more, and no eye sees the other's picture.
class EyesByRetrace {
public:
    EyesByRetrace(GlxLoader loader, GlxDrawable window);

    [[nodiscard]] bool available() const { return swap_ != nullptr; }
    /// Asks for the swap of the wall's frame. False where that is not possible and the caller must swap.
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
