// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/flow/active_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace sand::tin {
namespace {

// Limit for star times height. All fluxes of a vertex together are at most twice that. Doubles count exactly below
// 2^53.
constexpr double kExactSum = 0x1p51;

void note(std::vector<std::uint8_t>& together, std::size_t number, bool held) {
    together.resize(number / kHeldTogether + 1, 0);
    together.back() = together.back() != 0 || held ? 1 : 0;
}

/// Keeps the values at the indices `kept` of each array. `kept` must be ascending.
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

/// Replaces each mark by its new number. Returns the previous index of each number.
std::vector<std::int32_t> numberMarked(std::vector<std::int32_t>& marks) {
    std::vector<std::int32_t> kept(marks.size());
    std::int32_t count = 0;
    for (std::size_t i = 0; i < marks.size(); ++i) {
        const bool marked = marks[i] != kNoNumber;
        kept[index(count)] = static_cast<std::int32_t>(i);
        marks[i] = marked ? count : kNoNumber;
        count += marked ? 1 : 0;
    }
    kept.resize(index(count));
    return kept;
}

}  // namespace

void ActiveMesh::notice(std::int64_t volume, std::int64_t star) {
    largestStar_ = std::max(largestStar_, static_cast<double>(star));
    greatestHeight_ = std::max(greatestHeight_, std::abs(static_cast<double>(volume) / static_cast<double>(star)));
    if (!isWide_ && largestStar_ * greatestHeight_ >= kExactSum) {
        widen();
    }
}

void ActiveMesh::widen() {
    isWide_ = true;
    std::transform(volumes_.begin(), volumes_.end(), wide_.begin(),
                   [](double volume) { return static_cast<std::int64_t>(volume); });
}

std::int32_t ActiveMesh::addVertex(std::int64_t volume, std::int64_t star, double underside, bool spills, bool moving) {
    const auto number = static_cast<std::int32_t>(vertexCount());
    notice(volume, star);
    if (spills) {
        rim_.push_back(number);
    }
    volumes_.push_back(static_cast<double>(volume));
    wide_.push_back(volume);
    stars_.push_back(static_cast<double>(star));
    levels_.push_back({static_cast<double>(volume) / static_cast<double>(star), moving ? 1.0 : 0.0});
    undersides_.push_back(underside);
    unwatched_.push_back(~std::uint64_t{0});
    return number;
}

std::int32_t ActiveMesh::addFacet(const Facet& facet) {
    const auto number = static_cast<std::int32_t>(facetCount());
    first_.push_back(facet.corner[0]);
    second_.push_back(facet.corner[1]);
    third_.push_back(facet.corner[2]);
    squared_.push_back(facet.first);
    mixed_.push_back(facet.mixed);
    squaredAcross_.push_back(facet.second);
    start_.push_back(facet.start);
    sliding_.push_back(0);
    slid_.push_back(0);
    goesOn_.push_back(0);
    bare_.push_back(~std::uint64_t{0});
    note(heldFacets_, index(number),
         std::any_of(facet.corner.begin(), facet.corner.end(), [this](std::int32_t corner) { return isHeld(corner); }));
    return number;
}

void ActiveMesh::addEdge(const Edge& edge) {
    from_.push_back(edge.from);
    to_.push_back(edge.to);
    left_.push_back(edge.leftFacet);
    right_.push_back(edge.rightFacet);
    leftWeights_.push_back(edge.left);
    rightWeights_.push_back(edge.right);
    fluxes_.push_back(0);
    note(heldEdges_, edgeCount() - 1, isHeld(edge.from) || isHeld(edge.to));
}

void ActiveMesh::findHeld() {
    std::vector<std::uint8_t> held(vertexCount());
    std::transform(undersides_.begin(), undersides_.end(), held.begin(),
                   [](double underside) { return underside < kFree ? 1 : 0; });
    const auto find = [](std::vector<std::uint8_t>& together, std::size_t count, const auto& isHeld) {
        together.assign(count / kHeldTogether + 1, 0);
        for (std::size_t i = 0; i < count; ++i) {
            together[i / kHeldTogether] |= isHeld(i);
        }
    };
    find(heldFacets_, facetCount(), [&](std::size_t i) -> std::uint8_t {
        return held[index(first_[i])] | held[index(second_[i])] | held[index(third_[i])];
    });
    find(heldEdges_, edgeCount(),
         [&](std::size_t i) -> std::uint8_t { return held[index(from_[i])] | held[index(to_[i])]; });
    heldKnown_ = true;
}

