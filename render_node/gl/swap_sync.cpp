// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/swap_sync.hpp"

#include <utility>

namespace render_node {
namespace {

constexpr unsigned kGroup = 1;    // in both functions 0 means "none"
constexpr unsigned kBarrier = 1;  // cards with the same sync signal meet in the barrier of this number

using JoinGroup = int (*)(void* display, GlxDrawable, unsigned group);
using BindBarrier = int (*)(void* display, unsigned group, unsigned barrier);
using MostGroups = int (*)(void* display, int screen, unsigned* groups, unsigned* barriers);

}  // namespace

SwapGroup::SwapGroup(GlxLoader loader, const std::vector<GlxDrawable>& windows)
    : loader_(std::move(loader)), state_(join(windows)) {}

SwapGroup::~SwapGroup() { leave(); }

std::string SwapGroup::join(const std::vector<GlxDrawable>& windows) {
    if (!loader_.supports("GLX_NV_swap_group")) {
        return "no extension";
    }
    const auto mostGroups = loader_.load<MostGroups>("glXQueryMaxSwapGroupsNV");
    const auto joinGroup = loader_.load<JoinGroup>("glXJoinSwapGroupNV");
    const auto bindBarrier = loader_.load<BindBarrier>("glXBindSwapBarrierNV");
    if (mostGroups == nullptr || joinGroup == nullptr || bindBarrier == nullptr) {
        return "no extension";
    }
    unsigned groups = 0;
    unsigned barriers = 0;
    if (mostGroups(loader_.display, loader_.screen, &groups, &barriers) == 0 || groups < kGroup) {
        return "refused";
    }
    for (const GlxDrawable window : windows) {
        if (joinGroup(loader_.display, window, kGroup) == 0) {
            leave();  // an incomplete group has no use, or could block without end
            return "refused";
        }
        joined_.push_back(window);
    }
    bound_ = barriers >= kBarrier && bindBarrier(loader_.display, kGroup, kBarrier) != 0;
    return bound_ ? "joined" : "joined, no barrier";
}

void SwapGroup::leave() {
    if (bound_) {
        loader_.load<BindBarrier>("glXBindSwapBarrierNV")(loader_.display, kGroup, 0);
        bound_ = false;
    }
    for (const GlxDrawable window : joined_) {
        loader_.load<JoinGroup>("glXJoinSwapGroupNV")(loader_.display, window, 0);
    }
    joined_.clear();
}

EyesByRetrace::EyesByRetrace(GlxLoader loader, GlxDrawable window) : loader_(std::move(loader)), window_(window) {
    if (!loader_.supports("GLX_OML_sync_control")) {
        return;
    }
    counts_ = loader_.load<Counts>("glXGetSyncValuesOML");
    swap_ = loader_.load<SwapAt>("glXSwapBuffersMscOML");
    std::int64_t ust = 0;
    std::int64_t msc = 0;
    std::int64_t sbc = 0;
    // Some drivers list the extension even for screens without a retrace.
    if (counts_ == nullptr || swap_ == nullptr || counts_(loader_.display, window_, &ust, &msc, &sbc) == 0) {
        swap_ = nullptr;
    }
}

bool EyesByRetrace::swap(std::uint64_t frame) {
    if (!available()) {
        return false;
    }
    const auto parity = static_cast<std::int64_t>(frame % 2);
    if (!phase_) {
        std::int64_t ust = 0;
        std::int64_t msc = 0;
        std::int64_t sbc = 0;
        if (counts_(loader_.display, window_, &ust, &msc, &sbc) == 0) {
            return false;
        }
        // Cards count retraces from different starts. All cards show their first frame at the same retrace, the next
        // one.
        phase_ = (msc + 1 + parity) % 2;
    }
    return swap_(loader_.display, window_, 0, 2, (parity + *phase_) % 2) >= 0;
}

}  // namespace render_node
