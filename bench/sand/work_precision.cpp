// SPDX-License-Identifier: Apache-2.0
// Measures the error of each method by its run time.
#include <cmath>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"

namespace bench {
namespace {

// "G plain full sweeps" is left out: while the whole pile moves it takes as long as "G plain". `rest` compares the two.
const std::vector<std::string> kRaced{"G",
                                      "G plain",
                                      "N4",
                                      "settle",
                                      "float32 N4 in place",
                                      "float32 N4 Jacobi",
                                      "float32 N8 Jacobi",
                                      "float32 N8 sqrt2 Jacobi"};

/// One point on a method's curve.
struct Sample {
    int sweeps = 0;
    oracles::Distance error;
    bool atRest = false;
    std::vector<double> seconds;  // time since the start of each run
};

/// Returns the next number of sweeps in the series 1, 2, 3, 4, 6, 8, 12, 16, 24 …
int next(int sweeps) {
    if (sweeps < 4) {
        return sweeps + 1;
    }
    const bool powerOfTwo = (sweeps & (sweeps - 1)) == 0;
    return powerOfTwo ? sweeps / 2 * 3 : sweeps / 3 * 4;
}

// G gets the number of sweeps of a run, as in every step of a scene. If there are few, it begins with more inertia.
// From kAtOnce sweeps on there is no difference, so the rest of a run is measured in parts.
constexpr int kAtOnce = 96;  // [sweep]
// Reading the clock takes time too. A run shorter than kShort is repeated between two readings.
constexpr double kShort = 50e-6;  // [s]
constexpr int kRepeats = 32;      // number of repeats

/// Returns whether the error has changed by less than a hundredth since half of the sweeps, and since the sample
/// between.
///
/// Some piles of floats never rest. Others pass by the right pile, and their error is level for a moment there.
bool onPlateau(const std::vector<Sample>& samples) {
    const std::size_t count = samples.size();
    if (count < 3 || samples[count - 3].sweeps < 256) {
        return false;
    }
    const double last = samples[count - 1].error.misplaced;
    const auto near = [&](const Sample& sample) { return std::abs(sample.error.misplaced - last) < 0.01 * last; };
    return near(samples[count - 2]) && near(samples[count - 3]);
}

oracles::Distance errorOf(const Pile& pile, const Relaxation& relaxation) {
    const std::vector<double> heights = relaxation.heights();
    return oracles::distance(
        pile.side(), pile.rest, [&](std::size_t i) { return heights[i]; }, [](int, int) { return true; });
}

/// Runs one method several times. first() runs to rest or to a plateau; again() repeats the samples of the first run.
class Runner {
public:
    Runner(const Method& method, const Pile& pile) : method_(method), pile_(pile), rules_(rulesFor(pile.start)) {}

    std::vector<Sample> first() {
        std::vector<Sample> samples;
        start();
        for (int sweeps = 1; samples.empty() || !samples.back().atRest; sweeps = next(sweeps)) {
            Sample sample;
            sample.sweeps = sweeps;
            sample.seconds.push_back(advanceTo(sweeps));
            sample.error = errorOf(pile_, *relaxation_);
            sample.atRest = relaxation_->atRest();
            samples.push_back(sample);
            if (sweeps >= kMostSweeps || (!method_.integers && onPlateau(samples))) {
                break;
            }
        }
        return samples;
    }

    [[nodiscard]] double total() const { return total_; }  // total time of all runs [s]

    void again(std::vector<Sample>& samples) {
        start();
        for (Sample& sample : samples) {
            sample.seconds.push_back(advanceTo(sample.sweeps));
        }
    }

private:
    void start() {
        relaxation_ = method_.start(pile_.start, rules_);
        done_ = 0;
        seconds_ = 0;
    }
    /// Advances to `sweeps` sweeps. Returns the time since the start, with the setup [s].
    double advanceTo(int sweeps) {
        if (sweeps <= kAtOnce) {
            seconds_ = secondsAtOnce(sweeps);
        } else {
            const double more = secondsOf([&] { relaxation_->sweep(sweeps - done_); });
            total_ += more;
            seconds_ += more;
        }
        done_ = sweeps;
        return seconds_;
    }
    double secondsAtOnce(int sweeps) {
        const auto run = [&] {
            relaxation_ = method_.start(pile_.start, rules_);
            relaxation_->sweep(sweeps);
        };
        double seconds = secondsOf(run);
        total_ += seconds;
        if (seconds < kShort) {
            const double all = secondsOf([&] {
                for (int i = 0; i < kRepeats; ++i) {
                    run();
                }
            });
            total_ += all;
            seconds = all / kRepeats;
        }
        return seconds;
    }

    const Method& method_;
    const Pile& pile_;
    const sand::Rules rules_;
    std::unique_ptr<Relaxation> relaxation_;
    int done_ = 0;
    double seconds_ = 0;
    double total_ = 0;
};

}  // namespace

void workPrecision(const Settings& settings, Csv& csv) {
    csv.note("misplaced: sum of |height - analytic mean over the cell| over the sum of the analytic means");
    csv.note("largest, apex: L-infinity error and error of the highest point [cell of this N]");
    csv.note("seconds: CPU time of one thread from the start field, with the setup");
    csv.note(
        fmt::format("a float baseline ends when no sweep moves {} cells, or twice the sweeps change the error by < 1 %",
                    kFloatTolerance));
    csv.note(fmt::format("runs of a method: {}; no tall pile beyond N = {}", runsRule(settings.runs), kLargestTall));
    csv.columns(
        "pile,method,integers,N,runs,sweeps,seconds_median,seconds_min,seconds_max,misplaced,largest,apex,at_rest");
    for (const int side : settings.sizes) {
        for (const Pile& pile : pilesOf(side)) {
            for (const Method& method : methods(kRaced)) {
                progress("{} pile, N = {}, {}", pile.name, side, method.name);
                Runner runner(method, pile);
                std::vector<Sample> samples = runner.first();
                const int runs = runsFor(runner.total(), settings.runs);
                for (int run = 1; run < runs; ++run) {
                    runner.again(samples);
                }
                for (const Sample& sample : samples) {
                    const Spread seconds = spreadOf(sample.seconds);
                    csv.row(pile.name, method.name, method.integers ? 1 : 0, side, sample.seconds.size(), sample.sweeps,
                            seconds.median, seconds.lowest, seconds.highest, sample.error.misplaced,
                            sample.error.largest, sample.error.apex, sample.atRest ? 1 : 0);
                }
            }
        }
    }
}

}  // namespace bench
