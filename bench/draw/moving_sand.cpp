// SPDX-License-Identifier: Apache-2.0
#include "bench/draw/moving_sand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>

#include "bench/report/timing.hpp"
#include "pictures/compare.hpp"
#include "pictures/png_file.hpp"
#include "render_node/gl/gl_context.hpp"
#include "render_node/scene_painter.hpp"
#include "sand/grid/dunes.hpp"
#include "sand/replica.hpp"
#include "tests/support/pictures/sample_scene.hpp"
#include "walls/projection.hpp"
#include "walls/wall.hpp"
#include "walls/wall_file.hpp"

namespace bench {
namespace {

constexpr int kBadLevel = 8;  // [of 255]
constexpr int kWarmUp = 3;    // [frame]
constexpr int kStops = 13;    // [frame], in which all sand of some rows stops

std::int32_t thresholdOf(double talusDegrees) {
    return static_cast<std::int32_t>(std::tan(talusDegrees * std::numbers::pi / 180) * sand::kUnitsPerCell);
}

scene::Scene fieldOf(int side, double talusDegrees, int sweeps) {
    scene::Scene scene = sample::flatScene(side, side);
    scene.rules.tuning.threshold = scene.rules.tuning.startThreshold = thresholdOf(talusDegrees);
    scene.rules.tuning.sweepsPerStep = sweeps;
    return scene;
}

scene::Scene dunesOf(int side, double talusDegrees) {
    scene::Scene scene = fieldOf(side, talusDegrees, 1);
    sand::grid::makeDunes({}, scene.terrain);
    return scene;
}

scene::Scene furrowOf(int side) {
    constexpr int kRadius = 61;  // [cell]
    scene::Scene scene = fieldOf(side, 34, (kRadius * kRadius + 5) / 6);
    scene.rules.tuning.tool.radius = kRadius * sand::kProbePerCell;
    return scene;
}

/// Returns a level field with a plateau of the greatest height from one column to another.
scene::Scene plateauOf(int side, int from, int end, int rows) {
    scene::Scene scene = fieldOf(side, 34, 1);
    for (int y = (side - rows) / 2; y < (side + rows) / 2; ++y) {
        for (int x = from; x < end; ++x) {
            scene.terrain.setHeight(x, y, sand::kMaxHeight);
        }
    }
    return scene;
}

sand::Step stepAfter(const sand::Replica& replica) {
    return {.epoch = 1, .number = replica.stepNumber() + 1, .engaged = false, .path = {}};
}

/// Returns a step that digs across the middle of the field, as far as the hand of script:gis moves in a step.
sand::Step digging(const sand::Replica& replica) {
    sand::Step step = stepAfter(replica);
    const sand::Rules& rules = replica.rules();
    const double along = 0.3 + 0.4 * std::fmod(0.018 * static_cast<double>(step.number), 1);
    step.engaged = true;
    step.path = {{static_cast<std::int32_t>(along * rules.columns * sand::kProbePerCell),
                  rules.rows / 2 * sand::kProbePerCell, rules.tuning.tool.radius / 5}};
    return step;
}

/// Returns a step. That of frame kStops makes all sand rest.
sand::Step stopping(const sand::Replica& replica, int frame) {
    sand::Step step = stepAfter(replica);
    if (frame == kStops) {
        sand::Tuning tuning = replica.rules().tuning;
        tuning.threshold = tuning.startThreshold = thresholdOf(80);
        step.edit = sand::Edit::tuned(tuning);
    }
    return step;
}

struct Row {
    const char* name;
    std::function<scene::Scene()> scene;
    std::function<sand::Step(const sand::Replica&, int frame)> step;
    bool headMoves = false;
    bool stops = false;
};

std::vector<Row> rows() {
    const auto slide = [](const sand::Replica& replica, int) { return stepAfter(replica); };
    const auto dig = [](const sand::Replica& replica, int) { return digging(replica); };
    return {{"dunes-4096", [] { return dunesOf(4096, 12); }, slide},
            {"dunes-2048", [] { return dunesOf(2048, 12); }, slide},
            {"furrow-4096", [] { return furrowOf(4096); }, dig},
            {"rest-4096", [] { return dunesOf(4096, 12); }, stopping, false, true},
            {"rest-2048", [] { return dunesOf(2048, 12); }, stopping, false, true},
            {"head-2048", [] { return dunesOf(2048, 80); }, slide, true},
            {"cliff-1024", [] { return plateauOf(1024, 0, 512, 1024); }, slide},
            {"needle-1024", [] { return plateauOf(1024, 511, 512, 1); }, slide}};
}

/// A rule, with a view that draws by it.
struct Ruled {
    std::string name;
    render_node::ScenePainter view;
    render_node::EyeTarget target;
    render_node::EyeMemory memory{};
    std::vector<double> ms{}, triangles{}, vertices{}, measured{}, percent{};  // per frame
    double bad = 0, compared = 0;                                              // [pixel]

