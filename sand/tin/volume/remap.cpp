// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/volume/remap.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

namespace sand::tin {
namespace {

std::size_t indexOf(Vertex vertex) { return static_cast<std::size_t>(vertex); }

Wide dividedDown(Wide value, Wide divisor) {
    const Wide quotient = value / divisor;
    return quotient * divisor > value ? quotient - 1 : quotient;
}

std::int64_t areaOf(const Mesh::Piece& piece) { return doubledArea(piece.place[0], piece.place[1], piece.place[2]); }

/// A vertex by number and place. Within one change, a number may pass from one vertex to another.
struct Key {
    Vertex vertex = kNoNumber;
    LatticePoint place;
    // clang-tidy 14 reports the 0 in the generated code. NOLINTNEXTLINE(modernize-use-nullptr)
    friend auto operator<=>(const Key&, const Key&) = default;
};

/// Numbers keys in the order of their first appearance. A hash table is used because a vertex appears often: in about
/// six triangles before the change and six after it.
class Nodes {
public:
    explicit Nodes(std::size_t most) : numbers_(std::bit_ceil(2 * most + 1), kNone) {}
    /// Returns the number of `key`. `found` lists all keys by number; a new key is added to it.
    std::uint32_t numberOf(const Key& key, std::vector<Key>& found) {
        const std::size_t mask = numbers_.size() - 1;
        std::size_t at = (static_cast<std::uint32_t>(key.vertex) * std::size_t{0x9e3779b1}) & mask;
        while (numbers_[at] != kNone && found[numbers_[at]] != key) {
            at = (at + 1) & mask;
        }
        if (numbers_[at] == kNone) {
            numbers_[at] = static_cast<std::uint32_t>(found.size());
            found.push_back(key);
        }
        return numbers_[at];
    }

private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    std::vector<std::uint32_t> numbers_;
};

struct Node {
    Vertex vertex = kNoNumber;
    LatticePoint place;
    std::uint32_t part = 0;  // first node of its piece
    bool before = false, now = false;
    std::int64_t star = 0;  // in the current mesh [probe unit²]
    Wide volume = 0;
    double height = 0;  // height of the previous surface there [unit]
};

/// A piece of the change: triangles that are connected through vertices.
struct Part {
    Wide missing = 0;       // volume that its vertices do not have yet [volume unit]
    std::int64_t area = 0;  // doubled area [probe unit²]
    Wide stars = 0;
    std::int64_t smallestStar = 0;
    double lowest = 0, highest = 0;
    bool empty = true;
    bool moves = false;  // whether the sand of one of its vertices moved
};

/// Finds the triangle that contains a place. The field is cut into strips from west to east. Each strip lists the
/// triangles that reach into it. Around a tool, hundreds of places are looked up among thousands of triangles.
class Strips {
public:
    explicit Strips(const std::vector<Mesh::Piece>& pieces) : pieces_(pieces) {
        west_ = std::numeric_limits<std::int32_t>::max();
        std::int32_t east = std::numeric_limits<std::int32_t>::min();
        for (const Mesh::Piece& piece : pieces_) {
            west_ = std::min(west_, westOf(piece));
            east = std::max(east, eastOf(piece));
        }
        const std::size_t count = std::clamp<std::size_t>(pieces_.size() / kTogether, 1, kMost);
        width_ = pieces_.empty() ? 1 : (east - west_) / static_cast<std::int32_t>(count) + 1;
        strips_.resize(count);
        for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
            for (std::size_t at = strip(westOf(pieces_[i])); at <= strip(eastOf(pieces_[i])); ++at) {
                strips_[at].push_back(i);
            }
        }
    }

    /// Returns the first triangle of the list for which visit(piece) is true, or null. Visits only triangles that may
    /// contain the place.
    template <class Visit>
    [[nodiscard]] const Mesh::Piece* first(const LatticePoint& place, const Visit& visit) const {
        const std::size_t at = strip(place.x);
        if (place.x < west_ || at >= strips_.size()) {
            return nullptr;
        }
        const auto found = std::find_if(strips_[at].begin(), strips_[at].end(), [&](std::uint32_t i) {
            const auto& [a, b, c] = pieces_[i].place;
            return std::min({a.y, b.y, c.y}) <= place.y && std::max({a.y, b.y, c.y}) >= place.y && visit(pieces_[i]);
        });
        return found == strips_[at].end() ? nullptr : &pieces_[*found];
    }

private:
    static constexpr std::size_t kTogether = 8, kMost = 256;

