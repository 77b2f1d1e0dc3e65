// SPDX-License-Identifier: Apache-2.0
// Sand that rests is forgotten: what stays is numbered anew, in the order in which it was.
#include <algorithm>

#include "sand/tin/flow/active_mesh.hpp"

namespace sand::tin {
namespace {

/// Keeps those values of each array, whose places are given in ascending order.
template <class... Values>
void keepMarked(const std::vector<std::int32_t>& kept, std::vector<Values>&... arrays) {
    const auto keep = [&](auto& values) {
        for (std::size_t i = 0; i < kept.size(); ++i) {
            values[i] = values[index(kept[i])];
        }
        values.resize(kept.size());
    };
    (keep(arrays), ...);
}

/// Numbers what is marked, and returns where it was.
std::vector<std::int32_t> numberMarked(std::vector<std::int32_t>& marks) {
    std::vector<std::int32_t> kept(marks.size());
    std::int32_t count = 0;
    for (std::size_t i = 0; i < marks.size(); ++i) {
        const bool marked = marks[i] != kNobody;
        kept[index(count)] = static_cast<std::int32_t>(i);
        marks[i] = marked ? count : kNobody;
        count += marked ? 1 : 0;
    }
    kept.resize(index(count));
    return kept;
}

}  // namespace

std::int64_t ActiveMesh::restingCount() const {
    return std::count_if(levels_.begin(), levels_.end(), [](const Level& level) { return !(level.flow > 0); });
}

ActiveMesh::Marks ActiveMesh::whatMayFlow() const {
    std::vector<std::uint8_t> flows(vertexCount()), slides(facetCount());
    Marks marks{std::vector<std::uint8_t>(facetCount()), std::vector<std::uint8_t>(edgeCount())};
    for (std::size_t i = 0; i < flows.size(); ++i) {
        flows[i] = flowed(i) ? 1 : 0;
    }
    for (std::size_t i = 0; i < slides.size(); ++i) {
        marks.facets[i] = flows[index(first_[i])] | flows[index(second_[i])] | flows[index(third_[i])];
        slides[i] = sliding_[i] > 0 ? marks.facets[i] : 0;
    }
    for (std::size_t i = 0; i < marks.edges.size(); ++i) {
        marks.edges[i] = fluxes_[i] != 0 || (slides[index(left_[i])] | slides[index(right_[i])]) != 0 ? 1 : 0;
    }
    return marks;
}

ActiveMesh::Renumbering ActiveMesh::keep(const Marks& kept) {
    Renumbering now{std::vector<std::int32_t>(vertexCount(), kNobody),
                    std::vector<std::int32_t>(facetCount(), kNobody)};
    std::vector<std::int32_t> edges(edgeCount(), kNobody);
    for (std::size_t i = 0; i < facetCount(); ++i) {
        now.facets[i] = kept.facets[i] != 0 ? 0 : kNobody;
    }
    for (std::size_t i = 0; i < edgeCount(); ++i) {
        if (kept.edges[i] != 0) {
            edges[i] = 0;
            now.facets[index(left_[i])] = now.facets[index(right_[i])] = 0;
        } else {
            setBare(index(left_[i]), true);
            setBare(index(right_[i]), true);
        }
    }
    for (std::size_t i = 0; i < facetCount(); ++i) {
        if (now.facets[i] != kNobody) {
            now.vertices[index(first_[i])] = now.vertices[index(second_[i])] = now.vertices[index(third_[i])] = 0;
        }
    }
    // Slides are of the next sweep again; fluxes may go on in it.
    keepMarked(numberMarked(edges), from_, to_, left_, right_, leftWeights_, rightWeights_, fluxes_);
    keepMarked(numberMarked(now.facets), first_, second_, third_, squared_, mixed_, squaredAcross_, start_, bare_);
    sliding_.resize(first_.size());
    keepMarked(numberMarked(now.vertices), volumes_, stars_, levels_, undersides_, unwatched_, wide_);
    const auto renumber = [](std::vector<std::int32_t>& names, const std::vector<std::int32_t>& by) {
        std::transform(names.begin(), names.end(), names.begin(), [&by](std::int32_t name) { return by[index(name)]; });
    };
    for (auto* ends : {&from_, &to_, &first_, &second_, &third_}) {
        renumber(*ends, now.vertices);
    }
    renumber(left_, now.facets);
    renumber(right_, now.facets);
    heldKnown_ = false;
    return now;
}

}  // namespace sand::tin
