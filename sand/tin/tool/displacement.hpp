// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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

/// Moves a tool through the sand of a TIN (second paper): the outline's edges become constraints, the inside takes the
/// tool's shape and depth, and the sand above is pushed away. A function of sand, imprint and path. Not thread-safe.
class Displacement {
public:
    /// Poses beyond kMaxProbe and shapes beyond kLargestToolRadius are refused by whoever decodes steps and rules.
    /// Others may use `neighbourhood` too, between two calls.
    Displacement(const ToolShape& shape, const Heading& heading, const DetailRules& rules,
                 std::shared_ptr<Neighbourhood> neighbourhood = std::make_shared<Neighbourhood>());
    [[nodiscard]] bool is(const ToolShape& shape, const Heading& heading) const {
        return shape_ == shape && heading_ == heading;
    }

    /// What a drag did besides changing the mesh, which the layer itself tells.
    struct Work {
        std::vector<Vertex> touched;  // whose sand it took or raised, ascending, each once; all of them live
        Volume outflow = 0;           // pushed over an open rim; the layer has lost it
    };

    /// Sweeps the tool along a path of one point or more, whose first is where it was, in sub-steps of at most a cell,
    /// without those that are neither a quarter of a cell farther nor deeper than the one before, nor the end; a path
    /// of one point presses there. The mesh is refined along the way, an open rim too, the imprint of before taken out,
    /// and the outline put in where the path ends. Sand above the underside goes to the vertices ahead, as a grid's
    /// does to its cells, each by its share of the ground; where there are none, to all around, or else to the
    /// neighbours of those it came from. Where nothing could take it, it stays. Beside an open rim the ground beyond
    /// takes its part, which flows out.
    ///
    /// A tool held still changes nothing once it has pressed; a tool that does not reach the sand at all leaves it.
    Work drag(VertexSand& layer, Imprint& imprint, Rim rim, std::span<const ProbePoint> path);
    /// The tool is lifted: its outline stays, with its constraints, or is taken out, as the rules say.
    void leave(VertexSand& layer, Imprint& imprint);

    /// For sand that flows while the tool stands there.
    [[nodiscard]] Underside underside(const ProbePoint& at) const;
    /// Where it takes sand out or lays it down [probe unit], and a little more; may reach out of the field.
    [[nodiscard]] Box reach(const ProbePoint& at) const;

private:
    struct Press {
        ProbePoint at;
        Offset ahead;
    };
    /// Presses near each other: one change of the mesh is for all of them.
    struct Chunk {
        std::vector<Press> presses;
        Box box;  // that they reach
        bool last = false;
    };
    struct Cut {
        Vertex vertex;
        std::int64_t taken;
    };
    struct Receiver {
        Vertex vertex;  // kNobody: beyond the rim
        double weight;
        Volume share = 0;
    };

    void work(VertexSand& layer, Imprint& imprint, Rim rim, const Chunk& chunk, Work& work);
    [[nodiscard]] bool reachesSand(const VertexSand& layer, const Chunk& chunk) const;
    /// Returns what VertexSand::edit() does.
    std::vector<Vertex> changeMesh(VertexSand& layer, Imprint& imprint, Rim rim, const Chunk& chunk) const;
    void thin(Mesh& mesh, const PlacedOutline& outline) const;
    [[nodiscard]] Edges edgesThatStay(const Triangles& mesh, const Imprint& imprint) const;
    [[nodiscard]] bool isNearTool(const Place& place, const std::vector<Press>& presses) const;

    void press(VertexSand& layer, Rim rim, const Press& press, Work& work);
    [[nodiscard]] bool findCut(const VertexSand& layer, const ProbePoint& at);
    void findReceivers(const VertexSand& layer, Rim rim, const Press& press);
    void addBeyond(const VertexSand& layer, const Press& press, bool everywhere);
    void addNeighbours(const VertexSand& layer, const ProbePoint& at);
    void shareOut();
    [[nodiscard]] bool hasRoom(const VertexSand& layer) const;

    ToolShape shape_;
    Heading heading_;
    DetailRules rules_;
    TurnedShape turned_;
    Outline outline_;
    std::shared_ptr<Neighbourhood> neighbourhood_;
    // Of one press.
    std::vector<Cut> cut_;
    Volume taken_ = 0;
    std::vector<Receiver> receivers_;
};

}  // namespace sand::tin