    static std::int32_t westOf(const Mesh::Piece& piece) {
        return std::min({piece.place[0].x, piece.place[1].x, piece.place[2].x});
    }
    static std::int32_t eastOf(const Mesh::Piece& piece) {
        return std::max({piece.place[0].x, piece.place[1].x, piece.place[2].x});
    }
    [[nodiscard]] std::size_t strip(std::int32_t x) const { return static_cast<std::size_t>((x - west_) / width_); }

    const std::vector<Mesh::Piece>& pieces_;
    std::int32_t west_, width_;
    std::vector<std::vector<std::uint32_t>> strips_;  // indices of the triangles in each strip, ascending
};

class Remapping {
public:
    Remapping(const Mesh::Difference& difference, const SandBefore& before)
        : difference_(difference),
          volumes_(before.volumes),
          stars_(before.stars),
          heights_(before.heights),
          moving_(before.moving) {}

    Remapped run() {
        gatherNodes();
        gatherStars();
        gatherParts();
        for (Node& node : nodes_) {
            if (node.now) {
                keepHeight(node);
            }
        }
        return share();
    }

private:
    using Corners = std::array<std::uint32_t, 3>;  // nodes of a triangle

    void gatherNodes() {
        std::vector<Key> found;
        Nodes nodes(3 * (difference_.removed.size() + difference_.added.size()));
        const auto cornersOf = [&](const Mesh::Piece& piece) {
            Corners corners{};
            for (std::size_t i = 0; i < 3; ++i) {
                corners[i] = nodes.numberOf({piece.corner[i], piece.place[i]}, found);
            }
            return corners;
        };
        std::transform(difference_.removed.begin(), difference_.removed.end(), std::back_inserter(removed_), cornersOf);
        std::transform(difference_.added.begin(), difference_.added.end(), std::back_inserter(added_), cornersOf);
        std::vector<std::uint32_t> order(found.size()), rank(found.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return found[a] < found[b]; });
        nodes_.resize(found.size());
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            rank[order[i]] = i;
            nodes_[i].vertex = found[order[i]].vertex;
            nodes_[i].place = found[order[i]].place;
            nodes_[i].part = i;
        }
        for (auto* triangles : {&removed_, &added_}) {
            for (Corners& corners : *triangles) {
                std::transform(corners.begin(), corners.end(), corners.begin(),
                               [&rank](std::uint32_t number) { return rank[number]; });
            }
        }
    }

    void gatherStars() {
        for (std::size_t i = 0; i < removed_.size(); ++i) {
            for (const std::uint32_t corner : removed_[i]) {
                Node& node = nodes_[corner];
                node.star += (node.before ? 0 : stars_[indexOf(node.vertex)]) - areaOf(difference_.removed[i]);
                node.before = true;
            }
        }
        for (std::size_t i = 0; i < added_.size(); ++i) {
            for (const std::uint32_t corner : added_[i]) {
                nodes_[corner].star += areaOf(difference_.added[i]);
                nodes_[corner].now = true;
            }
        }
    }

    std::uint32_t first(std::uint32_t node) {
        while (nodes_[node].part != node) {
            nodes_[node].part = nodes_[nodes_[node].part].part;  // shortens the path for the next call
            node = nodes_[node].part;
        }
        return node;
    }

    void gatherParts() {
        for (const auto* triangles : {&removed_, &added_}) {
            for (const Corners& corners : *triangles) {
                for (const std::uint32_t corner : {corners[1], corners[2]}) {
                    const std::uint32_t a = first(corners[0]);
                    const std::uint32_t b = first(corner);
                    nodes_[std::max(a, b)].part = std::min(a, b);
                }
            }
        }
        parts_.resize(nodes_.size());
        for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
            nodes_[i].part = nodes_[nodes_[i].part].part;  // earlier nodes lead to their first node already
            if (!nodes_[i].before) {
                continue;
            }
            Part& part = parts_[nodes_[i].part];
            const double height = heights_[indexOf(nodes_[i].vertex)];
            part.missing += volumes_[indexOf(nodes_[i].vertex)];
            part.lowest = part.empty ? height : std::min(part.lowest, height);
            part.highest = part.empty ? height : std::max(part.highest, height);
            part.empty = false;
            part.moves = part.moves || moving_[indexOf(nodes_[i].vertex)] != 0;
        }
        for (std::size_t i = 0; i < added_.size(); ++i) {
            parts_[nodes_[added_[i][0]].part].area += areaOf(difference_.added[i]);
        }
    }

    /// Returns the height of the previous surface at `place` [unit]. If several triangles share the place, the first
    /// one counts.
    [[nodiscard]] double oldHeight(const LatticePoint& place) {
        if (!strips_) {
            strips_.emplace(difference_.removed);
        }
        std::array<std::int64_t, 3> weight{};
        const Mesh::Piece* piece = strips_->first(place, [&](const Mesh::Piece& one) {
            const auto& [a, b, c] = one.place;
            weight = {doubledArea(b, c, place), doubledArea(c, a, place), doubledArea(a, b, place)};
            return weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0;
        });
        if (piece != nullptr) {
            const double lowest = heights_[indexOf(piece->corner[0])];
            const double rise = static_cast<double>(weight[1]) * (heights_[indexOf(piece->corner[1])] - lowest) +
                                static_cast<double>(weight[2]) * (heights_[indexOf(piece->corner[2])] - lowest);
            return lowest + rise / static_cast<double>(weight[0] + weight[1] + weight[2]);
        }
        return 0;  // not reached, because both lists of triangles cover the same ground
    }

    void keepHeight(Node& node) {
        const std::int64_t star = node.star;
        if (node.before) {
            node.height = heights_[indexOf(node.vertex)];
            const std::int64_t old = stars_[indexOf(node.vertex)];
            node.volume = dividedDown(static_cast<Wide>(2) * volumes_[indexOf(node.vertex)] * star + old,
                                      static_cast<Wide>(2) * old);
        } else {
            node.height = oldHeight(node.place);
            const double whole = std::floor(node.height);
            const double rest = (node.height - whole) * static_cast<double>(star);
            node.volume = static_cast<Wide>(static_cast<std::int64_t>(whole)) * star +
                          static_cast<std::int64_t>(std::floor(rest + 0.5));
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
                const Wide dealt = dividedDown(part.missing * node.star, part.stars);
                node.volume += dealt;
                left[node.part] -= dealt;
            }
        }
        Remapped result;
        for (const Node& node : nodes_) {
            if (!node.now) {
                result.removed.push_back(node.vertex);
                continue;
            }
            const Wide unit = left[node.part] > 0 ? 1 : 0;
            left[node.part] -= unit;
            const Part& part = parts_[node.part];
            const double reach = 3 * static_cast<double>(part.area) / static_cast<double>(part.stars);
            const double bound =
                (part.highest - part.lowest) * reach + 2 / static_cast<double>(part.smallestStar) + 0x1p-20;
            const bool moves = node.before ? moving_[indexOf(node.vertex)] != 0 : part.moves;
            result.shares.push_back({node.vertex, node.star, node.volume + unit, node.height, bound, node.part, moves});
        }
        return result;
    }

    const Mesh::Difference& difference_;
    const std::vector<std::int64_t>& volumes_;
    const std::vector<std::int64_t>& stars_;
    const std::vector<double>& heights_;
    const std::vector<std::uint8_t>& moving_;
    std::optional<Strips> strips_;  // of the triangles that went; created when first needed
    std::vector<Node> nodes_;       // in the order of Key
    std::vector<Corners> removed_, added_;
    std::vector<Part> parts_;  // by their first node
};

}  // namespace

