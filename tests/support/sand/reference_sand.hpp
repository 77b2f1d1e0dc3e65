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
        : field(std::move(start)),
          rules(laws),
          ground(rock),
          beyond(field.cells()),
          seen(beyond),
          layer(seen),
          room(seen),
          slid(seen) {
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
        const std::int32_t giver = layer.row(0)[face.overRim || seen.row(0)[i] > seen.row(0)[j] ? i : j];
        const double lengthAlong = face.side == 1 ? 1 : north;
        const Along along{face.side, std::int32_t(float(rules.tuning.startThreshold * lengthAlong)),
                          4.0F / float(std::max(giver, 1))};
        const float b = float(0.25 * ratio) * (rise(i, along) + rise(j, along));
        const float square = a * a + b * b, m = std::sqrt(square);
        if ((slid.row(0)[i] | slid.row(0)[j]) == 0 && !(inertia ? square > start * start : m > start)) {
            return 0;
        }
        const float back = std::min(k * a, 0.0F), forth = std::max(k * a, 0.0F);
        const float driven = inertia ? p * (1 - t * t / std::max(square, 0.0625F)) * a
                             : m > t ? k * (1 - t / m) * a
                                     : 0;
        const auto q = std::int32_t(std::clamp((inertia ? std::clamp(last, back, forth) : 0) + driven, back, forth));
        return std::clamp(q, -std::min(room.row(0)[i], layer.row(0)[j]) / 4,
                          std::min(face.overRim ? kEndless : room.row(0)[j], layer.row(0)[i]) / 4);
    }
    struct Along {
        std::ptrdiff_t side;
        std::int32_t start;  // [unit], the start threshold along this side
        float share;         // 4 divided by the sand of the face's upper cell
    };
    /// Returns the height of the cell after `cell` minus the height of the cell before it, as a face counts it. Beyond
    /// the rim the step before it continues.
    [[nodiscard]] float rise(std::ptrdiff_t cell, const Along& along) const {
        const bool last = beyond.row(0)[cell + along.side] != 0, first = beyond.row(0)[cell - along.side] != 0;
        if (last && first) {
            return 0;
        }
        const std::int32_t after = last ? 0 : step(cell + along.side, cell, along);
        const std::int32_t before = first ? after : step(cell, cell - along.side, along);
        return float((last ? before : after) + before);
    }
    /// Returns by how much cell `c` is higher than cell `d`. A step counts at most the room in its lower cell. It
    /// counts all sand of its upper cell. If this cell has a quarter of the sand that the face can give, it counts up
    /// to the start threshold. With less sand it counts less in proportion.
    [[nodiscard]] std::int32_t step(std::ptrdiff_t c, std::ptrdiff_t d, const Along& along) const {
        const std::int32_t height = seen.row(0)[c] - seen.row(0)[d];
        const bool up = height > 0;
        const std::int32_t most = std::min(std::abs(height), room.row(0)[up ? d : c]);
        const std::int32_t sand = layer.row(0)[up ? c : d];
        const auto thin = std::int32_t(float(std::min(most, along.start)) * std::min(float(sand) * along.share, 1.0F));
        const std::int32_t counted = std::max(std::min(most, sand), thin);
        return up ? counted : -counted;
    }
    /// Finds heights, sand and room. A wall cell is higher than all sand.
    void look() {
        for (int y = -1; y <= field.rows(); ++y) {
            for (int x = -1; x <= field.columns(); ++x) {
                const int u = std::clamp(x, 0, field.columns() - 1), v = std::clamp(y, 0, field.rows() - 1);
                const bool wall = ground != nullptr && ground->isWall(u, v);
                const std::int32_t h = wall ? sand::kMaxHeight : field.height(u, v);
                beyond.row(y)[x] = x != u || y != v;
                seen.row(y)[x] = h;
                layer.row(y)[x] = ground == nullptr ? kEndless : ground->sand(u, v, field.height(u, v));
                const bool below =
                    tool != nullptr && !sand::CellRect{u, v, u + 1, v + 1}.clippedTo(tool->cells).empty();
                const std::int32_t underside = below ? tool->row(v)[u - tool->cells.x0] : sand::grid::Obstacle::kFree;
                const std::int32_t fits = std::max(std::min(underside, sand::kMaxHeight) - h, 0);
                room.row(y)[x] = wall ? 0 : underside == sand::grid::Obstacle::kFree ? kEndless : fits;
            }
        }
    }

    static constexpr std::int32_t kEndless = 1 << 30;  // [unit], more than any flux or step needs

    sand::CellArray beyond;             // not 0 beyond the rim
    sand::CellArray seen, layer, room;  // [unit]: heights for slopes, sand, and what fits below the tool
    sand::CellArray slid;               // not 0: sand went through a face of the cell in the last sweep
    std::vector<Face> faces;
};

}  // namespace reference
