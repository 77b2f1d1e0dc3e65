// SPDX-License-Identifier: Apache-2.0
// The curves of docs/report, one subcommand each: scripts/report.sh runs and draws them all.
#include <array>

#include "bench/curves.hpp"
#include "files/command_line.hpp"

namespace {

struct Curve {
    const char* name;
    const char* what;
    std::vector<int> sizes;
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
    };
}

constexpr int kLargestSide = 4096;  // [cell]: beyond, a pile's sweeps to rest take hours

void addOptions(CLI::App& command, const Curve& curve, bench::Settings& settings) {
    settings.sizes = curve.sizes;
    settings.runs = curve.runs;
    command.add_option("--out", settings.out, "the CSV file; standard output without");
    command.add_option("--sizes", settings.sizes, "sides of the square fields [cell], separated by commas")
        ->delimiter(',')
        ->check(CLI::Range(8, kLargestSide))
        ->capture_default_str();
    command.add_option("--runs", settings.runs, "runs of everything that is timed")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command.add_option("--seed", settings.seed, "of everything that is random")->capture_default_str();
    if (std::string(curve.name) == "explain") {
        command.add_option("SCENE", settings.scene, "a scene file")->required();
    }
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures the sand: errors, sweeps and seconds, as CSV.", "sandwall-bench");
    app.require_subcommand(1);
    const std::vector<Curve> curves = allCurves();
    std::vector<bench::Settings> settings(curves.size());
    for (std::size_t i = 0; i < curves.size(); ++i) {
        addOptions(*app.add_subcommand(curves[i].name, curves[i].what), curves[i], settings[i]);
    }
    return files::runMain(app, argc, argv, [&] {
        for (std::size_t i = 0; i < curves.size(); ++i) {
            if (app.got_subcommand(curves[i].name)) {
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
