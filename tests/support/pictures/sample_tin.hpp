// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "sand/model/surface_data.hpp"
#include "sand/tin/geometry/surface_view.hpp"
#include "tests/support/pictures/sample_scene.hpp"

namespace sample {

/// A TIN whose triangles are made and changed by hand. They need not be Delaunay triangles, because the drawing code
/// must work with any triangles.
class Tin {
public:
    using Vertex = sand::tin::Vertex;
    using Slot = std::int32_t;

    /// Makes the surface as which a height field is drawn, with the same vertices and diagonals.
    explicit Tin(const sand::HeightField& field) {
        const int columns = field.columns(), rows = field.rows(), across = columns + 2;
        const auto along = [](int vertex, int cells) {
            return std::clamp(2 * vertex - 1, 0, 2 * cells) * sand::kProbePerCell / 2;
        };
        for (int row = 0; row < rows + 2; ++row) {
            for (int column = 0; column < across; ++column) {
                mesh_.places.push_back({along(column, columns), along(row, rows)});
                heights_.push_back(
                    field.height(std::clamp(column - 1, 0, columns - 1), std::clamp(row - 1, 0, rows - 1)));
            }
        }
        for (int y = 0; y < rows + 1; ++y) {
            for (int x = 0; x < columns + 1; ++x) {
                const Vertex a = y * across + x, b = a + 1, d = a + across, c = d + 1;
                const bool rising = (x + y) % 2 == 0;
                add({a, b, rising ? c : d});
                add({rising ? a : b, c, d});
            }
        }
        mesh_.width = columns * sand::kProbePerCell;
        mesh_.depth = rows * sand::kProbePerCell;
        link();
        change_ = {};
    }

    [[nodiscard]] sand::tin::SurfaceView view() const { return {mesh_, heights_}; }
    [[nodiscard]] const sand::tin::Triangles& mesh() const { return mesh_; }
    [[nodiscard]] double height(Vertex vertex) const { return heights_[static_cast<std::size_t>(vertex)]; }
    sand::TinChange takeParts() {
        for (auto* list : {&change_.triangles, &change_.vertices}) {
            std::sort(list->begin(), list->end());
            list->erase(std::unique(list->begin(), list->end()), list->end());
        }
        return std::exchange(change_, {});
    }
    sand::SurfaceChange takeChange() { return {.whole = false, .parts = takeParts()}; }

