// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "base/byte_stream.hpp"
#include "sand/model/cell_array.hpp"
#include "sand/model/rules.hpp"
#include "sand/model/step.hpp"
#include "sand/model/surface_data.hpp"
#include "sand/model/tool_shape.hpp"

namespace sand {

/// A tool as it is turned.
struct HeldTool {
    ToolShape shape;
    Heading heading;
};

/// Hashes of the parts of a surface, whose sum is the surface's. Where a part lies is the same on every rank.
class HashTiles {
public:
    virtual ~HashTiles() = default;
    [[nodiscard]] int tileCount() const { return static_cast<int>(hashes_.size()); }
    [[nodiscard]] const std::vector<std::uint64_t>& tileHashes() const { return hashes_; }
    /// The nominal cells around it; empty when it holds nothing.
    [[nodiscard]] virtual CellRect cellsOf(int tile) const = 0;

protected:
    HashTiles() = default;
    HashTiles(const HashTiles&) = default;
    HashTiles& operator=(const HashTiles&) = default;
    HashTiles(HashTiles&&) = default;
    HashTiles& operator=(HashTiles&&) = default;
    std::vector<std::uint64_t> hashes_;
};

/// Sand without its rules and its tool: what is saved, loaded and put back. Read by any thread.
class SurfaceCopy {
public:
    SurfaceCopy() = default;
    SurfaceCopy(const SurfaceCopy&) = default;
    SurfaceCopy& operator=(const SurfaceCopy&) = default;
    virtual ~SurfaceCopy() = default;
    /// Compressed.
    [[nodiscard]] virtual base::Bytes encode() const = 0;
};

/// Throws base::FormatError for bytes that are no sand of the surface it is of, or go on behind it. May be called by
/// any thread, as long as anybody likes.
using SurfaceReader = std::function<std::shared_ptr<const SurfaceCopy>(std::span<const std::uint8_t>)>;

/// What lies in the box and can be dug: sand as a height field, or as a TIN. Replica alone changes it, by steps, and
/// says what of it they depend on. Not thread-safe.
class Surface {
public:
    virtual ~Surface() = default;
    [[nodiscard]] virtual std::unique_ptr<Surface> clone() const = 0;

    /// The tool goes along a path of two points or more, from the first, where it is; it presses where two are one.
    virtual void drag(const HeldTool& tool, std::span<const ProbePoint> path) = 0;
    /// Sand that the tool held back there may flow again.
    virtual void release(const HeldTool& tool, const ProbePoint& at) = 0;
    /// The tool has left the sand.
    virtual void leave(const HeldTool&) {}
    /// Lets the sand slide; around `tool` when it is not null, which stands at `at`.
    virtual void sweep(int sweeps, const HeldTool* tool, const ProbePoint& at) = 0;
    /// Everything may move from now on.
    virtual void changeRules(const Rules& rules) = 0;
    virtual void settle() = 0;
    virtual void reset() = 0;

    /// Keeps the sand as it is, for an undo.
    virtual void keep() = 0;
    virtual void keep(const SurfaceCopy& copy) = 0;  // one that a SurfaceReader of this surface made
    virtual void forget() = 0;
    [[nodiscard]] virtual std::shared_ptr<const SurfaceCopy> kept() const = 0;  // null when nothing is
    [[nodiscard]] virtual bool hasKept() const = 0;
    virtual void putBackKept() = 0;

    [[nodiscard]] virtual std::shared_ptr<const SurfaceCopy> copy() const = 0;
    [[nodiscard]] virtual SurfaceReader reader() const = 0;
    virtual void replace(const SurfaceCopy& copy) = 0;  // likewise

    [[nodiscard]] virtual std::int64_t outflow() const = 0;  // lost over an open rim, in the surface's own unit
    [[nodiscard]] virtual std::int64_t volume() const = 0;   // of all sand, exact, in the same unit
    [[nodiscard]] virtual bool settled() const = 0;
    [[nodiscard]] virtual int age() const = 0;  // of the sand's inertia [sweep]; 0 without

    /// Hash of all sand, costing what changed.
    [[nodiscard]] virtual std::uint64_t hash() = 0;
    virtual void audit(int tiles) = 0;
    [[nodiscard]] virtual const HashTiles& hashTiles() const = 0;
    [[nodiscard]] virtual std::vector<std::int32_t> valuesOf(int tile) const = 0;  // what is hashed, for a comparison
    virtual void corrupt(int column, int row, int bit) = 0;

    /// The surface there [unit]; the nearest place of the field beyond it.
    [[nodiscard]] virtual double height(double x, double y /* [probe unit] */) const = 0;

    /// The sand as it is. Refers to this surface; read it again after a change.
    [[nodiscard]] virtual SurfaceData data() const = 0;
    /// Returns the change since the last call; the first call returns a whole change. The surface records changes only
    /// from then on, so that a replica that is not drawn holds no lists.
    [[nodiscard]] virtual SurfaceChange takeChange() = 0;
};

}  // namespace sand
