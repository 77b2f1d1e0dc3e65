// SPDX-License-Identifier: Apache-2.0
// Measures the time to rest of a pile, and of a field in which all sand moves.
#include <cmath>
#include <functional>
#include <numeric>

#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/piles.hpp"
#include "bench/sand/relaxations.hpp"

namespace bench {
namespace {

struct Contender {
    Method method;
    std::vector<double> seconds;
    std::vector<double> heights;
    std::int64_t sweeps = 0;
};

/// Runs every method in every round, so that the load of other programs affects all methods equally.
std::vector<Contender> race(const std::vector<Method>& all, const sand::HeightField& start, int runs,
                            const std::string& field) {
    std::vector<Contender> contenders;
    contenders.reserve(all.size());
    for (const Method& method : all) {
        contenders.push_back({method, {}, {}, 0});
    }
    for (int run = 0; run < runs; ++run) {
        for (Contender& contender : contenders) {
            if (run > 0 && run >= runsFor(contender.seconds.front(), runs)) {
                continue;
            }
            progress("{}, N = {}, {}: run {}", field, start.columns(), contender.method.name, run + 1);
            std::unique_ptr<Relaxation> relaxation;
            contender.seconds.push_back(secondsOf([&] {
                relaxation = contender.method.start(start, rulesFor(start));
                relaxation->sweep(kMostSweeps);
            }));
            contender.heights = relaxation->heights();
            contender.sweeps = relaxation->sweepsDone();
        }
    }
    return contenders;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
    return std::transform_reduce(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                                 [](double x, double y) { return std::abs(x - y); });
}

double sumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Returns the methods for a field of this side.
std::vector<Method> contendersOn(int side) {
    std::vector<Method> all = methods(kToRest);
    std::erase_if(all, [&](const Method& method) { return side > kLargestSlow && method.name.starts_with("G plain"); });
    return all;
}

/// Writes the rows of one race. The reference is the first contender, if it runs at this side. Errors are divided by
/// `whole`.
void write(Csv& csv, const std::string& field, int side, const std::vector<Contender>& contenders,
           const std::vector<double>& truth, double whole) {
    const double reference = spreadOf(contenders.front().seconds).median;
    const bool compares = contenders.front().method.name == kToRest.front();
    for (const Contender& contender : contenders) {
        const Spread seconds = spreadOf(contender.seconds);
        csv.row(field, contender.method.name, side, contender.seconds.size(), contender.sweeps, seconds.median,
                seconds.lowest, seconds.highest, compares ? fmt::format("{:.6g}", reference / seconds.median) : "",
                distance(contender.heights, truth) / whole);
    }
}

void begin(const Settings& settings, Csv& csv) {
    csv.note("runs of a method: " + runsRule(settings.runs));
    csv.note("ratio: median of `" + kToRest.front() + "` of the same field over this one's median");
    csv.columns("field,method,N,runs,sweeps,seconds_median,seconds_min,seconds_max,ratio,error");
}

}  // namespace

void rest(const Settings& settings, Csv& csv) {
    csv.note(
        "low pile: cylinder of height 0.6 R, R = 0.3 N, talus 45 degrees, band 0; error against the analytic pile");
    csv.note(fmt::format("beyond N = {} only G and settle", kLargestSlow));
    begin(settings, csv);
    for (const int side : settings.sizes) {
        const Pile pile = lowPile(side);
        write(csv, "low pile", side, race(contendersOn(side), pile.start, settings.runs, "low pile"), pile.rest,
              sumOf(pile.rest));
    }
}

void restMoving(const Settings& settings, Csv& csv) {
    std::vector<Method> all = methods(kToRest);
    // All blocks are active if all sand moves, so "G plain" would repeat "G plain full sweeps".
    std::erase_if(all, [](const Method& method) { return method.name == "G plain"; });
    csv.note("bumpy slope: a plane three times as steep as the talus with bumps of up to half a cell in a closed box;");
    csv.note("  error against " + kToRest.back() +
             ": sum of |difference| over the sum of |rest - start|, the moved sand");
    begin(settings, csv);
    for (const int side : settings.sizes) {
        const sand::HeightField start = bumpySlope(side, settings.seed);
        const std::vector<Contender> slope = race(all, start, settings.runs, "bumpy slope");
        const std::vector<double>& truth = slope.back().heights;
        write(csv, "bumpy slope", side, slope, truth,
              distance(all.back().start(start, rulesFor(start))->heights(), truth));
    }
}

}  // namespace bench
