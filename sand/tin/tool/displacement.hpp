// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sand/model/rules.hpp"
#include "sand/model/step.hpp"
#include "sand/model/tool_shape.hpp"
#include "sand/tin/flow/erosion.hpp"
#include "sand/tin/refine/refinement.hpp"
#include "sand/tin/tool/imprint.hpp"

namespace sand::tin {

using Volume = Wide;  // [volume unit of VertexSand]

/// Moves a tool through the sand of a TIN (Purchart et al. 2012). The edges of its outline become constraints. The
/// surface inside takes the tool's shape and depth, and the sand above is pushed away. The result depends only on
/// sand, imprint and path. Not thread-safe.
class Displacement {
public:
    /// Code that decodes steps and rules must refuse poses beyond kMaxProbe and shapes beyond kLargestToolRadius.
    /// Other code may use `neighbourhood` between two calls.
    Displacement(const Tool& tool, const DetailRules& rules,
                 std::shared_ptr<Neighbourhood> neighbourhood = std::make_shared<Neighbourhood>());
    [[nodiscard]] const Tool& tool() const { return tool_; }

    /// The effects of a drag on the sand. The layer itself records the changes of the mesh.
    struct Work {
        std::vector<Vertex> touched;  // living vertices whose sand was taken or raised, ascending, each once
        Volume outflow = 0;           // volume pushed over an open rim; the layer has lost it
        std::int64_t refused = 0;     // presses with sand that stayed where it was
    };

    /// Moves the tool along `path`, which begins where the tool is, and displaces the sand. A path of one point
    /// presses there. docs/tin.md#tools says where the sand goes.
    ///
    /// Moves in sub-steps of at most one cell. Skips a sub-step that brings the tool less than a quarter of a cell
    /// farther and less than a quarter of a cell deeper, except the last one. Refines the mesh along the path, also on
    /// the rim and on the borders of holes. Replaces the previous imprint by the outline at the end of the path.
    ///
    /// A tool that is held still changes nothing after its press, except in hold(). If the tool does not reach the sand
    /// at all, it leaves the sand as with leave().
    Work drag(VertexSand& layer, Imprint& imprint, Rim rim, std::span<const ProbePoint> path);
    /// Follows a tool that is held at `probe`. When all sand around it has sunk clearly below it, leaves the sand as
    /// with leave(), because a slope would erode along the slivers between the points of the outline. When sand comes
    /// to a tool that has left it, presses once.
    Work hold(VertexSand& layer, Imprint& imprint, Rim rim, const ProbePoint& probe);
    /// Ends the imprint, because the tool is lifted. The rules decide whether the outline stays with its constraints
    /// or is removed.
    void leave(VertexSand& layer, Imprint& imprint);

    /// Returns the underside of the tool at `probe`, for sand that flows while the tool is there.
    [[nodiscard]] Underside underside(const ProbePoint& probe) const;
    /// Returns the area in which the tool at `probe` takes sand out or lays it down, and a little more [probe unit]. It
    /// may reach beyond the field.
    [[nodiscard]] Box reach(const ProbePoint& probe) const;

private:
    struct Press {
        ProbePoint probe;
        Offset ahead;
    };
    /// Presses near each other, for which the mesh is changed only once.
    struct Chunk {
        std::vector<Press> presses;
        Box box;            // area that the presses reach
        bool last = false;  // whether the path ends in this chunk
    };
    struct Cut {
        Vertex vertex;
        std::int64_t taken;
    };
    struct Receiver {
        Vertex vertex;  // kNoNumber: beyond the rim
        double weight;
        LatticePoint place;  // only beyond the rim
        Volume share = 0;
    };

    void work(VertexSand& layer, Imprint& imprint, Rim rim, const Chunk& chunk, Work& work);
    /// Returns the lowest height of a tool whose centre is at height `z` [unit].
    [[nodiscard]] double lowestUnderside(std::int64_t z) const;
    [[nodiscard]] bool reachesSand(const VertexSand& layer, const Chunk& chunk) const;
    /// Returns whether a corner of a triangle of the neighbourhood is higher than `height` [unit].
    [[nodiscard]] bool isAnyAbove(const VertexSand& layer, double height) const;
    /// Returns whether sand is above the underside at a point of the outline.
    [[nodiscard]] bool isEntered(const VertexSand& layer, const ProbePoint& probe) const;
    /// Returns the vertices that VertexSand::edit() returns.
    std::vector<Vertex> changeMesh(VertexSand& layer, Imprint& imprint, const Chunk& chunk) const;
    void thin(Mesh& mesh, const PlacedOutline& outline) const;
    [[nodiscard]] Edges edgesThatStay(const Triangles& mesh, const Imprint& imprint) const;
    [[nodiscard]] bool isNearTool(const LatticePoint& place, const std::vector<Press>& presses) const;

    void press(VertexSand& layer, Rim rim, const Press& press, Work& work);
    /// Does the work of press() part by part, beside a hole.
    void pressInParts(VertexSand& layer, Rim rim, const Press& press, Work& work);
    [[nodiscard]] bool isNearHole(const VertexSand& layer, const Box& box) const;
    [[nodiscard]] bool findCut(const VertexSand& layer, const ProbePoint& probe);
    void addReceivers(const VertexSand& layer, Rim rim, const Press& press, bool everywhere);
    void addBeyond(const VertexSand& layer, const Press& press, bool everywhere);
    void addNeighbours(const VertexSand& layer, const ProbePoint& probe, const std::function<bool(Vertex)>& isOurs);
    /// Shares the sand of `cut_` out among `receivers_`. With `toSome`, those that would rise above a limit get none.
    /// Returns false, and leaves the sand as it is, if no receiver is left or if one of them would rise above a limit.
    bool deal(VertexSand& layer, bool toSome, Work& work);
    void shareOut();
    [[nodiscard]] bool hasRoom(const VertexSand& layer, const Receiver& receiver) const;
    [[nodiscard]] bool isWithinAllSand(const VertexSand& layer) const;
    void findParts(const VertexSand& layer, const ProbePoint& probe);
    void forgetParts();
    /// Returns the first vertex of a vertex's part, or kNoNumber if it is in no part.
    [[nodiscard]] Vertex partOf(Vertex vertex);
    [[nodiscard]] Vertex partOf(const VertexSand& layer, const Receiver& receiver);

    Tool tool_;
    DetailRules rules_;
    TurnedShape turned_;
    Outline outline_;
    std::shared_ptr<Neighbourhood> neighbourhood_;
    // Scratch memory of one press:
    std::vector<Cut> cut_;
    Volume taken_ = 0;
    std::vector<Receiver> receivers_;
    std::vector<Vertex> inParts_;  // vertices in parts, ascending
    std::vector<Vertex> up_;       // by vertex: an earlier vertex of its part, or itself; kNoNumber outside all parts
};

}  // namespace sand::tin
