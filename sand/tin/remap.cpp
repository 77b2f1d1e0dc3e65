// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/remap.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sand::tin {
namespace {

std::size_t at(Vertex vertex) { return static_cast<std::size_t>(vertex); }

Wide dividedDown(Wide value, Wide divisor) {
    const Wide quotient = value / divisor;
    return quotient * divisor > value ? quotient - 1 : quotient;
}

std::int64_t areaOf(const Mesh::Piece& piece) { return doubledArea(piece.place[0], piece.place[1], piece.place[2]); }

/// A vertex by number and place: a number may have been given to another within one change.
struct Node {
    Vertex vertex;
    Place place;
    bool before = false, now = false;
    std::int64_t went = 0, came = 0;  // of its star [probe unit²]
    std::size_t part = 0;             // the first node of what it hangs together with
    Wide volume = 0;
    double height = 0;  // of the old surface

    friend bool operator<(const Node& a, const Node& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.place < b.place;
    }
};

/// What hangs together by vertices.
struct Part {
    Wide missing = 0;       // volume that its vertices do not hold yet
    std::int64_t area = 0;  // doubled [probe unit²]
    Wide stars = 0;
    std::int64_t smallestStar = 0;
    double lowest = 0, highest = 0;
    bool empty = true;
};

class Remapping {
public:
    Remapping(const Mesh::Difference& difference, const std::vector<std::int64_t>& volumes,
              const std::vector<std::int64_t>& stars, const std::vector<double>& heights)
        : difference_(difference), volumes_(volumes), stars_(stars), heights_(heights) {}

    Remapped run() {
        gatherNodes();
        gatherParts();
        for (Node& node : nodes_) {
            if (node.now) {
                keepHeight(node);
            }
        }
        return share();
    }

private:
    Node& nodeOf(const Mesh::Piece& piece, std::size_t corner) {
        Node wanted;
        wanted.vertex = piece.corner[corner];
        wanted.place = piece.place[corner];
        return *std::lower_bound(nodes_.begin(), nodes_.end(), wanted);
    }

    void gatherNodes() {
        for (const auto* pieces : {&difference_.went, &difference_.came}) {
            for (const Mesh::Piece& piece : *pieces) {
                for (std::size_t i = 0; i < 3; ++i) {
                    Node node;
                    node.vertex = piece.corner[i];
                    node.place = piece.place[i];
                    nodes_.push_back(node);
                }
            }
        }
        std::sort(nodes_.begin(), nodes_.end());
        const auto same = [](const Node& a, const Node& b) { return !(a < b); };  // they are in order
        nodes_.erase(std::unique(nodes_.begin(), nodes_.end(), same), nodes_.end());
        for (const Mesh::Piece& piece : difference_.went) {
            for (std::size_t i = 0; i < 3; ++i) {
                Node& node = nodeOf(piece, i);
                node.before = true;
                node.went += areaOf(piece);
            }
        }
        for (const Mesh::Piece& piece : difference_.came) {
            for (std::size_t i = 0; i < 3; ++i) {
                Node& node = nodeOf(piece, i);
                node.now = true;
                node.came += areaOf(piece);
            }
        }
    }

    std::size_t first(std::size_t node) const {
        while (nodes_[node].part != node) {
            node = nodes_[node].part;
        }
        return node;
    }

    void gatherParts() {
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            nodes_[i].part = i;
        }
        for (const auto* pieces : {&difference_.went, &difference_.came}) {
            for (const Mesh::Piece& piece : *pieces) {
                for (std::size_t i = 1; i < 3; ++i) {
                    const std::size_t a = first(static_cast<std::size_t>(&nodeOf(piece, 0) - nodes_.data()));
                    const std::size_t b = first(static_cast<std::size_t>(&nodeOf(piece, i) - nodes_.data()));
                    nodes_[std::max(a, b)].part = std::min(a, b);
                }
            }
        }
        parts_.resize(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            nodes_[i].part = first(i);
            if (!nodes_[i].before) {
                continue;
            }
            Part& part = parts_[nodes_[i].part];
            const double height = heights_[at(nodes_[i].vertex)];
            part.missing += volumes_[at(nodes_[i].vertex)];
            part.lowest = part.empty ? height : std::min(part.lowest, height);
            part.highest = part.empty ? height : std::max(part.highest, height);
            part.empty = false;
        }
        for (const Mesh::Piece& piece : difference_.came) {
            parts_[nodeOf(piece, 0).part].area += areaOf(piece);
        }
    }

