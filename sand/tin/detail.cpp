// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/detail.hpp"

#include <cmath>
#include <cstdlib>

#include "sand/height_field.hpp"

namespace sand::tin {
namespace {

constexpr int kLooksPerRemoval = 16;
constexpr std::size_t kMostAround = 64;  // a vertex with more is looked at too dearly

std::int64_t square(std::int32_t coordinate, std::int32_t spacing) { return coordinate / spacing; }

/// The squares of a lattice that some box touches, and which of them hold something.
class Squares {
public:
    Squares(const Box& box, std::int32_t spacing)
        : spacing_(spacing),
          x0_(square(box.x0, spacing)),
          y0_(square(box.y0, spacing)),
          columns_(square(box.x1, spacing) - x0_ + 1),
          rows_(square(box.y1, spacing) - y0_ + 1),
          taken_(static_cast<std::size_t>(columns_ * rows_)) {}

    void take(const Place& place) {
        const std::int64_t column = square(place.x, spacing_) - x0_, row = square(place.y, spacing_) - y0_;
        if (column >= 0 && column < columns_ && row >= 0 && row < rows_) {
            taken_[static_cast<std::size_t>(row * columns_ + column)] = true;
        }
    }
    /// Takes all squares whose middle is so near to an edge.
    void takeBeside(const Place& from, const Place& to, std::int32_t distance) {
        const std::int32_t x0 = std::min(from.x, to.x) - distance, x1 = std::max(from.x, to.x) + distance;
        const std::int32_t y0 = std::min(from.y, to.y) - distance, y1 = std::max(from.y, to.y) + distance;
        for (std::int32_t y = std::max(y0, 0); y < y1 + spacing_; y += spacing_) {
            for (std::int32_t x = std::max(x0, 0); x < x1 + spacing_; x += spacing_) {
                if (isNear(middleOf(square(x, spacing_), square(y, spacing_)), from, to, distance)) {
                    take({x, y});
                }
            }
        }
    }
    /// Calls `use` with the middle of every square that nothing took.
    template <class Use>
    void forEachFree(const Use& use) const {
        for (std::int64_t row = 0; row < rows_; ++row) {
            for (std::int64_t column = 0; column < columns_; ++column) {
                if (!taken_[static_cast<std::size_t>(row * columns_ + column)]) {
                    use(middleOf(x0_ + column, y0_ + row));
                }
            }
        }
    }

private:
    [[nodiscard]] Place middleOf(std::int64_t column, std::int64_t row) const {
        return {static_cast<std::int32_t>(column * spacing_ + spacing_ / 2),
                static_cast<std::int32_t>(row * spacing_ + spacing_ / 2)};
    }

