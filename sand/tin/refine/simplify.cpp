// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/refine/simplify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>

namespace sand::tin {
namespace {

constexpr std::int64_t kNone = -1;
constexpr std::size_t kVerticesPerReport = 256;  // [vertex]

std::int64_t floorDivided(std::int64_t value, std::int64_t by /* positive */) {
    return value >= 0 ? value / by : -((-value + by - 1) / by);
}
std::int64_t ceilDivided(std::int64_t value, std::int64_t by) { return -floorDivided(-value, by); }

/// The sample of a triangle that is farthest from the surface.
struct Worst {
    double error = 0;
    std::int64_t sample = kNone;
    std::int32_t slot = kNoNumber;
    std::uint32_t version = 0;  // of the slot when the error was measured; a newer version makes it invalid
    /// Orders a heap: the largest error is on top, and of equal errors the first sample.
    friend bool operator<(const Worst& a, const Worst& b) {
        return a.error != b.error ? a.error < b.error : a.sample > b.sample;
    }
};

/// The errors of all samples against the surface of a mesh. They are updated as the mesh changes.
class Errors {
public:
    Errors(const Raster& raster, const Mesh& mesh, const std::vector<double>& heights, bool reports = true)
        : raster_(raster),
          mesh_(mesh.triangles()),
          heights_(heights),
          errors_(reports ? raster.heights.size() : 0),
          used_(raster.heights.size()) {}

    /// Marks a sample as a vertex, because rounding may show an error there that no insertion removes.
    void use(std::int64_t sample) { used_[static_cast<std::size_t>(sample)] = true; }

    void measure(std::span<const std::int32_t> slots) {
        versions_.resize(mesh_.triangles.size());
        for (const std::int32_t slot : slots) {
            ++versions_[static_cast<std::size_t>(slot)];
            if (mesh_.triangles[static_cast<std::size_t>(slot)].alive()) {
                measure(slot);
            }
        }
    }
    /// Returns the worst sample that is not a vertex. Its `sample` is kNone if all samples are exact.
    [[nodiscard]] Worst worst() {
        while (!heap_.empty() && heap_.top().version != versions_[static_cast<std::size_t>(heap_.top().slot)]) {
            heap_.pop();
        }
        return heap_.empty() ? Worst{} : heap_.top();
    }
    void report(Simplified& result) {
        result.maxError = worst().error;
        if (errors_.empty()) {
            return;
        }
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < errors_.size(); ++i) {
            if (!std::isnan(raster_.heights[i]) && !used_[i]) {
                sum += errors_[i] * errors_[i];
            }
            count += std::isnan(raster_.heights[i]) ? 0 : 1;
        }
        result.rmsError = std::sqrt(sum / count);
    }

private:
    /// Corners from the smallest number on, not as in the slot. The rounding of heights then depends only on the mesh.
    struct Corners {
        std::array<LatticePoint, 3> places;
        std::array<double, 3> heights;
    };
    [[nodiscard]] Corners cornersOf(std::int32_t slot) const {
        std::array<Vertex, 3> corner = mesh_.triangles[static_cast<std::size_t>(slot)].corner;
        std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
        Corners corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            corners.places[k] = mesh_.places[static_cast<std::size_t>(corner[k])];
            corners.heights[k] = heights_[static_cast<std::size_t>(corner[k])];
        }
        return corners;
    }

    /// Measures every sample in the triangle or on its edges, row by row.
    void measure(std::int32_t slot) {
        const Corners corners = cornersOf(slot);
        const auto& p = corners.places;
        const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
        const std::int64_t firstRow = std::max<std::int64_t>(ceilDivided(low - raster_.first.y, raster_.spacing.y), 0);
        const std::int64_t lastRow =
            std::min<std::int64_t>(floorDivided(high - raster_.first.y, raster_.spacing.y), raster_.rows - 1);
        Worst worst{0, kNone, slot, versions_[static_cast<std::size_t>(slot)]};
        for (std::int64_t row = firstRow; row <= lastRow; ++row) {
            measureRow(corners, row, worst);
        }
        if (worst.sample != kNone) {
            heap_.push(worst);
        }
    }

