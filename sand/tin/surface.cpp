// SPDX-License-Identifier: Apache-2.0
#include "sand/tin/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sand/tin/flow/settle.hpp"
#include "sand/tin/refine/start_maker.hpp"

namespace sand::tin {
namespace {

constexpr int kRemovalsPerStep = 64;
constexpr int kSweepsToRest = 1 << 20;       // more than a user would wait for
constexpr std::size_t kMoreVertices = 4096;  // least room for vertices beyond those of the start

DetailRules detailOf(const TinStart& start, Rim rim) {
    const Settings& settings = start.settings;
    DetailRules rules;
    rules.firstToGo = static_cast<Vertex>(start.places.size());
    rules.spacing = settings.spacing;
    rules.maxError = settings.maxError;
    rules.removals = settings.maxError > 0 ? kRemovalsPerStep : 0;
    rules.maxVertices = settings.mostVertices;
    rules.keepsConstraints = settings.keepConstraints;
    rules.keepsRim = rim == Rim::open;
    return rules;
}

void addTo(std::vector<std::int32_t>& all, const std::vector<std::int32_t>& more) {
    all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

TinSurface::TinSurface(const Rules& rules, std::shared_ptr<const TinStart> start)
    : start_(std::move(start)),
      detail_(detailOf(*start_, rules.rim)),
      rim_(rules.rim),
      threshold_(rules.tuning.threshold),
      startThreshold_(rules.tuning.startThreshold),
      layer_(layerOf(*start_)),
      startVertices_(layer_.triangles().places.size()),
      erosion_(layer_, threshold_, startThreshold_, rim_),
      hash_(layer_),
      beforeStroke_(layer_) {
    (void)layer_.takeChange();
    layerReplaced();
}

TinSurface::TinSurface(const TinSurface& other)
    : start_(other.start_),
      detail_(other.detail_),
      rim_(other.rim_),
      threshold_(other.threshold_),
      startThreshold_(other.startThreshold_),
      layer_(Snapshot(other.layer_, other.state_).layer()),
      startVertices_(other.startVertices_),
      state_(other.state_),
      refused_(other.refused_),
      erosion_(layer_, threshold_, startThreshold_, rim_),
      hash_(layer_),
      beforeStroke_(layer_) {
    (void)layer_.takeChange();
    layerReplaced();
    if (other.beforeStroke_.any()) {
        beforeStroke_.keep(other.beforeStroke_.copy());
    }
}

void TinSurface::layerReplaced() {
    layer_.limitVertices(limits().mostVertices);
    view_.emplace(SurfaceView{layer_.triangles(), layer_.heights(), detail_.spacing});
    reserve();
}

void TinSurface::reserve() {
    const std::size_t there = layer_.triangles().places.size();
    const std::size_t most = std::max(there, static_cast<std::size_t>(detail_.maxVertices)) + kMoreVertices;
    const std::size_t vertices = std::min(most, there + there / 4 + kMoreVertices);
    layer_.reserve(vertices);
    erosion_.reserve(vertices);
    hash_.reserve(vertices);
    beforeStroke_.reserve(vertices);
    records_.reserve(vertices);
    neighbourhood_->reserve(vertices);
    coarsening_.reserve(vertices);
}

Displacement& TinSurface::displacementOf(const Tool& tool) {
    if (!displacement_ || displacement_->tool() != tool) {
        displacement_.emplace(tool, detail_, neighbourhood_);
    }
    return *displacement_;
}

void TinSurface::meshChanged() {
    const Mesh::Change change = layer_.takeChange();
    if (change.triangles.empty() && change.vertices.empty()) {
        return;
    }
    sawAll_ = false;
    erosion_.changed(layer_, change);
    hash_.touch(layer_, change.vertices);
    hash_.touchTriangles(layer_, change.triangles);
    beforeStroke_.touch(change.vertices);
    beforeStroke_.touchTriangles(change.triangles);
    records_.touch(change.vertices);
    records_.touchTriangles(change.triangles);
    if (detail_.removals > 0) {
        coarsening_.touch(layer_.triangles(), change);
    }
    if (changed_) {
        addTo(changed_->triangles, change.triangles);
        addTo(changed_->vertices, change.vertices);
    }
}

void TinSurface::wakeFull(const Underside& under, const Box& reach) {
    if (!sawAll_ || neighbourhood_->box().joinedWith(reach.clippedTo(layer_.triangles())) != neighbourhood_->box()) {
        neighbourhood_->look(layer_.triangles(), reach);
    }
    std::vector<Vertex> full;
    std::copy_if(neighbourhood_->vertices().begin(), neighbourhood_->vertices().end(), std::back_inserter(full),
                 [&](Vertex vertex) {
                     const auto i = static_cast<std::size_t>(vertex);
                     return reach.holds(layer_.triangles().places[i]) &&
                            layer_.heights()[i] > under(layer_.triangles().places[i]) - 1.0;
                 });
    erosion_.wake(full);
}

void TinSurface::sandMoved(const std::vector<Vertex>& vertices) {
    if (vertices.empty()) {
        return;
    }
    if (detail_.removals > 0) {
        coarsening_.touch(layer_.triangles(), vertices);
    }
    hash_.touch(layer_, vertices);
    beforeStroke_.touch(vertices);
    records_.touch(vertices);
    if (changed_) {
        addTo(changed_->vertices, vertices);
    }
}

void TinSurface::drag(const Tool& tool, std::span<const ProbePoint> path) {
    displaced(tool, displacementOf(tool).drag(layer_, state_.imprint, rim_, path));
    sawAll_ = state_.imprint.pose && state_.imprint.pose->probe == path.back();
}

void TinSurface::hold(const Tool& tool, const ProbePoint& probe) {
    displaced(tool, displacementOf(tool).hold(layer_, state_.imprint, rim_, probe));
}

void TinSurface::displaced(const Tool& tool, const Displacement::Work& done) {
    state_.outflow += static_cast<std::int64_t>(done.outflow);
    refused_.count += done.refused;
    if (done.refused > 0 && !refused_.first) {
        refused_.first = {tool, std::nullopt};
    }
    meshChanged();
    sandMoved(done.touched);
    erosion_.wake(done.touched);
}

void TinSurface::leave(const Tool& tool) {
    displacementOf(tool).leave(layer_, state_.imprint);
    meshChanged();
}

Swept TinSurface::sweep(const SweepPart& part, const Tool* tool, const ProbePoint& probe) {
    if (detail_.removals > 0) {
        const Box keepOut = tool == nullptr ? Box{} : displacementOf(*tool).reach(probe);
        if (coarsening_.step(layer_, detail_, state_.nextToGo, keepOut) > 0) {
            meshChanged();
        }
    }
    moved_.clear();
    int sweeps = 0;
    if (tool != nullptr) {
        const Displacement& here = displacementOf(*tool);
        const Underside under = here.underside(probe);
        const Imprint::Pose pose{probe, *tool};
        if (held_ != pose) {
            held_ = pose;
            wakeFull(under, here.reach(probe));
        }
        sweeps = erosion_.sweep(layer_, part.sweeps, &under, moved_);
    } else {
        held_.reset();
        sweeps = erosion_.sweep(layer_, part.sweeps, nullptr, moved_);
    }
    state_.outflow += erosion_.takeOutflow();
    sandMoved(moved_);
    return {sweeps, settled()};
}

void TinSurface::changeRules(const Rules& rules) {
    threshold_ = rules.tuning.threshold;
    startThreshold_ = rules.tuning.startThreshold;
    erosion_.changeThresholds(threshold_, startThreshold_);
}

bool TinSurface::settle() {
    held_.reset();
    if (erosion_.settled()) {
        return true;
    }
    // A TIN may take twice the time of a grid. Its sweeps in steps leave more sand in the wrong place than a
    // projection.
    WorkLimit limit(2 * mostSettlingWork());
    const Settled settled = tin::settle(layer_, threshold_, startThreshold_, kSweepsToRest, rim_, &limit);
    sandMoved(settled.moved);
    erosion_.wake(settled.moved);
    moved_.clear();
    if (settled.atRest) {
        erosion_.settle(layer_, 1, moved_);  // so that erosion_ finds all sand at rest
    }
    state_.outflow += settled.outflow + erosion_.takeOutflow();
    sandMoved(moved_);
    return settled.atRest;
}

std::int64_t TinSurface::sweepCost() const {
    const std::int64_t cells = std::int64_t{start_->width / kLatticePerCell} * (start_->depth / kLatticePerCell);
    return std::max(cells, workOfSweep(layer_));
}

SandLimits TinSurface::limits() const {
    return {start_->width, start_->depth, start_->holes, std::max(start_->mostVertices(), startVertices_)};
}

void TinSurface::reset() { replace(Snapshot(layerOf(*start_), {})); }

std::shared_ptr<const SurfaceCopy> TinSurface::copy() const { return std::make_shared<const Snapshot>(layer_, state_); }

SurfaceReader TinSurface::reader() const {
    return [limits = limits()](std::span<const std::uint8_t> bytes) -> std::shared_ptr<const SurfaceCopy> {
        return std::make_shared<const Snapshot>(bytes, limits);
    };
}

std::function<void()> TinSurface::decode(std::span<const std::uint8_t> sand, std::span<const std::uint8_t> kept,
                                         const Decoding&) {
    const auto next = std::make_shared<const Snapshot>(sand, limits());
    const auto stroke = kept.empty() ? nullptr : std::make_shared<const Snapshot>(kept, limits());
    return [this, next, stroke] {
        replace(*next);
        if (stroke != nullptr) {
            beforeStroke_.keep(stroke);
        }
    };
}

void TinSurface::replace(const SurfaceCopy& copy) {
    const auto& sand = dynamic_cast<const Snapshot&>(copy);
    // Allocates first, so that a surface without memory for this sand stays as it is.
    VertexSand layer = sand.layer();
    (void)layer.takeChange();
    TileHash hash(layer);
    TinState state = sand.state();
    beforeStroke_.replaced(layer);
    layer_ = std::move(layer);
    state_ = std::move(state);
    erosion_ = Erosion(layer_, threshold_, startThreshold_, rim_);
    hash_ = std::move(hash);
    layerReplaced();
    held_.reset();
    sawAll_ = false;
    coarsening_.forget();
    changed_.reset();
    lastFound_ = kNoNumber;
    records_.replaced(layer_);
}

std::shared_ptr<SurfaceRecord> TinSurface::recordLike(const SurfaceRecord& parts, const SurfaceRecord* moment) {
    return records_.recordLike(layer_, state_, Record::of(parts), moment == nullptr ? nullptr : &Record::of(*moment));
}

void TinSurface::audit(int tiles) {
    for (int i = 0; i < std::min(tiles, hash_.tileCount()); ++i) {
        hash_.auditNext(layer_);
    }
}

std::vector<std::int32_t> TinSurface::valuesOf(int tile) const { return TileHash::valuesOf(layer_, tile); }

void TinSurface::corrupt(int column, int row, int bit) {
    const LatticePoint place{(column * 2 + 1) * kLatticePerCell / 2, (row * 2 + 1) * kLatticePerCell / 2};
    const Located found = locate(layer_.triangles(), place, lastFound_);
    const Vertex vertex = layer_.triangles().triangles[static_cast<std::size_t>(found.triangle)].corner[0];
    const std::int64_t volume = layer_.volumes()[static_cast<std::size_t>(vertex)];
    layer_.add(vertex, (volume ^ (std::int64_t{1} << bit)) - volume);
}

HeightSpan TinSurface::heights() const {
    HeightSpan span{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
    for (const Triangle& triangle : layer_.triangles().triangles) {
        if (triangle.isGround()) {
            for (const Vertex vertex : triangle.corner) {
                const double height = layer_.heights()[index(vertex)];
                span = {std::min(span.lowest, height), std::max(span.highest, height)};
            }
        }
    }
    return span.lowest <= span.highest ? span : HeightSpan{};
}

double TinSurface::height(double x, double y) const {
    const auto lattice = [](double place, std::int32_t most) {
        return static_cast<std::int32_t>(std::clamp(std::floor(place + 0.5), 0.0, static_cast<double>(most)));
    };
    const Triangles& mesh = layer_.triangles();
    const Located found = locate(mesh, {lattice(x, mesh.width), lattice(y, mesh.depth)}, lastFound_);
    lastFound_ = found.triangle;
    return layer_.heightAt(found);
}

SurfaceChange TinSurface::takeChange() {
    if (!changed_) {
        changed_.emplace();
        return {};
    }
    sortOnce(changed_->triangles);
    sortOnce(changed_->vertices);
    return {.whole = false, .parts = std::exchange(*changed_, {})};
}

}  // namespace sand::tin