Facet ActiveMesh::facet(std::int32_t number) const {
    Facet facet;
    facet.corner = {first_[index(number)], second_[index(number)], third_[index(number)]};
    return facet;
}

Edge ActiveMesh::edge(std::size_t number) const {
    return {.from = from_[number], .to = to_[number], .leftFacet = left_[number], .rightFacet = right_[number]};
}

void ActiveMesh::restart() {
    largestStar_ = greatestHeight_ = 0;
    isWide_ = alwaysWide_;
    heldKnown_ = false;
    std::fill(goesOn_.begin(), goesOn_.end(), 0.0);
}

void ActiveMesh::place(std::size_t vertex, std::int64_t volume, std::int64_t star, double underside, bool moving) {
    volumes_[vertex] = static_cast<double>(volume);
    stars_[vertex] = static_cast<double>(star);
    levels_[vertex] = {volumes_[vertex] / stars_[vertex], moving ? 1.0 : 0.0};
    undersides_[vertex] = underside;
    notice(volume, star);
    wide_[vertex] = volume;
}

void ActiveMesh::findUnwatched(std::vector<std::int32_t>& found) const {
    // Usually only one or two vertices of a thousand are found, so that the loop tests eight at once.
    constexpr std::size_t kAtOnce = 8;
    const auto isFound = [this](std::size_t i) { return static_cast<std::uint64_t>(flowed(i)) & unwatched_[i]; };
    for (std::size_t first = 0, count = vertexCount(); first < count; first += kAtOnce) {
        const std::size_t end = std::min(first + kAtOnce, count);
        std::uint64_t any = 0;
        for (std::size_t i = first; i < end; ++i) {
            any |= isFound(i);
        }
        for (std::size_t i = first; any != 0 && i < end; ++i) {
            if (isFound(i) != 0) {
                found.push_back(static_cast<std::int32_t>(i));
            }
        }
    }
}

std::span<const std::int32_t> ActiveMesh::slide(bool held, bool band, double momentum, std::size_t first) {
    if (held && !heldKnown_) {
        findHeld();
    }
    if (first == 0) {
        std::swap(slid_, goesOn_);
    }
    first -= first % kHeldTogether;
    slidBare_.resize(facetCount());
    const SweepFacets sweep{.facets = facetCount() - first,
                            .levels = levels_.data(),
                            .undersides = undersides_.data(),
                            .held = held ? heldFacets_.data() + first / kHeldTogether : nullptr,
                            .first = first_.data() + first,
                            .second = second_.data() + first,
                            .third = third_.data() + first,
                            .squared = squared_.data() + first,
                            .mixed = mixed_.data() + first,
                            .squaredAcross = squaredAcross_.data() + first,
                            .start = band ? start_.data() + first : nullptr,
                            .bare = bare_.data() + first,
                            .momentum = momentum,
                            .slid = slid_.data() + first,
                            .sliding = sliding_.data() + first,
                            .goesOn = goesOn_.data() + first,
                            .slidBare = slidBare_.data()};
    const std::size_t count = path_ != base::CodePath::baseline ? v3::slideFacets(sweep) : baseline::slideFacets(sweep);
    for (std::size_t i = 0; i < count; ++i) {
        slidBare_[i] += static_cast<std::int32_t>(first);
    }
    return {slidBare_.data(), count};
}

