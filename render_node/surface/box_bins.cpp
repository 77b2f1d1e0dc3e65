// SPDX-License-Identifier: Apache-2.0
#include "render_node/surface/box_bins.hpp"

#include <algorithm>

namespace render_node {

BoxBins::BoxBins(double width, double depth)
    : acrossWidth_(kSide / width), acrossDepth_(kSide / depth), bins_(static_cast<std::size_t>(kSide) * kSide) {}

void BoxBins::add(const shapes::Box& box) {
    const auto bin = [](double low, double high, double scale) {
        return std::clamp(static_cast<int>(0.5 * (low + high) * scale), 0, kSide - 1);
    };
    const int at = bin(box.low.y, box.high.y, acrossDepth_) * kSide + bin(box.low.x, box.high.x, acrossWidth_);
    std::optional<shapes::Box>& there = bins_[static_cast<std::size_t>(at)];
    if (!there) {
        used_.push_back(at);
        there = box;
    } else {
        there = around(*there, box);
    }
}

std::vector<shapes::Box> BoxBins::take() {
    std::sort(used_.begin(), used_.end());
    std::vector<shapes::Box> boxes;
    for (int shift = 0; boxes.empty() && !used_.empty(); ++shift) {
        const int side = kSide >> shift;
        std::vector<int> found(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), -1);
        for (const int at : used_) {
            const shapes::Box& box = *bins_[static_cast<std::size_t>(at)];
            int& index = found[static_cast<std::size_t>((at / kSide >> shift) * side + (at % kSide >> shift))];
            if (index < 0) {
                index = static_cast<int>(boxes.size());
                boxes.push_back(box);
            } else {
                shapes::Box& joined = boxes[static_cast<std::size_t>(index)];
                joined = around(joined, box);
            }
        }
        if (boxes.size() > kMostBoxes) {
            boxes.clear();
        }
    }
    for (const int at : used_) {
        bins_[static_cast<std::size_t>(at)].reset();
    }
    used_.clear();
    return boxes;
}

}  // namespace render_node
