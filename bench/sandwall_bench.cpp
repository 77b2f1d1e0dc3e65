// SPDX-License-Identifier: Apache-2.0
// Measures the curves of docs/report. Each curve is a subcommand; scripts/report.sh runs and draws all of them.
#include <string_view>

#include "bench/report/curves.hpp"
#include "bench/session/latency.hpp"
#include "host/command_line.hpp"
#include "host/version.hpp"
#include "scene/model/scene.hpp"

namespace {

struct Curve {
    const char* name;
    const char* what;
    std::vector<int> sizes;  // [cell]; empty: the curve measures a scene file; {0}: it needs neither field nor scene
    int runs;
    void (*measure)(const bench::Settings&, bench::Csv&);
};

std::vector<Curve> allCurves() {
    return {
        {"work-precision",
         "error against run time: our schemes and the rules in common use",
         {16, 32, 64, 128, 256},
         10,
         bench::workPrecision},
        {"error-at-rest", "error of the piles at rest, and its order in N", {32, 64, 128, 256}, 1, bench::errorAtRest},
        {"sweeps", "sweeps until nothing moves, with and without a band", {32, 64, 128, 256}, 1, bench::sweeps},
        {"anisotropy", "radius of the piles by direction", {64, 128}, 1, bench::anisotropy},
        {"decay", "moving sand and distance to rest, by sweep", {128}, 1, bench::decay},
        {"height-bits", "error by the size of the height unit", {32, 64, 128}, 1, bench::heightBits},
        {"band", "sweeps and error by the width of the hysteresis band", {128}, 1, bench::band},
        {"bounds",
         "time of the most expensive paths and settles that a peer can ask for",
         {512, 2048, 4096},
         1,
         bench::bounds},
        {"edit",
         "time of one edit by the tool's radius, with active blocks and with all blocks",
         {512, 1024, 2048},
         10,
         bench::edit},
        {"large-tools",
         "time per step of large tools, and how far the sand is from that of all sweeps",
         {512, 1024},
         1,
         bench::largeTools},
        {"dig", "time per step of digging, and share of sand that has yet to move", {512, 2048}, 10, bench::dig},
        {"held-tools", "sand that runs past a tool held on a slope, by run time", {96}, 1, bench::heldTools},
        {"throughput",
         "time per cell of a sweep, beside a copy of the same bytes",
         {64, 128, 256, 512, 1024, 2048, 4096},
         10,
         bench::throughput},
        {"rest", "time to rest of a pile", {512}, 10, bench::rest},
        {"rest-moving",
         "time to rest of a field in which all sand moves; ten minutes for 512 x 512",
         {256},
         10,
         bench::restMoving},
        {"force-rate", "error and time of the force, by the rate of surfaces", {256}, 10, bench::forceRate},
        {"force-work", "work of the force along closed paths on slopes", {256}, 1, bench::forceWork},
        {"hashes", "state hash by code path, number of threads and size of blocks", {128}, 1, bench::hashes},
        {"parts",
         "time of a step: with bedrock, with an edit, with moving sand, with settled sand",
         {512, 1024, 2048},
         10,
         bench::parts},
        {"stability",
         "stiffest springs on which arms come to rest, literal and guarded; --runs 1: two dampings",
         {0},
         10,
         bench::stability},
        {"guarded-sweep",
         "the constants of Dorjgotov et al. 2007 on every arm, guarded and literal; one run: a corner of it",
         {0},
         10,
         bench::guardedSweep},
        {"between-stability",
         "whether an arm comes to rest in moving sand, by `between` and by the hand's grip",
         {0},
         1,
         bench::betweenStability},
        {"tap", "force and work of a tap of 0.1 s, by `between`", {0}, 1, bench::tap},
        {"force-loop",
         "force of 50 runs with edits, lost readings and slow sweeps, and whether it keeps its bars; --runs 2: the "
         "first two",
         {0},
         50,
         bench::forceLoop},
        {"extremes", "sand at the ends of its ranges: sweeps, volume and excess at rest", {0}, 1, bench::extremes},
        {"explain", "parts that a scene loads, runs and leaves out, with the cost of each", {}, 100, bench::explain},
        {"certificate",
         "proved bound and true value of the distance from the right pile",
         {32, 64, 128},
         1,
         bench::certificate},
        {"mass-drift", "sand that floats lose or invent, beside integers", {128}, 1, bench::massDrift},
        {"tin-piles",
         "error of piles on a TIN by vertices and run time, for meshes of every kind and turned",
         {32, 64, 128},
         10,
         bench::tinPiles},
        {"tin-active", "time of 100 sweeps over 1000 vertices of a TIN", {500}, 10, bench::tinActive},
        {"tin-step", "time of a step on a TIN with 64 sweeps, part by part", {500}, 10, bench::tinStep},
        {"budget", "sources of one pile's error", {128}, 1, bench::budget},
        {"tin-imprint", "time of a tool in a TIN, without sweeps", {512}, 10, bench::imprint},
        {"tin-simplify",
         "error of a TIN of dunes, or of a raster, by its vertices and its run time",
         {256, 1024},
         10,
         bench::simplify},
    };
}

constexpr int kLargestSide = 4096;  // [cell]; the sweeps of a larger pile take hours

void addOptions(host::CommandLine& command, const Curve& curve, bench::Settings& settings) {
    settings.sizes = curve.sizes;
    settings.runs = curve.runs;
    command.option("--out", settings.out, "CSV file to write (default: standard output)");
    command.option("--runs", settings.runs, "number of runs of each timed measurement").range(1, 1000).showDefault();
    command.option("--seed", settings.seed, "seed of all random numbers").showDefault();
    if (curve.measure == bench::guardedSweep) {
        command.option("--rows", settings.rows, "only these rows, ARM/DELAY/DAMPING, separated by commas")
            .commaSeparated();
    }
    if (curve.sizes == std::vector<int>{0}) {
        return;
    }
    if (curve.sizes.empty()) {
        command.option("SCENE", settings.scene, "scene file").required();
        return;
    }
    if (curve.measure == bench::simplify) {
        command.option("--raster", settings.raster, "ESRI ASCII grid, in place of dunes");
    }
    if (curve.measure == bench::throughput) {
        command.choice("--path", settings.path, "code path of the sweeps (default: the fastest of this processor)");
        command.option("--rows", settings.rows, "only these rows, separated by commas").commaSeparated();
    }
    command.option("--sizes", settings.sizes, "sides of the square fields [cell], separated by commas")
        .commaSeparated()
        .range(8, kLargestSide)
        .showDefault();
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-bench", {{"algorithm", sand::kAlgorithmVersion}})) {
        return 0;
    }
    host::CommandLine line("Measures the sand: errors, sweeps and times, as CSV.", "sandwall-bench");
    if (argc > 1 && std::string_view(argv[1]) == "latency") {  // scripts/figures/sessions/latency.py reads the options
        return host::runMain(line, 1, argv, [&]() -> int { bench::becomeLatency({argv + 2, argv + argc}); });
    }
    const std::vector<Curve> curves = allCurves();
    std::vector<bench::Settings> settings(curves.size());
    std::vector<host::CommandLine> commands;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        commands.push_back(line.command(curves[i].name, curves[i].what));
        addOptions(commands.back(), curves[i], settings[i]);
    }
    (void)line.command("latency",
                       "half round trip from the hand to whole walls, beside the floor");  // for --help
    return host::runMain(line, argc, argv, [&] {
        for (std::size_t i = 0; i < curves.size(); ++i) {
            if (commands[i].given()) {
                settings[i].commandLine = "sandwall-bench";
                for (int word = 1; word < argc; ++word) {
                    settings[i].commandLine += std::string(" ") + argv[word];
                }
                bench::Csv csv(settings[i]);
                curves[i].measure(settings[i], csv);
                csv.finish();
            }
        }
        return 0;
    });
}
