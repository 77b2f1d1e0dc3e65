// SPDX-License-Identifier: Apache-2.0
// Measures picture error and draw time for each bound of the level of detail, on a large field under a moving head.
#include <cstdlib>

#include "bench/report/csv.hpp"
#include "bench/report/timing.hpp"
#include "host/command_line.hpp"
#include "render_node/gl/gl_context.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/pictures/sample_scene.hpp"

namespace {

constexpr int kBadLevel = 8;  // [of 255]
constexpr int kWidth = 1024, kHeight = 768;

/// The results of one bound over all frames.
struct Sums {
    std::vector<double> seconds;
    double bad = 0, difference = 0;  // sums [pixel], [level]
    double triangles = 0, coarse = 0, chunks = 0;
};

/// Returns a scene of dunes with a furrow, into which sand has slid.
scene::Scene dunesOf(int side, std::uint32_t seed) {
    scene::Scene scene = sample::flatScene(side, side, 0.01);
    sand::grid::makeDunes({.height = 0.012, .length = 0.08, .seed = seed}, scene.terrain);  // crests in every chunk
    sand::Replica replica(scene);
    sample::drag(replica, scene, {0.6, 0.7, 0.0}, {1.1, 1.0, 0.0});
    scene.terrain = std::get<sand::GridData>(replica.surface().data()).field;
    return scene;
}

void addDifference(const sample::Pixels& exact, const sample::Pixels& picture, Sums& sums) {
    for (std::size_t i = 0; i < exact.size(); i += 3) {
        int worst = 0;
        for (std::size_t channel = i; channel < i + 3; ++channel) {
            const int gap = std::abs(int{exact[channel]} - int{picture[channel]});
            worst = std::max(worst, gap);
            sums.difference += gap;
        }
        sums.bad += worst > kBadLevel ? 1 : 0;
    }
}

/// Draws one frame `runs` times at one bound and adds the times to `sums`. Draws once before, so that all chunks exist.
sample::Pixels drawFrame(render_node::ScenePainter& view, const render_node::Camera& camera,
                         const render_node::EyeTarget& target, int runs, Sums& sums) {
    view.draw(camera, target);
    target.finish();
    for (int run = 0; run < runs; ++run) {
        sums.seconds.push_back(bench::secondsOf([&] {
            view.draw(camera, target);
            target.finish();
        }));
    }
    sums.triangles += view.counts().triangles;
    sums.coarse += view.counts().coarseChunks;
    sums.chunks += view.counts().chunks;
    return target.read();
}

void measure(int side, int frames, const bench::Settings& settings, bench::Csv& csv) {
    const std::vector<double> bounds{0, 0.25, 0.5, 1, 2, 4};
    std::vector<Sums> sums(bounds.size());
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    render_node::ScenePainter view(dunesOf(side, settings.seed), glm::dmat4(1));
    const render_node::EyeTarget target(kWidth, kHeight);
    for (int frame = 0; frame < frames; ++frame) {
        bench::progress("N = {}, frame {} of {}", side, frame + 1, frames);
        const double along = 0.05 * frame / frames;
        const render_node::Camera camera =
            sample::camera({1 + along, 0.2, 0.9 - along}, {1, 1, 0}, {0.25, 0.33333333333, 0.5, 0.66666666667});
        sample::Pixels exact;
        for (std::size_t i = 0; i < bounds.size(); ++i) {
            view.setDetail(bounds[i]);
            const sample::Pixels picture = drawFrame(view, camera, target, settings.runs, sums[i]);
            exact = i == 0 ? picture : exact;
            addDifference(exact, picture, sums[i]);
        }
    }
    const double whole = bench::spreadOf(sums[0].seconds).median;
    const double pixels = double{kWidth} * kHeight * frames;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const bench::Spread seconds = bench::spreadOf(sums[i].seconds);
        csv.row(side, bounds[i], 1e3 * seconds.median, 1e3 * seconds.lowest, 1e3 * seconds.highest,
                seconds.median / whole, sums[i].bad / pixels, sums[i].difference / (3 * pixels),
                sums[i].triangles / frames, sums[i].coarse / sums[i].chunks);
    }
}

}  // namespace

int main(int argc, char** argv) {
    // llvmpipe then does all its work in the measured thread. It reads the variable once.
    setenv("LP_NUM_THREADS", "0", 1);
    bench::Settings settings;
    settings.sizes = {512, 2048};
    settings.runs = 3;
    int frames = 6;
    host::CommandLine line("Measures pictures at each level of detail: errors and times, as CSV.", "detail_bench");
    line.option("--out", settings.out, "CSV file to write (default: standard output)");
    line.option("--runs", settings.runs, "number of drawings of every picture").range(1, 1000);
    line.option("--frames", frames, "number of frames of the moving head").range(1, 1000);
    line.option("--seed", settings.seed, "seed of the dunes");
    line.option("--sizes", settings.sizes, "sides of the square fields [cell], separated by commas")
        .commaSeparated()
        .range(64, 4096);
    return host::runMain(line, argc, argv, [&] {
        settings.commandLine = "detail_bench";
        for (int word = 1; word < argc; ++word) {
            settings.commandLine += std::string(" ") + argv[word];
        }
        bench::Csv csv(settings);
        csv.note(
            "one eye of a middle tile of 3 x 4, 1024 x 768 pixels, drawn whole; dunes with a furrow, the head moves");
        csv.note("bound: largest shift of any sand in the picture by the level of detail [pixel]; 0 draws every cell");
        csv.note("ms: CPU time of one thread with llvmpipe's work; ratio: over the time of bound 0 in the same frames");
        csv.note(
            "bad: share of pixels that differ from bound 0 by more than 8 of 255 levels; mean: mean of all differences "
            "[level]; coarse: share of the drawn chunks above level 0");
        csv.columns("N,bound,ms_median,ms_min,ms_max,ratio,bad,mean,triangles,coarse");
        for (const int side : settings.sizes) {
            measure(side, frames, settings, csv);
        }
        csv.finish();
        return 0;
    });
}