void levelPieces(Remapped& result, const std::function<bool(const Remapped::Share&)>& fits) {
    struct Sum {
        Wide volume = 0, stars = 0, rest = 0;
    };
    std::map<std::uint32_t, Sum> sums;  // of the pieces that become level; nearly always empty
    for (const Remapped::Share& share : result.shares) {
        if (!fits(share)) {
            sums.emplace(share.piece, Sum());
        }
    }
    if (sums.empty()) {
        return;
    }
    const auto forEach = [&](const auto& visit) {
        for (Remapped::Share& share : result.shares) {
            if (const auto found = sums.find(share.piece); found != sums.end()) {
                visit(share, found->second);
            }
        }
    };
    forEach([](const Remapped::Share& share, Sum& sum) {
        sum.volume += share.volume;
        sum.stars += share.star;
        sum.rest = sum.volume;
    });
    forEach([](Remapped::Share& share, Sum& sum) {
        share.volume = dividedDown(sum.volume * share.star, sum.stars);
        share.bound = std::numeric_limits<double>::infinity();
        sum.rest -= share.volume;
    });
    forEach([](Remapped::Share& share, Sum& sum) {
        const Wide unit = sum.rest > 0 ? 1 : 0;
        share.volume += unit;
        sum.rest -= unit;
    });
}

Remapped remapVolumes(const Mesh::Difference& difference, const SandBefore& before) {
    return Remapping(difference, before).run();
}

}  // namespace sand::tin
