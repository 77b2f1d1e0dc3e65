// SPDX-License-Identifier: Apache-2.0
// What a whole step of a TIN costs, part by part: a tool put somewhere or dragged on, and the sweeps that follow.
#include <array>
#include <cmath>
#include <random>

#include "bench/curves.hpp"
#include "bench/timing.hpp"
#include "sand/tin/erosion.hpp"
#include "sand/tin/tool.hpp"
#include "tests/support/tin_piles.hpp"

namespace bench {
namespace {

using sand::tin::Layer;
using sand::tin::Vertex;

constexpr double kRadius = 13;      // [cell]: about 1000 vertices below the tool and in the ring beside it
constexpr double kDepth = 2;        // [cell]
constexpr int kSamplesOfHand = 16;  // in one step
constexpr double kPerStep = 1.5;    // [cell]
constexpr int kSteps = 30;          // a run, of either kind
constexpr int kSweepsPerStep = 64;
constexpr std::int32_t kSlope = 65536;  // [unit per cell], 45 degrees
constexpr int kEnough = 100'000;        // sweeps to rest
constexpr std::array kParts{"mesh", "remap", "tool", "active", "sweeps", "step"};

/// Seconds of each part, step by step.
using Parts = std::array<std::vector<double>, kParts.size()>;

class Work {
public:
    Work(int side, bool refines, std::uint32_t seed)
        : layer_(tin_piles::layerOf(tin_piles::Kind::jittered, side, 0, seed)), erosion_(layer_, kSlope, kSlope) {
        rules_.spacing = refines ? sand::kProbePerCell : 0;
        static_cast<void>(layer_.takeChange());
        rest();
    }

    /// What of an imprint far from others is the mesh's change, and what the remap; taken back again.
    void tryImprint(const sand::ProbePoint& at, Parts& parts) {
        sand::tin::Imprint there;
        double mesh = 0;
        const double change = secondsOf([&] {
            layer_.edit([&](sand::tin::Mesh& edited) {
                mesh = secondsOf([&] {
                    there.putInto(edited, placed(outline_, at.x, at.y, edited.triangles()), rules_.maxVertices);
                });
            });
        });
        parts[0].push_back(mesh);
        parts[1].push_back(change - mesh);
        layer_.edit([&](sand::tin::Mesh& edited) { there.takeOutOf(edited); });
        erosion_.changed(layer_, layer_.takeChange());
    }

    /// One step: the tool's work, the news of it, and the sweeps.
    void step(std::span<const sand::ProbePoint> path, Parts* parts) {
        sand::tin::Tool::Work done;
        const double tool = secondsOf(
            [&] { done = sand::tin::Tool(shape_, {}, rules_).drag(layer_, imprint_, sand::Rim::closed, path); });
        const double active = secondsOf([&] {
            erosion_.changed(layer_, layer_.takeChange());
            erosion_.wake(done.touched);
        });
        moved_.clear();
        const double sweeps = secondsOf([&] {
            const sand::tin::Underside under = sand::tin::Tool(shape_, {}, rules_).underside(path.back());
            erosion_.sweep(layer_, kSweepsPerStep, &under, moved_);
        });
        if (parts != nullptr) {
            const std::array seconds{tool, active, sweeps, tool + active + sweeps};
            for (std::size_t i = 0; i < seconds.size(); ++i) {
                (*parts)[i + 2].push_back(seconds[i]);
            }
        }
    }

    void leave() {
        sand::tin::Tool(shape_, {}, rules_).leave(layer_, imprint_);
        erosion_.changed(layer_, layer_.takeChange());
        rest();
    }

    [[nodiscard]] int near(const sand::ProbePoint& at) const {
        const sand::TurnedShape tool(shape_, {});
        const auto& places = layer_.triangles().places;
        return static_cast<int>(std::count_if(places.begin(), places.end(), [&](const sand::tin::Place& place) {
            const sand::Offset offset{std::int64_t{place.x} - at.x, std::int64_t{place.y} - at.y};
            return tool.covers(offset) || tool.takes(offset);
        }));
    }
    [[nodiscard]] int vertices() const { return layer_.mesh().vertexCount(); }

private:
    void rest() {
        moved_.clear();
        erosion_.sweep(layer_, kEnough, nullptr, moved_);
    }

    sand::ToolShape shape_{sand::ToolKind::circle, static_cast<std::int32_t>(kRadius* sand::kProbePerCell), 0};
    sand::tin::Outline outline_ = sand::tin::Outline::of(shape_, {});
    sand::tin::DetailRules rules_;
    Layer layer_;
    sand::tin::Erosion erosion_;
    sand::tin::Imprint imprint_;
    std::vector<Vertex> moved_;
};

sand::ProbePoint handOver(double x, double y /* [cell] */) {
    const auto probe = [](double cells) { return static_cast<std::int32_t>(std::floor(cells * sand::kProbePerCell)); };
    return {probe(x), probe(y), probe(kRadius - kDepth)};
}

}  // namespace

void tinStep(const Settings& settings, Csv& csv) {
    csv.note(
        fmt::format("a round tool of 32 points and radius {} cells, {} cells deep, in level sand; {} sweeps; ms of",
                    kRadius, kDepth, kSweepsPerStep));
    csv.note("CPU time. imprint: put somewhere new; drag: moved on by 1.5 cells. mesh, remap: within tool, tried");
    csv.note("before; active: news of the mesh for the sweeps; sweeps: with what they find out about the mesh");
    csv.columns("what,refined,N,vertices,near,part,steps,ms_median,ms_p99,ms_max");
    for (const int side : settings.sizes) {
        for (const bool refines : {false, true}) {
            Parts imprints, drags;
            int vertices = 0, near = 0;
            for (int run = 0; run < settings.runs; ++run) {
                progress("N = {}, run {}", side, run);
                Work work(side, refines, settings.seed + static_cast<std::uint32_t>(run));
                std::mt19937 random(settings.seed + static_cast<std::uint32_t>(run));
                const auto somewhere = [&] { return 2 * kRadius + tin_piles::chance(random) * (side - 4 * kRadius); };
                vertices = work.vertices();
                for (int i = 0; i < kSteps; ++i) {
                    const double x = somewhere();
                    const sand::ProbePoint at = handOver(x, somewhere());
                    near = work.near(at);
                    work.tryImprint(at, imprints);
                    work.step(std::array{at}, &imprints);
                    work.leave();
                }
                double x = 2 * kRadius;
                for (int i = 0; i < kSteps; ++i, x += kPerStep) {
                    std::vector<sand::ProbePoint> path;
                    for (int sample = 0; sample <= kSamplesOfHand; ++sample) {
                        path.push_back(handOver(x + kPerStep * sample / kSamplesOfHand, side / 2.0));
                    }
                    work.step(path, i == 0 ? nullptr : &drags);
                }
            }
            for (const auto& [what, parts] : {std::pair{"imprint", &imprints}, {"drag", &drags}}) {
                for (std::size_t i = 0; i < kParts.size(); ++i) {
                    const auto& seconds = (*parts)[i];
                    if (seconds.empty()) {
                        continue;
                    }
                    csv.row(what, refines ? "yes" : "no", side, vertices, near, kParts[i], seconds.size(),
                            1e3 * quantile(seconds, 0.5), 1e3 * quantile(seconds, 0.99), 1e3 * quantile(seconds, 1));
                }
            }
        }
    }
}

}  // namespace bench