    void setHeight(Vertex vertex, double height /* [unit] */) {
        heights_[static_cast<std::size_t>(vertex)] = height;
        change_.vertices.push_back(vertex);
    }
    /// Adds a vertex in the middle of a triangle.
    Vertex split(Slot slot, double height) {
        const auto [a, b, c] = triangle(slot).corner;
        const sand::tin::LatticePoint p = place(a), q = place(b), r = place(c);
        const auto vertex = static_cast<Vertex>(mesh_.places.size());
        mesh_.places.push_back({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3});
        heights_.push_back(height);
        change_.vertices.push_back(vertex);
        triangle(slot).corner = {a, b, vertex};
        change_.triangles.push_back(slot);
        add({b, c, vertex});
        add({c, a, vertex});
        link();
        return vertex;
    }
    /// Moves a vertex within its triangles.
    void move(Vertex vertex, const sand::tin::LatticePoint& to) {
        mesh_.places[static_cast<std::size_t>(vertex)] = to;
        change_.vertices.push_back(vertex);
    }
    /// Removes a vertex if it has three triangles.
    void join(Vertex vertex) {
        std::vector<Slot> around;
        for (Slot slot = 0; slot < static_cast<Slot>(mesh_.triangles.size()); ++slot) {
            if (std::ranges::count(triangle(slot).corner, vertex) > 0) {
                around.push_back(slot);
            }
        }
        if (around.size() != 3) {
            return;
        }
        auto& first = triangle(around[0]).corner;
        std::rotate(first.begin(), std::ranges::find(first, vertex), first.end());
        for (const Vertex corner : triangle(around[1]).corner) {
            if (corner != first[1] && corner != first[2] && corner != vertex) {
                first[0] = corner;
            }
        }
        triangle(around[1]).corner = triangle(around[2]).corner = {-1, -1, -1};
        change_.triangles.insert(change_.triangles.end(), around.begin(), around.end());
        change_.vertices.push_back(vertex);
        link();
    }
    /// Flips the edge opposite a corner if both its triangles exist and the flipped edge lies between them.
    void flip(Slot slot, std::size_t edge) {
        const Slot beyond = triangle(slot).neighbour[edge];
        if (beyond < 0) {
            return;
        }
        const Vertex a = triangle(slot).corner[edge], b = triangle(slot).corner[(edge + 1) % 3],
                     c = triangle(slot).corner[(edge + 2) % 3];
        Vertex d = -1;
        for (const Vertex corner : triangle(beyond).corner) {
            d = corner != b && corner != c ? corner : d;
        }
        if (doubledArea(place(a), place(b), place(d)) <= 0 || doubledArea(place(a), place(d), place(c)) <= 0) {
            return;
        }
        triangle(slot).corner = {a, b, d};
        triangle(beyond).corner = {a, d, c};
        change_.triangles.insert(change_.triangles.end(), {slot, beyond});
        link();
    }
    void constrain(Slot slot, std::size_t edge, bool constrained) {
        const Vertex b = triangle(slot).corner[(edge + 1) % 3], c = triangle(slot).corner[(edge + 2) % 3];
        constraints_[std::minmax(b, c)] = constrained;
        change_.triangles.push_back(slot);
        if (triangle(slot).neighbour[edge] >= 0) {
            change_.triangles.push_back(triangle(slot).neighbour[edge]);
        }
        link();
    }
    /// Makes a hole of every triangle whose middle satisfies `isHole(x, y)` [probe unit].
    template <class IsHole>
    void cut(const IsHole& isHole) {
        for (Slot slot = 0; slot < static_cast<Slot>(mesh_.triangles.size()); ++slot) {
            const auto [a, b, c] = triangle(slot).corner;
            const bool hole =
                isHole((place(a).x + place(b).x + place(c).x) / 3.0, (place(a).y + place(b).y + place(c).y) / 3.0);
            triangle(slot).hole = hole;
            change_.triangles.push_back(slot);
        }
    }
    /// Puts the triangles of the surface into other slots and rotates their corners.
    void shuffle(std::mt19937& random) {
        for (std::size_t last = mesh_.triangles.size() - 1; last > 0; --last) {
            std::swap(mesh_.triangles[last], mesh_.triangles[random() % (last + 1)]);
        }
        for (auto& triangle : mesh_.triangles) {
            std::rotate(triangle.corner.begin(), triangle.corner.begin() + random() % 3, triangle.corner.end());
        }
        link();
    }

private:
    [[nodiscard]] sand::tin::Triangle& triangle(Slot slot) { return mesh_.triangles[static_cast<std::size_t>(slot)]; }
    [[nodiscard]] const sand::tin::LatticePoint& place(Vertex vertex) const {
        return mesh_.places[static_cast<std::size_t>(vertex)];
    }
    void add(const std::array<Vertex, 3>& corner) {
        change_.triangles.push_back(static_cast<Slot>(mesh_.triangles.size()));
        mesh_.triangles.emplace_back().corner = corner;
    }
    /// Derives all other members from corners and constraints.
    void link() {
        mesh_.triangleAt.assign(mesh_.places.size(), -1);
        std::map<std::pair<Vertex, Vertex>, Slot> beside;
        for (Slot slot = 0; slot < static_cast<Slot>(mesh_.triangles.size()); ++slot) {
            for (std::size_t i = 0; i < 3 && triangle(slot).alive(); ++i) {
                mesh_.triangleAt[static_cast<std::size_t>(triangle(slot).corner[i])] = slot;
                beside[{triangle(slot).corner[i], triangle(slot).corner[(i + 1) % 3]}] = slot;
            }
        }
        for (auto& one : mesh_.triangles) {
            for (std::size_t i = 0; i < 3 && one.alive(); ++i) {
                const Vertex b = one.corner[(i + 1) % 3], c = one.corner[(i + 2) % 3];
                const auto found = beside.find({c, b});
                const auto constraint = constraints_.find(std::minmax(b, c));
                one.neighbour[i] = found == beside.end() ? -1 : found->second;
                one.constrained[i] = found == beside.end() || (constraint != constraints_.end() && constraint->second);
            }
        }
    }

    sand::tin::Triangles mesh_;
    std::vector<double> heights_;
    std::map<std::pair<Vertex, Vertex>, bool> constraints_;
    sand::TinChange change_;
};

}  // namespace sample