    Ruled(std::string rule, const scene::Scene& scene, const glm::dmat4& sceneToRoom, glm::ivec2 size)
        : name(std::move(rule)), view(scene, sceneToRoom), target(size.x, size.y) {}
};

/// Takes over the change and draws the frame. Adds time and work to the lists of the rule.
void drawFrame(Ruled& rule, const sand::Replica& replica, const sand::SurfaceChange& change,
               const render_node::Camera& camera) {
    const render_node::DrawnSurface::Work before = rule.view.work();
    rule.ms.push_back(1e3 * secondsOf([&] {
                          rule.view.update(replica.surface().data(), change, std::span(&camera, 1));
                          (void)rule.view.drawIfChanged(camera, rule.target, rule.memory);
                          rule.target.finish();
                      }));
    const render_node::DrawnSurface::Work after = rule.view.work();
    rule.triangles.push_back(rule.view.counts().triangles);
    rule.vertices.push_back(static_cast<double>(after.vertices - before.vertices));
    rule.measured.push_back(static_cast<double>(after.measuredChunks - before.measuredChunks));
    rule.percent.push_back(100.0 * static_cast<double>(rule.view.counts().pixels) /
                           (double(rule.target.width()) * rule.target.height()));
}

pictures::Image imageOf(const render_node::EyeTarget& target) {
    pictures::Image image(target.width(), target.height());
    image.rgb = target.read();
    return image;
}

class MovingSand {
public:
    MovingSand(const Row& row, const MovingSandOptions& options)
        : row_(row), options_(options), scene_(row.scene()), replica_(scene_), wall_(walls::loadWall(options.wall)) {
        const double side = scene_.rules.columns * scene_.terrain.cellSize();
        sceneToRoom_ = walls::stageToRoom(wall_.stage, side, side,
                                          static_cast<double>(scene_.referenceHeight()) * scene_.terrain.unit());
        const glm::ivec2 size = wall_.tiles.front().pixels;
        const auto add = [&](const std::string& name) -> render_node::ScenePainter& {
            rules_.push_back(std::make_unique<Ruled>(name, scene_, sceneToRoom_, size));
            return rules_.back()->view;
        };
        for (const int pixels : options.pixelsPerQuad) {
            add(fmt::format("{} pixels a quad", pixels)).setPixelsPerQuad(pixels);
        }
        add("as at rest").setSharp(true);
        if (options.errors) {
            exact_.emplace("every cell", scene_, sceneToRoom_, size);
            exact_->view.setDetail(0);
        }
    }

    void run() {
        for (int frame = 0; frame < kWarmUp + options_.frames; ++frame) {
            replica_.apply(row_.step(replica_, frame));
            if (frame == kWarmUp) {
                forgetWarmUp();
            }
            show(frame);
        }
        report();
    }

private:
    [[nodiscard]] render_node::Camera cameraAt(int frame) const {
        walls::Wall wall = wall_;
        wall.viewer.eye += row_.headMoves ? glm::dvec3(0.001 * frame, 0, 0.0005 * frame) : glm::dvec3(0);
        const walls::View seen = walls::viewOf(wall, wall.tiles.front(), walls::eyesOf(wall.stereo).front());
        return {seen.viewProjection, seen.eye};
    }

