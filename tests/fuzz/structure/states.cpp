// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/structure/states.hpp"

#include <algorithm>

#include "sand/grid/snapshot.hpp"
#include "sand/tin/surface.hpp"

namespace structure {
namespace {

using sand::CellArray;
using sand::CellRect;
using sand::Replica;

/// Changes the heights, the fluxes, their age and the outflow of a height field.
base::Bytes changed(const sand::grid::Snapshot& sand, Chance& chance) {
    sand::HeightField field = sand.field;
    const int columns = field.columns(), rows = field.rows();
    CellArray east(columns, rows), north(columns, rows);
    sand.inertia.putInto(east, north);
    std::int64_t outflow = sand.outflow;
    int age = sand.inertia.undisturbed();
    for (std::size_t changes = 1 + chance.below(4); changes > 0; --changes) {
        const auto column = [&](int from) {
            return from + static_cast<int>(chance.below(static_cast<std::size_t>(columns - from)));
        };
        const auto row = [&](int from) {
            return from + static_cast<int>(chance.below(static_cast<std::size_t>(rows - from)));
        };
        switch (chance.below(8)) {
            case 0:
                outflow = chance.wide();
                break;
            case 1:
                age = chance.odd();
                break;
            case 2:
            case 3:
                field.setHeight(column(0), row(0), chance.odd());
                break;
            case 4:  // a row of the greatest or the smallest heights
                for (int x = 0, y = row(0); x < columns; ++x) {
                    field.setHeight(x, y, x < columns / 2 ? sand::kMaxHeight : -sand::kMaxHeight);
                }
                break;
            default:
                (chance.oneIn(2) ? east : north).row(row(-1))[column(-1)] = chance.odd();
        }
    }
    sand::grid::Inertia inertia(age);
    inertia.keep(east, north, CellRect{-1, -1, columns, rows});
    return sand::grid::Snapshot(field, inertia, outflow).encode();
}

void change(sand::tin::Imprint& imprint, Chance& chance) {
    const auto vertex = [&] { return static_cast<sand::tin::Vertex>(chance.below(90)) - 5; };
    if (!imprint.pose || chance.oneIn(4)) {
        imprint.pose.emplace();
        imprint.pose->probe = {chance.odd() % sand::kMaxProbe, static_cast<int>(chance.below(2000)),
                               chance.odd() % 999};
        imprint.pose->tool.radius = static_cast<std::int32_t>(chance.below(2000));
    }
    if (chance.oneIn(2)) {
        imprint.points.push_back(
            {vertex(), {static_cast<int>(chance.below(2100)), static_cast<int>(chance.below(2100))}});
    } else {
        imprint.edges.emplace_back(vertex(), vertex());
    }
}

/// Changes the vertices, the constraints, the imprint and the outflow of a TIN.
base::Bytes changed(const sand::tin::TinSurface& surface, Chance& chance) {
    sand::tin::VertexSandParts parts = surface.layer().parts();
    sand::tin::TinState state = dynamic_cast<const sand::tin::Snapshot&>(*surface.copy()).state();
    for (std::size_t changes = 1 + chance.below(4); changes > 0; --changes) {
        const std::size_t at = chance.below(parts.places.size());
        switch (chance.below(9)) {
            case 0:
                state.outflow = chance.wide();
                break;
            case 1:
                state.nextToGo = chance.odd();
                break;
            case 2:
            case 3:
                parts.volumes[at] = chance.wide();
                break;
            case 4:
                parts.moving[at] = static_cast<std::uint8_t>(chance.below(2));
                break;
            case 5:
                parts.places[at] = chance.oneIn(3) ? sand::tin::VertexSandParts::kNowhere
                                                   : sand::tin::LatticePoint{static_cast<int>(chance.below(2100)),
                                                                             static_cast<int>(chance.below(1600))};
                break;
            case 6:
                if (!parts.constraints.empty() && chance.oneIn(2)) {
                    parts.constraints.erase(parts.constraints.begin() +
                                            static_cast<std::ptrdiff_t>(chance.below(parts.constraints.size())));
                } else {
                    parts.constraints.emplace_back(static_cast<sand::tin::Vertex>(at),
                                                   static_cast<sand::tin::Vertex>(chance.below(parts.places.size())));
                    std::sort(parts.constraints.begin(), parts.constraints.end());
                }
                break;
            case 7:
                (chance.oneIn(2) ? parts.width : parts.depth) = chance.odd();
                break;
            default:
                change(state.imprint, chance);
        }
    }
    return sand::tin::Snapshot(parts, state).encode();
}

/// Changes one number of a state's head.
void change(sand::StateHead& head, Chance& chance) {
    switch (chance.below(7)) {
        case 0:
            // Far below 2^62, the last step that a state may be of, unless the state is refused.
            head.number = chance.oneIn(2) ? chance.below(1000) : ~static_cast<std::uint64_t>(chance.below(1000));
            break;
        case 1:
            (chance.oneIn(3) ? head.probe.x : chance.oneIn(2) ? head.probe.y : head.probe.z) = chance.odd();
            break;
        case 2:
            head.heading = {static_cast<std::int16_t>(chance.odd()), static_cast<std::int16_t>(chance.odd()), true};
            break;
        case 3:
            head.engaged = !head.engaged;
            break;
        case 4:
            head.owed = {chance.oneIn(3) ? sand::Owed::kUntilRest : static_cast<std::int32_t>(chance.below(50)),
                         static_cast<std::int32_t>(chance.below(60))};
            break;
        case 5:
            head.owed.done = chance.odd();
            break;
        default:
            change(head.tuning, chance);
    }
}

/// Returns the bytes of the movement of `sand`, often with another number, and now and then with too few or too many.
base::Bytes changedMovement(const Replica& sand, Chance& chance) {
    if (sand.surface().movement() == nullptr) {
        return chance.oneIn(16) ? base::Bytes{1, 0} : base::Bytes();
    }
    sand::Movement movement = *sand.surface().movement();
    if (chance.oneIn(2)) {
        movement.moved[chance.below(movement.moved.size())] = chance.below(movement.step + (chance.oneIn(4) ? 9 : 1));
    }
    if (chance.oneIn(16)) {
        movement.moved.resize(movement.moved.size() + chance.below(3) - 1);
    }
    base::ByteWriter writer;
    movement.encode(writer);
    return writer.take();
}

}  // namespace

void change(sand::Tuning& tuning, Chance& chance) {
    switch (chance.below(6)) {
        case 0:
            tuning.threshold = chance.odd();
            break;
        case 1:
            tuning.startThreshold = chance.odd();
            break;
        case 2:
            tuning.sweepsPerStep = static_cast<std::int32_t>(chance.below(30)) - 1;
            break;
        case 3:
            tuning.tool.kind = static_cast<sand::ToolKind>(chance.below(sand::kToolKinds + 1U));
            break;
        case 4:
            tuning.tool.radius = chance.oneIn(8) ? chance.odd() : static_cast<std::int32_t>(chance.below(3000));
            break;
        default:
            tuning.tool.halfWidth = chance.odd() % 2000;
    }
}

base::Bytes changedSand(const Replica& sand, Chance& chance) {
    if (const auto* tin = dynamic_cast<const sand::tin::TinSurface*>(&sand.surface()); tin != nullptr) {
        return changed(*tin, chance);
    }
    return changed(dynamic_cast<const sand::grid::Snapshot&>(*sand.copySand()), chance);
}

base::Bytes changedState(const Session& session, Chance& chance) {
    const Replica& sand = chance.of(session.states);
    base::Bytes bytes = sand.copyState().head;
    base::ByteReader reader(bytes);
    auto head = base::read<sand::StateHead>(reader);
    if (chance.oneIn(2)) {
        change(head, chance);
    }
    base::ByteWriter state;
    base::putMember(state, head);
    state.putBlock(changedMovement(sand, chance));
    // The sand for an undo is that of another step, which may not be from before a stroke.
    state.putBlock(chance.oneIn(2) ? base::Bytes() : changedSand(chance.of(session.states), chance));
    state.putBytes(chance.oneIn(8) ? sand.copySand()->encode() : changedSand(sand, chance));
    bytes = state.take();
    if (chance.oneIn(16)) {
        bytes[chance.below(bytes.size())] ^= static_cast<std::uint8_t>(1U << chance.below(8));
    }
    return bytes;
}

}  // namespace structure