    /// Returns the columns of a row within the triangle. The result is exact, because every edge bounds a half plane
    /// of integers.
    [[nodiscard]] std::pair<std::int64_t, std::int64_t> columnsOf(const Corners& corners, std::int64_t row) const {
        const std::int64_t y = raster_.first.y + row * raster_.spacing.y;
        std::int64_t first = 0, last = raster_.columns - 1;
        for (std::size_t k = 0; k < 3; ++k) {
            const LatticePoint &a = corners.places[k], &b = corners.places[(k + 1) % 3];
            const std::int64_t rise = std::int64_t{b.y} - a.y, run = std::int64_t{b.x} - a.x;
            // x = a.x + run (y - a.y) / rise, in columns, with one quotient.
            const std::int64_t way = (a.x - raster_.first.x) * rise + run * (y - a.y);
            if (rise > 0) {
                last = std::min(last, floorDivided(way, rise * raster_.spacing.x));
            } else if (rise < 0) {
                first = std::max(first, ceilDivided(-way, -rise * raster_.spacing.x));
            }
        }
        return {first, last};
    }

    void measureRow(const Corners& corners, std::int64_t row, Worst& worst) {
        const auto [first, last] = columnsOf(corners, row);
        if (first > last) {
            return;
        }
        const auto& p = corners.places;
        const std::int64_t start = row * raster_.columns + first;
        const LatticePoint place = raster_.placeOf(static_cast<std::size_t>(start));
        // Doubled areas are below 2^45 and exact in a double. Gradients are not used, because those of slivers are
        // huge.
        double w0 = static_cast<double>(doubledArea(place, p[1], p[2]));
        double w1 = static_cast<double>(doubledArea(p[0], place, p[2]));
        double w2 = static_cast<double>(doubledArea(p[0], p[1], place));
        const double step = raster_.spacing.x;
        const double d0 = step * (p[1].y - p[2].y), d1 = step * (p[2].y - p[0].y), d2 = step * (p[0].y - p[1].y);
        const double area = w0 + w1 + w2;
        const auto& z = corners.heights;
        for (std::int64_t sample = start; sample <= start + last - first; ++sample, w0 += d0, w1 += d1, w2 += d2) {
            const auto index = static_cast<std::size_t>(sample);
            const double error = std::abs(raster_.heights[index] - (w0 * z[0] + w1 * z[1] + w2 * z[2]) / area);
            if (!errors_.empty()) {
                errors_[index] = error;
            }
            if (error > worst.error && !used_[index]) {  // always false for a sample without data
                worst.error = error;
                worst.sample = sample;
            }
        }
    }

    const Raster& raster_;
    const Triangles& mesh_;
    const std::vector<double>& heights_;
    std::vector<double> errors_;  // by sample, from the last change of its triangle; empty if errors are not reported
    std::vector<bool> used_;
    std::vector<std::uint32_t> versions_;  // by slot
    std::priority_queue<Worst> heap_;
};

void check(std::int32_t width, std::int32_t depth, const Raster& raster) {
    const auto samples =
        static_cast<std::size_t>(std::max(raster.columns, 0)) * static_cast<std::size_t>(std::max(raster.rows, 0));
    const std::int64_t east = raster.first.x + std::int64_t{raster.spacing.x} * (raster.columns - 1);
    const std::int64_t north = raster.first.y + std::int64_t{raster.spacing.y} * (raster.rows - 1);
    if (samples == 0 || samples != raster.heights.size() || std::min(raster.spacing.x, raster.spacing.y) < 1 ||
        std::min(raster.first.x, raster.first.y) < 0 || east > width || north > depth) {
        throw std::invalid_argument("a raster that does not lie in its field");
    }
    if (std::any_of(raster.heights.begin(), raster.heights.end(), [](double height) { return std::isinf(height); })) {
        throw std::invalid_argument("a raster with infinite heights");
    }
}

/// Returns the height of the nearest sample with data. If two are equally near, the first counts.
double nearestHeight(const Raster& raster, const LatticePoint& place) {
    std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
    double height = 0;
    for (std::size_t i = 0; i < raster.heights.size(); ++i) {
        const LatticePoint sample = raster.placeOf(i);
        const std::int64_t dx = std::int64_t{sample.x} - place.x, dy = std::int64_t{sample.y} - place.y;
        if (!std::isnan(raster.heights[i]) && dx * dx + dy * dy < nearest) {
            nearest = dx * dx + dy * dy;
            height = raster.heights[i];
        }
    }
    if (nearest == std::numeric_limits<std::int64_t>::max()) {
        throw std::invalid_argument("a raster without data");
    }
    return height;
}