    void show(int frame) {
        const sand::SurfaceChange change = replica_.takeChange();
        const render_node::Camera camera = cameraAt(frame);
        for (std::size_t i = 0; i < rules_.size(); ++i) {
            drawFrame(*rules_[(i + static_cast<std::size_t>(frame)) % rules_.size()], replica_, change, camera);
        }
        drawWholeAtRest(camera);
        if (exact_) {
            drawFrame(*exact_, replica_, change, camera);
            const pictures::Image exact = imageOf(exact_->target);
            for (const auto& rule : rules_) {
                rule->bad += static_cast<double>(pictures::compare(exact, imageOf(rule->target), kBadLevel).badPixels);
                rule->compared += static_cast<double>(exact.pixels());
            }
        }
        if (!options_.folder.empty()) {
            std::filesystem::create_directories(options_.folder);
            pictures::writePng(std::filesystem::path(options_.folder) / fmt::format("frame_{:04}.png", frame),
                               imageOf(rules_.front()->target));
        }
    }

    void forgetWarmUp() {
        for (const auto& rule : rules_) {
            for (std::vector<double>* list :
                 {&rule->ms, &rule->triangles, &rule->vertices, &rule->measured, &rule->percent}) {
                list->clear();
            }
            rule->bad = rule->compared = 0;
        }
        wholeMs_.clear();
    }

    void report() {
        const Ruled& atRest = *rules_.back();
        fmt::print("{}: {} frames on {}\n", row_.name, options_.frames, wall_.name);
        fmt::print("{:18} {:>9} {:>9} {:>6} {:>10} {:>10} {:>9} {:>8} {:>7}\n", "rule", "p50 [ms]", "max [ms]", "ratio",
                   "triangles", "vertices", "measured", "pixels %", "bad %");
        const auto print = [&](const Ruled& rule) {
            const auto median = [](const std::vector<double>& values) { return quantile(values, 0.5); };
            fmt::print("{:18} {:9.2f} {:9.2f} {:6.3f} {:10.0f} {:10.0f} {:9.0f} {:8.2f} {:>7}\n", rule.name,
                       median(rule.ms), quantile(rule.ms, 1), median(rule.ms) / median(atRest.ms),
                       median(rule.triangles), median(rule.vertices), median(rule.measured), median(rule.percent),
                       rule.compared > 0 ? fmt::format("{:.2f}", 100 * rule.bad / rule.compared) : "");
        };
        std::ranges::for_each(rules_, [&](const auto& rule) { print(*rule); });
        const double whole = quantile(wholeMs_, 0.5);
        fmt::print("whole picture of this sand at rest: {:.2f} ms; {}: {:.2f} times that\n", whole,
                   rules_.front()->name, quantile(rules_.front()->ms, 0.5) / whole);
        if (row_.stops) {
            constexpr std::ptrdiff_t kMoving = kStops - kWarmUp;
            const std::vector<double>& ms = rules_.front()->ms;
            const std::vector<double> moving(ms.begin(), ms.begin() + kMoving), resting(ms.begin() + kMoving, ms.end());
            fmt::print("frames while sand moves: median {:.2f} ms; longest frame after that: {:.2f} ms, ratio {:.2f}\n",
                       quantile(moving, 0.5), quantile(resting, 1), quantile(resting, 1) / quantile(moving, 0.5));
        }
    }

    /// Draws the whole picture of this sand as at rest, from vertices that GL has. In each frame, so that its time can
    /// be compared on a machine whose speed changes.
    void drawWholeAtRest(const render_node::Camera& camera) {
        Ruled& rule = *rules_.back();
        wholeMs_.push_back(1e3 * secondsOf([&] {
                               rule.view.draw(camera, rule.target);
                               rule.target.finish();
                           }));
    }

    const Row& row_;
    const MovingSandOptions& options_;
    scene::Scene scene_;
    sand::Replica replica_;
    walls::Wall wall_;
    glm::dmat4 sceneToRoom_{1};
    std::vector<std::unique_ptr<Ruled>> rules_;  // the last one is that of sand at rest
    std::vector<double> wholeMs_;                // of the whole picture at rest, per frame
    std::optional<Ruled> exact_;
};

}  // namespace

std::vector<std::string> movingSandRows() {
    std::vector<std::string> names;
    for (const Row& row : rows()) {
        names.emplace_back(row.name);
    }
    return names;
}

void measureMovingSand(const MovingSandOptions& options) {
    const auto context = render_node::makeOffscreenContext(render_node::Backend::automatic);
    for (const Row& row : rows()) {
        if (row.name == options.row) {
            MovingSand(row, options).run();
        }
    }
}

}  // namespace bench
