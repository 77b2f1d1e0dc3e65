// SPDX-License-Identifier: Apache-2.0
// Work of sandwall-relax on a grid.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "host/memory.hpp"
#include "host/print_line.hpp"
#include "host/whole_file.hpp"
#include "host/worker_pool.hpp"
#include "sand/grid/tile_hash.hpp"
#include "scene/import/degrees.hpp"
#include "scene/import/raster_file.hpp"
#include "scene/import/raster_memory.hpp"
#include "scene/import/raster_units.hpp"
#include "scene/import/rock_fit.hpp"
#include "scene/relax/options.hpp"
#include "scene/relax/relaxation.hpp"
#include "scene/relax/steepness.hpp"
#include "scene/relax/ticker.hpp"

namespace scene::relax {
namespace {

using nlohmann::ordered_json;

/// Returns the scheme of this name. For settle, returns the default scheme, whose sweeps end it.
sand::Scheme schemeOf(const std::string& name) { return base::valueNamed<sand::Scheme>(name).value_or(sand::Scheme{}); }

/// Prints on stderr every second how far long work has come. The report uses the last call of after().
class Progress {
public:
    explicit Progress(const GridSand& sand) : cells_(static_cast<double>(sand.field.columns()) * sand.field.rows()) {}

    /// Called after every sweep.
    void after(sand::grid::Erosion& erosion) {
        if (Clock::now() - last_ < kReportEvery) {
            return;
        }
        last_ = Clock::now();
        double moving = 0;
        for (const sand::CellRect& block : erosion.takeMoved()) {
            moving += static_cast<double>(block.x1 - block.x0) * (block.y1 - block.y0);
        }
        host::printLine("{:.0f} s: {} sweeps; in the last second sand moved in {:.3g} % of the grid",
                        secondsSince(start_), erosion.sweepsDone(), 100 * moving / cells_);
    }

private:
    double cells_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
};

struct Timed {
    Relaxed relaxed;
    double seconds = 0;
};

Timed relaxTimed(GridSand& sand, const Options& options) {
    host::WorkerPool pool(options.threads);
    const base::Executor executor = pool.executor();
    Progress progress(sand);
    const bool settle = options.scheme == "settle";
    const Manner manner{
        .settle = settle,
        .mostSweeps = options.most.value_or(std::numeric_limits<std::int64_t>::max()),
        .executor = options.threads > 1 ? &executor : nullptr,
        .afterSweep = [&](sand::grid::Erosion& erosion) { progress.after(erosion); },
    };
    std::optional<Ticker> ticker;
    if (settle && !sand.ground) {
        ticker.emplace("settling");
    }
    const Clock::time_point start = Clock::now();
    Timed timed{.relaxed = relax(sand, manner)};
    timed.seconds = secondsSince(start);
    return timed;
}

ordered_json certificatePart(const GridSand& sand, const Relaxed& relaxed) {
    if (!relaxed.certificate) {
        return nullptr;
    }
    const double cells = static_cast<double>(sand.field.columns()) * sand.field.rows();
    return {{"bound", relaxed.certificate->relative()},
            {"bound_rms", std::sqrt(relaxed.certificate->squaredDistance / cells) * sand.scale.unit}};
}

ordered_json report(const GridSand& sand, const EsriGrid& grid, const std::optional<EsriGrid>& bedrock,
                    const Options& options, std::int64_t volumeBefore, const Timed& timed) {
    const double steepest = steepestFace(sand.field, sand.rules, sand.ground ? &*sand.ground : nullptr);
    const bool swept = options.scheme == "settle" && !timed.relaxed.settled;
    ordered_json json;
    json["scheme"] = swept ? "g" : options.scheme;
    if (swept) {
        json["note"] = "settle supports neither walls nor bedrock; g swept the sand to rest instead";
    }
    json["units"] = jsonOf(statementOf(grid));
    json["bedrock_units"] = bedrock ? jsonOf(statementOf(*bedrock)) : ordered_json(nullptr);
    json["talus_deg"] = options.talus;
    json["band"] = options.band;
    json["columns"] = grid.columns;
    json["rows"] = grid.rows;
    json["unit"] = sand.scale.unit;
    json["volume_unit"] = sand.scale.unit * grid.cellSize * grid.cellDepth.value_or(grid.cellSize);
    json["volume_before"] = volumeBefore;
    json["volume_after"] = sand.volume();
    json["volume_above"] = sand.onBedrock ? ordered_json("bedrock") : ordered_json(sand.scale.toHeight(sand.lowest));
    json["sweeps"] = timed.relaxed.sweeps;
    json["iterations"] = timed.relaxed.iterations;
    json["at_rest"] = timed.relaxed.atRest;
    json["seconds"] = timed.seconds;
    // For a level talus this is not a number, which JSON writes as null.
    json["steepest_over_talus"] = steepest / sand.rules.tuning.threshold;
    json["steepest_deg"] = std::atan(steepest * sand.scale.unit / grid.cellSize) * 180 / std::numbers::pi;
    json["certificate"] = certificatePart(sand, timed.relaxed);
    json["state_hash"] = fmt::format("{:016x}", sand::grid::TileHash(sand.field).sum());
    return json;
}

}  // namespace

void checkLengths(const EsriGrid& raster, const Options& options) {
    if (!options.lengths) {
        requireLengths(raster, "; or insist on lengths with --lengths");
    }
}

void relaxGrid(const Options& options) {
    const std::int64_t free = host::freeMemoryOfProcess();
    const EsriGrid grid = readRaster(options.in, fitsSolver(options.in, free));
    checkLengths(grid, options);
    std::optional<EsriGrid> bedrock;
    if (!options.bedrock.empty()) {
        bedrock = readRaster(options.bedrock, fitsSolver(options.bedrock, free));
        requireFit(grid, *bedrock);
    }
    GridSand sand =
        toSand(grid, bedrock ? &*bedrock : nullptr, {options.talus, options.band, schemeOf(options.scheme)});
    host::requireWritable(options.out);  // to report a faulty OUT before hours of work
    std::vector<std::string> warnings = grid.warnings;
    if (bedrock) {
        warnings.insert(warnings.end(), bedrock->warnings.begin(), bedrock->warnings.end());
    }
    warnings.insert(warnings.end(), sand.warnings.begin(), sand.warnings.end());
    printStatement(statementOf(grid));
    if (bedrock) {
        printStatement(statementOf(*bedrock));
    }
    for (const std::string& warning : warnings) {
        host::printLine("warning: {}", warning);
    }
    const std::int64_t volumeBefore = sand.volume();
    const std::uint64_t hashBefore = sand::grid::TileHash(sand.field).sum();
    const Timed timed = relaxTimed(sand, options);
    writeRaster(sand.toGrid(grid), options.out);
    const bool moved = hashBefore != sand::grid::TileHash(sand.field).sum();
    const ordered_json json = report(sand, grid, bedrock, options, volumeBefore, timed);
    printResult(options, {moved, timed.relaxed.atRest, timed.relaxed.sweeps, json["steepest_deg"]});
    fmt::print("{}\n", json.dump());
}

}  // namespace scene::relax
