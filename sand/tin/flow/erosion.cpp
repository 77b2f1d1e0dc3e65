// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/flow/erosion.hpp"

#include <algorithm>
#include <numeric>

#include "sand/model/momentum.hpp"
#include "sand/tin/mesh/neighbourhood.hpp"

namespace sand::tin {
namespace {

constexpr double kCellSide = 256;  // [probe unit]

}  // namespace

Slopes slopesOf(std::int32_t threshold, std::int32_t startThreshold) {
    return {threshold / kCellSide, std::max(threshold, startThreshold) / kCellSide};
}

Erosion::Erosion(const VertexSand&, std::int32_t threshold, std::int32_t startThreshold, Rim rim) : active_(rim) {
    changeThresholds(threshold, startThreshold);
}

void Erosion::reserve(std::size_t vertices) {
    weights_.reserve(vertices);
    active_.reserve(vertices);
}

void Erosion::changeThresholds(std::int32_t threshold, std::int32_t startThreshold) {
    slopes_ = slopesOf(threshold, startThreshold);
    active_.clear();
    wakeAll_ = true;
}

void Erosion::changed(const VertexSand&, const Mesh::Change& change) {
    weights_.forget(change);
    wake(active_.meshChanged(change));
    wake(change.vertices);
}

void Erosion::wake(const std::vector<Vertex>& vertices) {
    woken_.insert(woken_.end(), vertices.begin(), vertices.end());
}

bool Erosion::settled() const { return active_.empty() && woken_.empty() && !wakeAll_; }

int Erosion::sweep(VertexSand& layer, int sweeps, const Underside* held, std::vector<Vertex>& moved) {
    return run(layer, sweeps, held, moved, true);
}

int Erosion::settle(VertexSand& layer, int most, std::vector<Vertex>& moved) {
    return run(layer, most, nullptr, moved, false);
}

int Erosion::run(VertexSand& layer, int sweeps, const Underside* held, std::vector<Vertex>& moved, bool momentum) {
    if (sweeps <= 0) {
        return 0;
    }
    wake(active_.takeReleased(held));
    active_.begin(layer, slopes_.start > slopes_.slide, held);
    watchWoken(layer);
    int done = 0;
    while (done < sweeps && !active_.empty()) {
        // Every call begins without momentum, because earlier fluxes are not part of the state.
        const double goesOn = momentum ? momentumAfter<double>(done, dampingOf(sweeps)) : 0;
        const bool still = !active_.sweep(layer, slopes_, weights_, goesOn);
        ++done;
        if (still || active_.manyRest()) {
            active_.store(layer, moved);
            active_.forgetResting();
        }
    }
    active_.store(layer, moved);
    active_.storeMotion(layer, moved);
    sortOnce(moved);
    return done;
}

void Erosion::watchWoken(const VertexSand& layer) {
    if (wakeAll_) {
        woken_.resize(layer.triangles().places.size());
        std::iota(woken_.begin(), woken_.end(), 0);
    }
    active_.wake(layer, slopes_, woken_);
    wakeAll_ = false;
    woken_.clear();
}

}  // namespace sand::tin