SweepResult ActiveMesh::move(bool held) {
    inflow_.resize(2 * vertexCount());
    const SweepEdges sweep{.edges = edgeCount(),
                           .levels = levels_.data(),
                           .undersides = undersides_.data(),
                           .held = held ? heldEdges_.data() : nullptr,
                           .sliding = sliding_.data(),
                           .from = from_.data(),
                           .to = to_.data(),
                           .left = left_.data(),
                           .right = right_.data(),
                           .leftWeights = leftWeights_.data(),
                           .rightWeights = rightWeights_.data(),
                           .fluxes = fluxes_.data()};
    path_ != base::CodePath::baseline ? v3::flowOverEdges(sweep) : baseline::flowOverEdges(sweep);
    if (isWide_) {
        return moveWide();
    }
    const SweepSand sand{.vertices = vertexCount(),
                         .edges = edgeCount(),
                         .from = from_.data(),
                         .to = to_.data(),
                         .fluxes = fluxes_.data(),
                         .stars = stars_.data(),
                         .unwatched = unwatched_.data(),
                         .rimVertices = rim_.size(),
                         .rim = rim_.data(),
                         .inflow = inflow_.data(),
                         .volumes = volumes_.data(),
                         .levels = levels_.data()};
    return path_ != base::CodePath::baseline ? v3::moveSand(sand) : baseline::moveSand(sand);
}

SweepResult ActiveMesh::moveWide() {
    wideInflow_.assign(vertexCount(), 0);
    for (Level& level : levels_) {
        level.flow = 0;
    }
    for (std::size_t i = 0; i < edgeCount(); ++i) {
        const auto flux = static_cast<std::int64_t>(fluxes_[i]);
        wideInflow_[index(from_[i])] -= flux;
        wideInflow_[index(to_[i])] += flux;
        levels_[index(from_[i])].flow += std::abs(fluxes_[i]);
        levels_[index(to_[i])].flow += std::abs(fluxes_[i]);
    }
    SweepResult result;
    for (const std::int32_t vertex : rim_) {
        const std::int64_t over = std::max<std::int64_t>(wide_[index(vertex)] + wideInflow_[index(vertex)], 0);
        wideInflow_[index(vertex)] -= over;
        levels_[index(vertex)].flow += static_cast<double>(over);
        result.outflow += over;
    }
    for (std::size_t i = 0; i < vertexCount(); ++i) {
        result.moved = result.moved || wideInflow_[i] != 0;
        result.met = result.met || (flowed(i) && !isWatched(i));
        result.resting += flowed(i) ? 0 : 1;
        wide_[i] += wideInflow_[i];
        levels_[i].height = static_cast<double>(wide_[i]) / stars_[i];
    }
    return result;
}

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
        marks.edges[i] = slides[index(left_[i])] | slides[index(right_[i])];
    }
    return marks;
}

ActiveMesh::Renumbering ActiveMesh::keep(const Marks& kept) {
    Renumbering now{std::vector<std::int32_t>(vertexCount(), kNoNumber),
                    std::vector<std::int32_t>(facetCount(), kNoNumber)};
    std::vector<std::int32_t> edges(edgeCount(), kNoNumber);
    for (std::size_t i = 0; i < facetCount(); ++i) {
        now.facets[i] = kept.facets[i] != 0 ? 0 : kNoNumber;
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
        if (now.facets[i] != kNoNumber) {
            now.vertices[index(first_[i])] = now.vertices[index(second_[i])] = now.vertices[index(third_[i])] = 0;
        }
    }
    // The next sweep computes all but goesOn_ again.
    keepMarked(numberMarked(edges), from_, to_, left_, right_, leftWeights_, rightWeights_);
    keepMarked(numberMarked(now.facets), first_, second_, third_, squared_, mixed_, squaredAcross_, start_, bare_,
               goesOn_);
    sliding_.resize(first_.size());
    slid_.resize(first_.size());
    fluxes_.resize(from_.size());
    keepMarked(numberMarked(now.vertices), volumes_, stars_, levels_, undersides_, unwatched_, wide_);
    const auto renumber = [](std::vector<std::int32_t>& names, const std::vector<std::int32_t>& by) {
        std::transform(names.begin(), names.end(), names.begin(), [&by](std::int32_t name) { return by[index(name)]; });
    };
    for (auto* ends : {&from_, &to_, &first_, &second_, &third_}) {
        renumber(*ends, now.vertices);
    }
    renumber(left_, now.facets);
    renumber(right_, now.facets);
    renumber(rim_, now.vertices);
    std::erase(rim_, kNoNumber);
    heldKnown_ = false;
    return now;
}

}  // namespace sand::tin
