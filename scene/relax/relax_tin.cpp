// SPDX-License-Identifier: Apache-2.0
// Work of sandwall-relax on points, and on a raster that becomes a mesh.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "host/memory.hpp"
#include "host/print_line.hpp"
#include "host/whole_file.hpp"
#include "sand/tin/flow/erosion.hpp"
#include "sand/tin/flow/settle.hpp"
#include "sand/tin/tile_hash.hpp"
#include "scene/import/no_data.hpp"
#include "scene/import/raster_file.hpp"
#include "scene/import/raster_memory.hpp"
#include "scene/import/raster_units.hpp"
#include "scene/relax/options.hpp"
#include "scene/relax/ticker.hpp"
#include "scene/relax/tin_sand.hpp"

namespace scene::relax {
namespace {

struct Slid {
    std::int64_t sweeps = 0;
    int iterations = 0;
    bool atRest = false;
    double seconds = 0;
};

Slid slide(TinSand& sand, const Options& options) {
    const Ticker ticker("the sand slides");
    const Clock::time_point start = Clock::now();
    Slid slid;
    if (options.scheme == "settle") {
        const sand::tin::Settled settled = sand::tin::settle(sand.layer, sand.threshold, sand.startThreshold);
        slid = {settled.sweeps, settled.iterations, settled.atRest, 0};
    } else {
        // Sweeps in one call. Between two calls, sand that has come to rest would need the start threshold again.
        sand::tin::Erosion erosion(sand.layer, sand.threshold, sand.startThreshold);
        std::vector<sand::tin::Vertex> moved;
        const std::int64_t most = options.most.value_or(std::numeric_limits<int>::max());
        slid.sweeps = erosion.settle(sand.layer, static_cast<int>(most), moved);
        slid.atRest = erosion.settled();
    }
    slid.seconds = secondsSince(start);
    return slid;
}

nlohmann::ordered_json reportOf(const TinSand& sand, const Options& options, const RasterStatement& statement,
                                const std::optional<Thinned>& thinned, std::int64_t volumeBefore, const Slid& slid,
                                const Mesh& mesh) {
    const double talus = std::tan(options.talus * std::numbers::pi / 180);
    const Steepness steepness = steepnessOf(mesh, talus);
    nlohmann::ordered_json json;
    json["scheme"] = options.scheme;
    json["units"] = jsonOf(statement);
    json["talus_deg"] = options.talus;
    json["band"] = options.band;
    json["vertices"] = mesh.vertices.size();
    json["triangles"] = mesh.triangles.size();
    json["corners_added"] = sand.cornersAdded;
    json["places_moved"] = sand.placesMoved;
    if (thinned) {
        json["max_error"] = thinned->maxError;
        json["rms_error"] = thinned->rmsError;
    }
    json["lattice"] = sand.step;
    json["unit"] = sand.scale.unit;
    json["volume_unit"] = sand.volumeUnit();
    json["volume_before"] = volumeBefore;
    json["volume_after"] = sand.volume();
    json["volume_above"] = sand.scale.toHeight(sand.lowest);
    json["sweeps"] = slid.sweeps;
    json["iterations"] = slid.iterations;
    json["at_rest"] = slid.atRest;
    json["seconds"] = slid.seconds;
    // For a level talus this is not a number, which JSON writes as null.
    json["steepest_over_talus"] = steepness.steepest / talus;
    json["steepest_deg"] = std::atan(steepness.steepest) * 180 / std::numbers::pi;
    json["too_steep_area"] = steepness.tooSteepArea;
    json["state_hash"] = fmt::format("{:016x}", sand::tin::TileHash(sand.layer).update({}));
    return json;
}

}  // namespace

void relaxTin(const Options& options) {
    const TalusSettings material{options.talus, options.band};
    std::optional<Thinned> thinned;
    Points points;
    RasterStatement statement;
    std::vector<std::string> warnings;
    if (holdsPoints(options.in)) {
        points = readPoints(options.in);
        warnings = undeclaredNoData(points, options.in);
        statement = statementOf(points, options.in);
    } else {
        EsriGrid raster = readRaster(options.in, fitsSolver(options.in, host::freeMemoryOfProcess()));
        checkLengths(raster, options);
        statement = statementOf(raster);
        warnings = raster.warnings;
        thinned = thin(withoutEmptyEdges(std::move(raster)),
                       {options.maxError.value_or(0), options.vertices.value_or(kMostVertices)});
    }
    TinSand sand = thinned ? toTin(*thinned, options.in, material) : toTin(points, options.in, material);
    host::requireWritable(options.out);  // to report a faulty OUT before hours of work
    warnings.insert(warnings.end(), sand.warnings.begin(), sand.warnings.end());
    printStatement(statement);
    for (const std::string& warning : warnings) {
        host::printLine("warning: {}", warning);
    }
    const std::int64_t volumeBefore = sand.volume();
    const std::uint64_t hashBefore = sand::tin::TileHash(sand.layer).update({});
    const Slid slid = slide(sand, options);
    const Mesh mesh = sand.toMesh();
    writeMesh(mesh, options.out);
    const bool moved = hashBefore != sand::tin::TileHash(sand.layer).update({});
    const nlohmann::ordered_json json = reportOf(sand, options, statement, thinned, volumeBefore, slid, mesh);
    printResult(options, {moved, slid.atRest, slid.sweeps, json["steepest_deg"]});
    fmt::print("{}\n", json.dump());
}

}  // namespace scene::relax
