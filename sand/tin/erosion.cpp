// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/erosion.hpp"

#include <algorithm>

namespace sand::tin {
namespace {

constexpr double kProbePerCell = 256;
constexpr int kSweepsTogether = 16;  // edges that have come to rest are looked at in vain so long

}  // namespace

Slopes slopesOf(std::int32_t threshold, std::int32_t startThreshold) {
    return {threshold / kProbePerCell, std::max(threshold, startThreshold) / kProbePerCell};
}

Erosion::Erosion(const Layer&, std::int32_t threshold, std::int32_t startThreshold) {
    changeThresholds(threshold, startThreshold);
}

void Erosion::changeThresholds(std::int32_t threshold, std::int32_t startThreshold) {
    slopes_ = slopesOf(threshold, startThreshold);
    active_.clear();
    wakeAll_ = true;
}

void Erosion::changed(const Layer&, const Mesh::Change& change) {
    weights_.forget(change.vertices);
    wake(active_.meshChanged(change));
    wake(change.vertices);
}

void Erosion::wake(const std::vector<Vertex>& vertices) {
    woken_.insert(woken_.end(), vertices.begin(), vertices.end());
}

bool Erosion::settled() const { return active_.empty() && woken_.empty() && !wakeAll_; }

int Erosion::sweep(Layer& layer, int sweeps, const Underside* held, std::vector<Vertex>& moved) {
    if (sweeps <= 0) {
        return 0;
    }
    wake(active_.takeReleased(held));
    active_.begin(layer, slopes_.start > slopes_.slide, held);
    watchWoken(layer);
    int done = 0;
    while (done < sweeps && !active_.empty()) {
        ++done;
        const bool still = !active_.sweep(layer, slopes_, weights_);
        // Counted over calls: a step of few sweeps, in which something always moves, would never look.
        const bool look = ++sinceLook_ >= kSweepsTogether;
        sinceLook_ = look ? 0 : sinceLook_;
        if (still || (look && active_.mostRest())) {
            active_.store(layer, moved);
            active_.forgetResting();
        }
    }
    active_.store(layer, moved);
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    return done;
}

void Erosion::watchWoken(const Layer& layer) {
    if (wakeAll_) {
        for (Vertex vertex = 0; vertex < static_cast<Vertex>(layer.triangles().places.size()); ++vertex) {
            active_.watch(layer, slopes_, weights_, vertex);
        }
    }
    for (const Vertex vertex : woken_) {
        active_.watch(layer, slopes_, weights_, vertex);
    }
    wakeAll_ = false;
    woken_.clear();
}

}  // namespace sand::tin