/// Returns the sample at a place, or kNone.
std::int64_t sampleAt(const Raster& raster, const LatticePoint& place) {
    const std::int64_t x = std::int64_t{place.x} - raster.first.x, y = std::int64_t{place.y} - raster.first.y;
    const bool on = x >= 0 && y >= 0 && x % raster.spacing.x == 0 && y % raster.spacing.y == 0 &&
                    x / raster.spacing.x < raster.columns && y / raster.spacing.y < raster.rows;
    return on ? y / raster.spacing.y * raster.columns + x / raster.spacing.x : kNone;
}

}  // namespace

Simplified simplify(std::int32_t width, std::int32_t depth, const Raster& raster, const SimplifyGoal& goal,
                    const Border& given, const std::function<void(double share)>& done) {
    check(width, depth, raster);
    if (goal.maxVertices < 4) {
        throw std::invalid_argument("fewer than 4 vertices: a field has 4 corners");
    }
    Mesh mesh(width, depth);
    Simplified result;
    Errors errors(raster, mesh, result.heights, goal.reports);
    for (Vertex corner = 0; corner < 4; ++corner) {
        const LatticePoint place = mesh.triangles().places[static_cast<std::size_t>(corner)];
        result.places.push_back(place);
        result.heights.push_back(nearestHeight(raster, place));
        if (const std::int64_t sample = sampleAt(raster, place);
            sample != kNone && !std::isnan(raster.heights[static_cast<std::size_t>(sample)])) {
            errors.use(sample);
        }
    }
    mesh.insert(given.places);
    for (const auto& [a, b] : given.edges) {
        mesh.constrain(a, b);
    }
    for (const LatticePoint& place : given.places) {
        if (const std::int64_t sample = sampleAt(raster, place); sample != kNone) {
            errors.use(sample);
        }
    }
    result.places.insert(result.places.end(), given.places.begin(), given.places.end());
    result.heights.insert(result.heights.end(), given.heights.begin(), given.heights.end());
    static_cast<void>(mesh.takeChange());
    std::vector<std::int32_t> all(mesh.triangles().triangles.size());
    for (std::size_t slot = 0; slot < all.size(); ++slot) {
        all[slot] = static_cast<std::int32_t>(slot);
    }
    errors.measure(all);
    for (Worst worst = errors.worst(); worst.sample != kNone && worst.error > goal.maxError &&
                                       static_cast<int>(result.places.size()) < goal.maxVertices;
         worst = errors.worst()) {
        const auto sample = static_cast<std::size_t>(worst.sample);
        result.places.push_back(raster.placeOf(sample));
        result.heights.push_back(raster.heights[sample]);
        errors.use(worst.sample);
        mesh.insert(result.places.back());
        errors.measure(mesh.takeChange().triangles);
        if (done && result.places.size() % kVerticesPerReport == 0) {
            done(static_cast<double>(result.places.size()) / goal.maxVertices);
        }
    }
    errors.report(result);
    return result;
}

Simplified measured(std::int32_t width, std::int32_t depth, const Raster& raster, std::span<const LatticePoint> places,
                    std::span<const double> heights) {
    check(width, depth, raster);
    Mesh mesh(width, depth);
    Simplified result;
    for (Vertex corner = 0; corner < 4; ++corner) {
        result.places.push_back(mesh.triangles().places[static_cast<std::size_t>(corner)]);
        result.heights.push_back(nearestHeight(raster, result.places.back()));
    }
    const std::vector<Vertex> vertices = mesh.insert(places);
    Errors errors(raster, mesh, result.heights);
    result.heights.resize(mesh.triangles().places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        result.heights[static_cast<std::size_t>(vertices[i])] = heights[i];
    }
    result.places = mesh.triangles().places;
    std::vector<std::int32_t> all(mesh.triangles().triangles.size());
    for (std::size_t slot = 0; slot < all.size(); ++slot) {
        all[slot] = static_cast<std::int32_t>(slot);
    }
    errors.measure(all);
    errors.report(result);
    return result;
}

}  // namespace sand::tin
