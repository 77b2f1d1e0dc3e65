// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "sand/grid/displacement.hpp"

namespace reference {

/// Sweeps exactly as docs/sand.md describes, face by face over the whole field. Shares no code with
/// sand::grid::Erosion, which must give the same heights bit for bit. A cell is given by its offset from the first
/// cell.
class Sand {
public:
    sand::HeightField field;
    sand::Rules rules;
    const sand::Ground* ground;                  // null: neither rock nor wall cells
    const sand::grid::Obstacle* tool = nullptr;  // null: no tool is in the sand
    int undisturbed = 0;                         // [sweep], sweeps since something else changed the field
    std::int64_t outflow = 0;                    // volume lost over an open rim [unit · cell]

    Sand(sand::HeightField start, const sand::Rules& laws, const sand::Ground* rock)
        : field(std::move(start)), rules(laws), ground(rock), seen(field.cells()), layer(seen), room(seen), slid(seen) {
        slid = sand::CellArray(field.columns(), field.rows());
        for (std::ptrdiff_t y = 0; y < field.rows(); ++y) {
            for (std::ptrdiff_t x = 0; x < field.columns(); ++x) {
                addFaces(y * field.stride() + x, 1, field.stride(), x == 0, x == field.columns() - 1);
                addFaces(y * field.stride() + x, field.stride(), 1, y == 0, y == field.rows() - 1);
            }
        }
    }

    void sweep(int sweeps) {
        for (int n = 0; n < sweeps; ++n) {
            const auto after = [](int age, int half) { return std::min(float(age) / float(age + half), 0.9F); };
            const float momentum = std::max(after(n, std::clamp(sweeps / 3, 3, 25)), after(undisturbed, 25));
            look();
            std::ranges::for_each(faces, [&](Face& face) { face.q = flux(face, momentum * float(face.q)); });
            slid = sand::CellArray(field.columns(), field.rows());
            for (const Face& face : faces) {
                field.row(0)[face.from] -= face.q;
                field.row(0)[face.to] += face.q;
                slid.row(0)[face.from] |= face.q;
                slid.row(0)[face.to] |= face.q;
                outflow += face.overRim ? face.q : 0;
            }
            const bool moved = std::ranges::any_of(faces, [](const Face& face) { return face.q != 0; });
            undisturbed = std::min(undisturbed + (moved ? 1 : 0), 1000);
        }
    }

private:
    struct Face {
        std::ptrdiff_t from, to, side;  // cells on either side of the face; the step from a cell to the next along it
        bool overRim;                   // leads to a height of 0, from which no sand returns
        std::int32_t q;                 // [unit], flux of the last sweep
    };

    void addFaces(std::ptrdiff_t cell, std::ptrdiff_t ahead, std::ptrdiff_t side, bool first, bool last) {
        if (first && rules.rim == sand::Rim::open) {
            faces.push_back({cell, cell - ahead, side, true, 0});
        }
        if (!last || rules.rim == sand::Rim::open) {
            faces.push_back({cell, cell + ahead, side, last, 0});
        }
    }
    [[nodiscard]] std::int32_t flux(const Face& face, float last) const {
        const std::ptrdiff_t i = face.from, j = face.overRim ? i : face.to;
        const double north = rules.aspect / 65536.0, length = face.side == 1 ? north : 1;
        const double ratio = face.side == 1 ? north : 1 / north;
        const bool inertia = rules.scheme == sand::Scheme::isotropic;
        const auto k = float((inertia ? 0.46 : 0.4998) / (ratio * ratio + 1));
        const auto p = float(0.225 * std::min(1.0, 1 / (ratio * ratio)));
        const auto t = float(rules.tuning.threshold * length), start = float(rules.tuning.startThreshold * length);
        const auto a = float(face.overRim ? std::max(seen.row(0)[i], 0) : seen.row(0)[i] - seen.row(0)[j]);
        const float b = float(0.25 * ratio) * (rise(i, face.side) + rise(j, face.side));
        const float square = a * a + b * b, m = std::sqrt(square);
        if ((slid.row(0)[i] | slid.row(0)[j]) == 0 && !(inertia ? square > start * start : m > start)) {
            return 0;
        }
        const float back = std::min(k * a, 0.0F), forth = std::max(k * a, 0.0F);
        const float driven = inertia ? p * (1 - t * t / std::max(square, 0.0625F)) * a
                             : m > t ? k * (1 - t / m) * a
                                     : 0;
        const auto q = std::int32_t(std::clamp((inertia ? std::clamp(last, back, forth) : 0) + driven, back, forth));
        return std::clamp(q, -std::min(room.row(0)[i], layer.row(0)[j] / 4),
                          std::min(face.overRim ? q : room.row(0)[j], layer.row(0)[i] / 4));
    }
    /// Returns the height of the cell after `cell` minus the height of the cell before it. A step counts at most the
    /// sand of its upper cell.
    [[nodiscard]] float rise(std::ptrdiff_t cell, std::ptrdiff_t side) const {
        const auto step = [h = seen.row(0), s = layer.row(0)](std::ptrdiff_t c, std::ptrdiff_t d) {
            return std::clamp(h[c] - h[d], -s[d], s[c]);
        };
        return float(step(cell + side, cell) + step(cell, cell - side));
    }
    /// Finds heights, sand and room. A wall cell is higher than all sand. Beyond the rim the slope of the ground
    /// continues, where a step counts at most the sand of its upper cell.
    void look() {
        for (int y = -1; y <= field.rows(); ++y) {
            for (int x = -1; x <= field.columns(); ++x) {
                const int u = std::clamp(x, 0, field.columns() - 1), v = std::clamp(y, 0, field.rows() - 1);
                const int s = std::clamp(2 * u - x, 0, field.columns() - 1),
                          t = std::clamp(2 * v - y, 0, field.rows() - 1);
                const bool wall = ground != nullptr && ground->isWall(u, v);
                const bool end = wall || (ground != nullptr && ground->isWall(s, t));
                const std::int32_t h = wall ? sand::kMaxHeight : field.height(u, v);
                const auto sandIn = [this](int column, int row) {
                    return ground == nullptr ? 1 << 30 : ground->sand(column, row, field.height(column, row));
                };
                const std::int32_t came = std::clamp(h - field.height(s, t), -sandIn(s, t), sandIn(u, v));
                seen.row(y)[x] = (x == u && y == v) || end ? h : h + came;
                layer.row(y)[x] = sandIn(u, v);
                const bool below =
                    tool != nullptr && !sand::CellRect{u, v, u + 1, v + 1}.clippedTo(tool->cells).empty();
                const std::int32_t underside = below ? tool->row(v)[u - tool->cells.x0] : sand::grid::Obstacle::kFree;
                const std::int32_t fits = std::max(std::min(underside, sand::kMaxHeight) - h, 0) / 4;
                room.row(y)[x] = wall ? 0 : underside == sand::grid::Obstacle::kFree ? underside : fits;
            }
        }
    }

    sand::CellArray seen, layer, room;  // [unit]: heights for slopes, sand, and the most that a face may bring
    sand::CellArray slid;               // not 0: sand went through a face of the cell in the last sweep
    std::vector<Face> faces;
};

}  // namespace reference
