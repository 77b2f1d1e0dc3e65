// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/input_error.hpp"
#include "host/command_line.hpp"
#include "host/version.hpp"
#include "host/worker_pool.hpp"
#include "scene/import/raster_file.hpp"
#include "scene/relax/options.hpp"
#include "scene/relax/tin_sand.hpp"

namespace {

using scene::relax::Options;

template <class Number>
void require(bool good, const char* option, const char* range, Number got) {
    if (!good) {
        throw base::InputError(fmt::format("{} must be {}, got {}", option, range, got));
    }
}

/// Checks the ranges of the options. Some of these ranges are open, and a message names their unit.
void check(const Options& options) {
    require(options.talus >= 0 && options.talus < 90, "--talus", "within [0, 90) degrees", options.talus);
    require(options.band >= 0 && options.band <= 1, "--band", "within [0, 1]", options.band);
    require(options.threads >= 1 && options.threads <= host::kMostThreads, "--threads", "within [1, 256]",
            options.threads);
    if (options.most) {
        require(*options.most >= 1 && *options.most <= std::numeric_limits<std::int32_t>::max(), "--sweeps",
                "within [1, 2147483647], or left out to sweep until nothing moves", *options.most);
        require(options.scheme != "settle", "--sweeps", "left out with --scheme settle, which ends at rest",
                *options.most);
    }
    if (options.maxError) {
        require(*options.maxError >= 0, "--max-error", "0 or more", *options.maxError);
    }
    if (options.vertices) {
        require(*options.vertices >= 4 && *options.vertices <= scene::relax::kMostVertices, "--vertices",
                "within [4, 4194304]", *options.vertices);
    }
}

/// Refuses options that only a grid, or only the TIN of a raster, uses. They would have no effect elsewhere.
void checkKind(const Options& options, bool toMesh) {
    const bool points = scene::relax::holdsPoints(options.in);
    if (!toMesh) {
        scene::checkRasterName(options.out);
        require(!points, "OUT", "a mesh, .ply or .obj, where IN holds points", options.out);
        require(!options.maxError && !options.vertices, "--max-error and --vertices",
                "left out unless OUT is a mesh, .ply or .obj", options.out);
        return;
    }
    require(options.scheme == "g" || options.scheme == "settle", "--scheme", "g or settle for a TIN", options.scheme);
    require(options.bedrock.empty(), "--bedrock", "left out for a TIN, which has no rock", options.bedrock);
    require(!points || !options.lengths, "--lengths", "left out for points, which are not tested", options.in);
    require(options.threads == 1, "--threads", "left out for a TIN, whose sweeps have one", options.threads);
    if (points) {
        require(!options.maxError && !options.vertices, "--max-error and --vertices",
                "left out for points, because all points become vertices", options.in);
    } else if (!options.maxError && !options.vertices) {
        throw base::InputError(
            fmt::format("{}: how finely should a TIN follow it? Give --max-error, --vertices or both", options.in));
    }
}

/// Returns the values of --scheme.
std::vector<std::string> schemes() {
    constexpr auto kSchemes = base::namesOf<sand::Scheme>();
    std::vector<std::string> names(kSchemes.begin(), kSchemes.end());
    names.emplace_back("settle");
    return names;
}

int run(const Options& options) {
    check(options);
    const bool toMesh = scene::namesMesh(options.out);
    checkKind(options, toMesh);
    if (toMesh) {
        relaxTin(options);
    } else {
        relaxGrid(options);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-relax", {{"algorithm", sand::kAlgorithmVersion}})) {
        return 0;
    }
    host::CommandLine line("Lets the sand of a grid or a TIN slide until it rests at its talus.", "sandwall-relax");
    Options options;
    line.option("IN", options.in,
                "an ESRI ASCII grid of heights, a GeoTIFF or another raster; for a mesh also points, .csv or .xyz")
        .required();
    line.option("OUT", options.out,
                "file for the sand at rest; for a grid, a GeoTIFF (.tif) or else an ESRI ASCII grid, which may be IN; "
                "for a TIN, a mesh (.ply or .obj)")
        .required();
    line.option("--talus", options.talus, "steepest angle at which sand rests, in degrees, from 0 to below 90")
        .required();
    line.option("--scheme", options.scheme, "g or settle; for grids also g_plain (docs/relax.md)")
        .oneOf(schemes())
        .showDefault();
    line.option("--band", options.band, "resting sand starts to slide this share beyond the talus, from 0 to 1")
        .showDefault();
    line.option("--sweeps", options.most, "stop after this many sweeps, even if sand still moves");
    line.option("--bedrock", options.bedrock, "a grid of the same shape: rock that the sand lies on");
    line.option("--threads", options.threads, "number of threads; the result does not depend on it").showDefault();
    line.option("--max-error", options.maxError,
                "largest vertical distance of the TIN from the raster's cells, in its unit of lengths");
    line.option("--vertices", options.vertices, "most vertices in the TIN of a raster");
    line.flag("--lengths", options.lengths,
              "the coordinates of the raster IN are lengths, even if they seem to be degrees");
    return host::runMain(line, argc, argv, [&] { return run(options); });
}