    std::int32_t spacing_;
    std::int64_t x0_, y0_, columns_, rows_;
    std::vector<bool> taken_;
};

/// How far a vertex or one around it lies from the plane that fits them best [unit]. Its own place is the origin: sums
/// of products of small numbers.
double farthestFromPlane(const Layer& layer, Vertex vertex, const Link& link) {
    const auto& places = layer.triangles().places;
    const Place origin = places[static_cast<std::size_t>(vertex)];
    const double base = layer.heights()[static_cast<std::size_t>(vertex)];
    struct Point {
        double x, y, z;
    };
    std::vector<Point> points{{0, 0, 0}};
    Point sum{};
    for (const Vertex other : link.vertices) {
        const Place place = places[static_cast<std::size_t>(other)];
        points.push_back({static_cast<double>(place.x - origin.x), static_cast<double>(place.y - origin.y),
                          layer.heights()[static_cast<std::size_t>(other)] - base});
        sum = {sum.x + points.back().x, sum.y + points.back().y, sum.z + points.back().z};
    }
    const auto count = static_cast<double>(points.size());
    double xx = 0, xy = 0, yy = 0, xz = 0, yz = 0;
    for (Point& point : points) {
        point = {point.x - sum.x / count, point.y - sum.y / count, point.z - sum.z / count};
        xx += point.x * point.x;
        xy += point.x * point.y;
        yy += point.y * point.y;
        xz += point.x * point.z;
        yz += point.y * point.z;
    }
    const double determinant = xx * yy - xy * xy;  // positive: they do not all lie on a line
    const double a = (xz * yy - yz * xy) / determinant, b = (yz * xx - xz * xy) / determinant;
    double farthest = 0;
    for (const Point& point : points) {
        farthest = std::max(farthest, std::abs(point.z - a * point.x - b * point.y));
    }
    return farthest;
}

std::int64_t candidates(const Layer& layer, const DetailRules& rules) {
    return static_cast<std::int64_t>(layer.triangles().triangleAt.size()) - rules.firstToGo;
}

/// Vertices that a step looks at, unless it removes as many as it may before.
std::int64_t looksOfStep(const Layer& layer, const DetailRules& rules) {
    return std::clamp<std::int64_t>(candidates(layer, rules), 0, std::int64_t{rules.removals} * kLooksPerRemoval);
}

}  // namespace

int refine(Mesh& mesh, const DetailRules& rules, const Box& box, const std::function<bool(const Place&)>& wanted,
           std::span<const Place> there, const Edges& edges) {
    const Box inside = box.clippedTo(mesh.triangles());
    if (rules.spacing <= 0 || inside.empty()) {
        return 0;
    }
    Squares squares(inside, rules.spacing);
    for (const Place& place : there) {
        squares.take(place);
    }
    for (const auto& [from, to] : edges) {
        squares.takeBeside(from, to, rules.spacing / 4);
    }
    std::vector<Place> places;
    const int room = rules.maxVertices - mesh.vertexCount();
    squares.forEachFree([&](const Place& middle) {
        const bool within = middle.x <= mesh.triangles().width && middle.y <= mesh.triangles().depth;
        if (static_cast<int>(places.size()) < room && within && wanted(middle)) {
            places.push_back(middle);
        }
    });
    mesh.insert(places);
    return static_cast<int>(places.size());
}

// The triangles before and after span the same vertices, but for the one that goes: all lie within `far` of a plane,
// and so do both surfaces, which are 2 far apart at most. The remap moves them by the mean of that at most.
int coarsen(Layer& layer, const DetailRules& rules, Vertex& next, const Box& keepOut) {
    if (rules.maxError <= 0) {
        return 0;
    }
    const auto count = static_cast<Vertex>(layer.triangles().triangleAt.size());
    const std::int64_t looks = looksOfStep(layer, rules);
    Link link;
    int removed = 0;
    for (std::int64_t look = 0; look < looks && removed < rules.removals; ++look, ++next) {
        next = next >= count || next < rules.firstToGo ? rules.firstToGo : next;
        const Triangles& mesh = layer.triangles();
        if (!mesh.alive(next) || keepOut.holds(mesh.places[static_cast<std::size_t>(next)])) {
            continue;
        }
        findLink(mesh, next, link);
        if (link.constrained || !link.closed || link.vertices.size() > kMostAround) {
            continue;
        }
        if (4 * farthestFromPlane(layer, next, link) <= rules.maxError && layer.remove(next)) {
            ++removed;
        }
    }
    return removed;
}

int Coarsening::step(Layer& layer, const DetailRules& rules, Vertex& next, const Box& keepOut) {
    inVain_ = keepOut == keepOut_ ? inVain_ : 0;
    keepOut_ = keepOut;
    const std::int64_t looks = rules.maxError > 0 ? looksOfStep(layer, rules) : 0;
    if (inVain_ < candidates(layer, rules)) {
        const int removed = coarsen(layer, rules, next, keepOut);
        inVain_ = removed > 0 ? 0 : inVain_ + looks;
        return removed;
    }
    if (looks > 0) {  // where coarsen() would stop
        const std::int64_t end = candidates(layer, rules) + rules.firstToGo;
        const std::int64_t first = next >= end || next < rules.firstToGo ? 0 : next - rules.firstToGo;
        const std::int64_t last = (first + looks - 1) % candidates(layer, rules);
        next = static_cast<Vertex>(rules.firstToGo + last + 1);
    }
    return 0;
}

void DetailRules::encode(files::ByteWriter& writer) const {
    writer.put(spacing);
    writer.put(maxError);
    writer.put(firstToGo);
    writer.put(removals);
    writer.put(maxVertices);
    writer.put(static_cast<std::uint8_t>(keepsConstraints ? 1 : 0));
}

DetailRules DetailRules::decode(files::ByteReader& reader) {
    DetailRules rules;
    rules.spacing = reader.get<std::int32_t>();
    rules.maxError = reader.get<double>();
    rules.firstToGo = reader.get<Vertex>();
    rules.removals = reader.get<std::int32_t>();
    rules.maxVertices = reader.get<std::int32_t>();
    const auto keeps = reader.get<std::uint8_t>();
    rules.keepsConstraints = keeps == 1;
    const bool sound = rules.spacing >= 0 && rules.spacing <= (1 << 22) && rules.maxError >= 0 &&
                       rules.maxError <= kMaxHeight && rules.firstToGo >= 0 && rules.removals >= 0 &&
                       rules.removals <= 65536 && rules.maxVertices >= 4 && keeps <= 1;
    if (!sound) {
        throw files::FormatError("rules of a TIN's detail that no scene gives");
    }
    return rules;
}

}  // namespace sand::tin
