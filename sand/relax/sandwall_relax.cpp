// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "files/command_line.hpp"
#include "files/whole_file.hpp"
#include "sand/import/raster_file.hpp"
#include "sand/relax/relaxation.hpp"
#include "sand/relax/steepness.hpp"
#include "sand/state_hash.hpp"
#include "workers/worker_pool.hpp"

namespace {

using nlohmann::ordered_json;
using sand::relax::GridSand;
using sand::relax::Relaxed;
using Clock = std::chrono::steady_clock;

constexpr auto kReportEvery = std::chrono::seconds(1);

struct Options {
    std::string in, out, scheme = "g", bedrock;
    double talus = 0;                  // [degree]
    double band = 0;                   // share of the talus
    std::optional<std::int64_t> most;  // sweeps
    int threads = 1;
};

template <class Number>
void require(bool good, const char* option, const char* range, Number got) {
    if (!good) {
        throw files::InputError(fmt::format("{} must be {}, got {}", option, range, got));
    }
}

/// Not CLI11's checks, which let "nan" pass.
void check(const Options& options) {
    require(options.talus >= 0 && options.talus < 90, "--talus", "within [0, 90) degrees", options.talus);
    require(options.band >= 0 && options.band <= 1, "--band", "within [0, 1]", options.band);
    require(options.threads >= 1 && options.threads <= workers::kMostThreads, "--threads", "within [1, 256]",
            options.threads);
    if (options.most) {
        require(*options.most >= 1 && *options.most <= std::numeric_limits<std::int32_t>::max(), "--sweeps",
                "within [1, 2147483647], or left out to sweep until nothing moves", *options.most);
        require(options.scheme != "settle", "--sweeps", "left out with --scheme settle, which ends at rest",
                *options.most);
    }
}

sand::Scheme schemeOf(const std::string& name) {
    if (name == "n4") {
        return sand::Scheme::n4;
    }
    return name == "g_plain" ? sand::Scheme::plainIsotropic : sand::Scheme::isotropic;
}

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Says on stderr how far long work has come: what `after` was told last, every second.
class Progress {
public:
    explicit Progress(const GridSand& sand) : cells_(static_cast<double>(sand.field.columns()) * sand.field.rows()) {}

    /// Called after every sweep.
    void after(sand::Erosion& erosion) {
        if (Clock::now() - last_ < kReportEvery) {
            return;
        }
        last_ = Clock::now();
        double moving = 0;
        for (const sand::Rect& block : erosion.takeMoved()) {
            moving += static_cast<double>(block.x1 - block.x0) * (block.y1 - block.y0);
        }
        fmt::print(stderr, "{:.0f} s: {} sweeps; in the last second sand moved in {:.3g} % of the grid\n",
                   secondsSince(start_), erosion.sweepsDone(), 100 * moving / cells_);
    }

private:
    double cells_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
};

/// Says every second that settling goes on: it has no sweeps to count before its end.
class Ticker {
public:
    Ticker() : thread_([this](const std::stop_token& stop) { tick(stop); }) {}

private:
    void tick(const std::stop_token& stop) {
        const Clock::time_point start = Clock::now();
        std::unique_lock lock(mutex_);
        while (!wake_.wait_for(lock, stop, kReportEvery, [] { return false; }) && !stop.stop_requested()) {
            fmt::print(stderr, "{:.0f} s: settling\n", secondsSince(start));
        }
    }

    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread thread_;  // last: it uses the others
};

struct Timed {
    Relaxed relaxed;
    double seconds = 0;
};

Timed relaxTimed(GridSand& sand, const Options& options) {
    workers::WorkerPool pool(options.threads);
    const sand::Executor executor = pool.executor();
    Progress progress(sand);
    const bool settle = options.scheme == "settle";
    const sand::relax::Manner manner{
        .settle = settle,
        .mostSweeps = options.most.value_or(std::numeric_limits<std::int64_t>::max()),
        .executor = options.threads > 1 ? &executor : nullptr,
        .afterSweep = [&](sand::Erosion& erosion) { progress.after(erosion); },
    };
    std::optional<Ticker> ticker;
    if (settle && !sand.ground) {
        ticker.emplace();
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
    return {{"gap", relaxed.certificate->relativeGap()},
            {"bound", relaxed.certificate->relative()},
            {"bound_rms", std::sqrt(relaxed.certificate->squaredDistance / cells) * sand.scale.unit}};
}

ordered_json report(const GridSand& sand, const sand::EsriGrid& grid, const Options& options, std::int64_t volumeBefore,
                    const Timed& timed) {
    const double steepest = sand::relax::steepestFace(sand.field, sand.rules, sand.ground ? &*sand.ground : nullptr);
    const bool swept = options.scheme == "settle" && !timed.relaxed.settled;
    ordered_json json;
    json["scheme"] = swept ? "g" : options.scheme;
    if (swept) {
        json["note"] = "settle knows neither walls nor bedrock; swept to rest by g instead";
    }
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
    // No number, and so null, for a level talus.
    json["steepest_over_talus"] = steepest / sand.rules.threshold;
    json["steepest_deg"] = std::atan(steepest * sand.scale.unit / grid.cellSize) * 180 / std::numbers::pi;
    json["certificate"] = certificatePart(sand, timed.relaxed);
    json["state_hash"] = fmt::format("{:016x}", sand::StateHash(sand.field).update(sand.field));
    return json;
}

int run(const Options& options) {
    check(options);
    const sand::EsriGrid grid = sand::readRaster(options.in, sand::namesGeoTiff(options.out));
    std::optional<sand::EsriGrid> bedrock;
    if (!options.bedrock.empty()) {
        bedrock = sand::readRaster(options.bedrock);
    }
    GridSand sand = sand::relax::toSand(grid, bedrock ? &*bedrock : nullptr,
                                        {options.talus, options.band, schemeOf(options.scheme)});
    { const files::WholeFile canBeWritten(options.out); }  // hours later would be too late to find out
    for (const std::string& warning : sand.warnings) {
        fmt::print(stderr, "warning: {}\n", warning);
    }
    const std::int64_t volumeBefore = sand.volume();
    const Timed timed = relaxTimed(sand, options);
    sand::writeRaster(sand.toGrid(grid), options.out);
    fmt::print("{}\n", report(sand, grid, options, volumeBefore, timed).dump());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Lets the sand of a grid slide until it lies nowhere steeper than its talus.", "sandwall-relax"};
    Options options;
    app.add_option("IN", options.in,
                   "an ESRI ASCII grid of heights, a GeoTIFF or another raster; cells without data are walls")
        ->required();
    app.add_option("OUT", options.out, "the grid at rest, a GeoTIFF when it ends in .tif; may be IN")->required();
    app.add_option("--talus", options.talus, "steepest angle at which sand rests, in degrees, from 0 to below 90")
        ->required();
    app.add_option("--scheme", options.scheme, "g, g_plain, n4 or settle (docs/relax.md)")
        ->check(CLI::IsMember({"g", "g_plain", "n4", "settle"}))
        ->capture_default_str();
    app.add_option("--band", options.band, "resting sand starts to slide this share beyond the talus, from 0 to 1")
        ->capture_default_str();
    app.add_option("--sweeps", options.most, "sweeps after which to stop though sand still moves");
    app.add_option("--bedrock", options.bedrock, "a grid of the same shape: rock that the sand lies on");
    app.add_option("--threads", options.threads, "how many; the result never depends on it")->capture_default_str();
    return files::runMain(app, argc, argv, [&] { return run(options); });
}
