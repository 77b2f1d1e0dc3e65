// SPDX-License-Identifier: Apache-2.0
// The curves of docs/report, one subcommand each: scripts/report.sh runs and draws them all.
#include <string_view>

#include "bench/curves.hpp"
#include "bench/session/latency.hpp"
#include "host/command_line.hpp"
#include "host/version.hpp"
#include "scene/scene.hpp"

namespace {

struct Curve {
    const char* name;
    const char* what;
    std::vector<int> sizes;  // [cell]; a curve without measures a scene, one of size 0 neither
    int runs;
    void (*measure)(const bench::Settings&, bench::Csv&);
};

std::vector<Curve> allCurves() {
    return {
        {"work-precision",
         "error against seconds: our schemes and the rules in common use",
         {16, 32, 64, 128, 256},
         10,
         bench::workPrecision},
        {"error-at-rest", "error of the piles at rest, and its order in N", {32, 64, 128, 256}, 1, bench::errorAtRest},
        {"sweeps", "sweeps until nothing moves, with and without a band", {32, 64, 128, 256}, 1, bench::sweeps},
        {"anisotropy", "radius of the piles by direction", {64, 128}, 1, bench::anisotropy},
        {"decay", "sand that moves, and sand that still has to, by sweep", {128}, 1, bench::decay},
        {"height-bits", "error by the size of the height unit", {32, 64, 128}, 1, bench::heightBits},
        {"band", "sweeps and error by the width of the hysteresis band", {128}, 1, bench::band},
        {"edit",
         "milliseconds of one edit by the tool's radius, active blocks and all",
         {512, 1024, 2048},
         10,
         bench::edit},
        {"dig", "milliseconds per step of digging, and how far behind the sand is", {512, 2048}, 10, bench::dig},
        {"throughput",
         "nanoseconds per cell of a sweep, beside a copy of the same bytes",
         {64, 128, 256, 512, 1024, 2048, 4096},
         10,
         bench::throughput},
        {"rest", "seconds to rest of a pile", {512}, 10, bench::rest},
        {"rest-moving",
         "seconds to rest of a field in which everything moves; of 512 x 512 ten minutes",
         {256},
         10,
         bench::restMoving},
        {"force-rate",
         "error of the force by how often the sand is seen, and what it costs",
         {256},
         10,
         bench::forceRate},
        {"force-work", "work of the force round closed paths on slopes", {256}, 1, bench::forceWork},
        {"hashes", "one hash by every code path, number of threads and size of blocks", {128}, 1, bench::hashes},
        {"parts",
         "what bedrock, an edit and moving sand cost, and settled sand does not",
         {512, 1024, 2048},
         10,
         bench::parts},
        {"stability",
         "stiffest springs that arms come to rest on, literal and guarded, against the theory; one run: two dampings",
         {0},
         10,
         bench::stability},
        {"guarded-sweep",
         "the constants of Dorjgotov et al. 2007 on every arm, guarded and literal; one run: a corner of it",
         {0},
         10,
         bench::guardedSweep},
        {"explain",
         "what a scene loads and runs, what it leaves out, and what each part costs",
         {},
         100,
         bench::explain},
        {"certificate", "distance from the right pile: proved, and true", {32, 64, 128}, 1, bench::certificate},
        {"mass-drift", "sand that floats lose or invent, and integers do not", {128}, 1, bench::massDrift},
        {"tin-piles",
         "error of piles on a TIN against its vertices and seconds, for meshes of every kind and turned",
         {32, 64, 128},
         1,
         bench::tinPiles},
        {"tin-active", "milliseconds of 100 sweeps over 1000 vertices of a TIN", {500}, 10, bench::tinActive},
        {"tin-step", "milliseconds of a step on a TIN, part by part, with 64 sweeps", {500}, 10, bench::tinStep},
        {"budget", "where one pile's error comes from", {128}, 1, bench::budget},
        {"tin-imprint", "milliseconds of a tool's work in a TIN, without the sweeps", {512}, 10, bench::imprint},
        {"tin-simplify",
         "error of a TIN of dunes, or of a raster, by its vertices and the seconds it takes",
         {256, 1024},
         10,
         bench::simplify},
    };
}

constexpr int kLargestSide = 4096;  // [cell]: beyond, a pile's sweeps to rest take hours

void addOptions(host::CommandLine& command, const Curve& curve, bench::Settings& settings) {
    settings.sizes = curve.sizes;
    settings.runs = curve.runs;
    command.option("--out", settings.out, "the CSV file; standard output without");
    command.option("--runs", settings.runs, "runs of everything that is timed").range(1, 1000).showDefault();
    command.option("--seed", settings.seed, "of everything that is random").showDefault();
    if (curve.sizes == std::vector<int>{0}) {
        return;
    }
    if (curve.sizes.empty()) {
        command.option("SCENE", settings.scene, "a scene file").required();
        return;
    }
    if (curve.measure == bench::simplify) {
        command.option("--raster", settings.raster, "an ESRI ASCII grid, in place of dunes");
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
    host::CommandLine line("Measures the sand: errors, sweeps and seconds, as CSV.", "sandwall-bench");
    if (argc > 1 && std::string_view(argv[1]) == "latency") {  // its options are the script's
        return host::runMain(line, 1, argv, [&]() -> int { bench::becomeLatency({argv + 2, argv + argc}); });
    }
    const std::vector<Curve> curves = allCurves();
    std::vector<bench::Settings> settings(curves.size());
    std::vector<host::CommandLine> commands;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        commands.push_back(line.command(curves[i].name, curves[i].what));
        addOptions(commands.back(), curves[i], settings[i]);
    }
    (void)line.command("latency", "half round trip from the hand to whole walls, beside the floor");  // for --help
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