    [[nodiscard]] std::int64_t starOf(const Node& node) const {
        return node.before ? stars_[at(node.vertex)] - node.went + node.came : node.came;
    }

    /// The old surface there; of several triangles that share the place, in the first.
    [[nodiscard]] double oldHeight(const Place& place) const {
        for (const Mesh::Piece& piece : difference_.went) {
            const auto& [a, b, c] = piece.place;
            const std::int64_t u = doubledArea(b, c, place);
            const std::int64_t v = doubledArea(c, a, place);
            const std::int64_t w = doubledArea(a, b, place);
            if (u >= 0 && v >= 0 && w >= 0) {
                const double lowest = heights_[at(piece.corner[0])];
                const double rise = static_cast<double>(v) * (heights_[at(piece.corner[1])] - lowest) +
                                    static_cast<double>(w) * (heights_[at(piece.corner[2])] - lowest);
                return lowest + rise / static_cast<double>(u + v + w);
            }
        }
        return 0;  // not reached: what came covers the ground of what went
    }

    void keepHeight(Node& node) {
        const std::int64_t star = starOf(node);
        if (node.before) {
            node.height = heights_[at(node.vertex)];
            const std::int64_t old = stars_[at(node.vertex)];
            node.volume =
                dividedDown(static_cast<Wide>(2) * volumes_[at(node.vertex)] * star + old, static_cast<Wide>(2) * old);
        } else {
            node.height = oldHeight(node.place);
            const double whole = std::floor(node.height);
            const double rest = (node.height - whole) * static_cast<double>(star);
            node.volume =
                static_cast<Wide>(static_cast<std::int64_t>(whole)) * star + static_cast<std::int64_t>(rest + 0.5);
        }
        Part& part = parts_[node.part];
        part.missing -= node.volume;
        part.stars += star;
        part.smallestStar = part.smallestStar == 0 ? star : std::min(part.smallestStar, star);
    }

    Remapped share() {
        std::vector<Wide> left(parts_.size());
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            left[i] = parts_[i].missing;
        }
        for (Node& node : nodes_) {
            if (node.now) {
                const Part& part = parts_[node.part];
                const Wide part_ = dividedDown(part.missing * starOf(node), part.stars);
                node.volume += part_;
                left[node.part] -= part_;
            }
        }
        Remapped result;
        for (const Node& node : nodes_) {
            if (!node.now) {
                result.died.push_back(node.vertex);
                continue;
            }
            const Wide unit = left[node.part] > 0 ? 1 : 0;
            left[node.part] -= unit;
            const Part& part = parts_[node.part];
            const double reach = 3 * static_cast<double>(part.area) / static_cast<double>(part.stars);
            const double bound =
                (part.highest - part.lowest) * reach + 2 / static_cast<double>(part.smallestStar) + 0x1p-20;
            result.shares.push_back({node.vertex, starOf(node), node.volume + unit, node.height, bound});
        }
        return result;
    }

    const Mesh::Difference& difference_;
    const std::vector<std::int64_t>& volumes_;
    const std::vector<std::int64_t>& stars_;
    const std::vector<double>& heights_;
    std::vector<Node> nodes_;  // in order
    std::vector<Part> parts_;  // by their first node
};

}  // namespace

Remapped remapVolumes(const Mesh::Difference& difference, const std::vector<std::int64_t>& volumes,
                      const std::vector<std::int64_t>& stars, const std::vector<double>& heights) {
    return Remapping(difference, volumes, stars, heights).run();
}

}  // namespace sand::tin
