// SPDX-License-Identifier: Apache-2.0
// Measures the time of a sweep per cell. Also measures a copy, because memory limits a sweep, and a loop without
// memory, because cores limit threads.
#include <algorithm>
#include <functional>
#include <random>
#include <thread>
#include <utility>

#include "bench/report/chosen_rows.hpp"
#include "bench/report/curves.hpp"
#include "bench/report/timing.hpp"
#include "bench/sand/baseline_schemes.hpp"
#include "bench/sand/relaxations.hpp"
#include "host/worker_pool.hpp"
#include "sand/grid/erosion.hpp"

namespace bench {
namespace {

/// Returns a field of noise with a height of 64 cells. Nearly all of it moves.
sand::HeightField roughField(int side, std::uint32_t seed) {
    std::mt19937 random(seed);
    sand::HeightField field(side, side, 1.0);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            field.setHeight(x, y, static_cast<std::int32_t>(random() % (1U << 22)));
        }
    }
    return field;
}

/// Returns level ground with one lump of noise per 128² cells. Each lump is 8 cells wide and at most 64 high. Nearly
/// all blocks of the field are at rest, and the lumps move for longer than a measurement.
sand::HeightField lumpyField(int side, std::uint32_t seed) {
    constexpr int kDistance = 128, kWidth = 8, kFirst = 28;  // [cell]
    const sand::HeightField rough = roughField(side, seed);
    sand::HeightField field(side, side, 1.0);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const auto inLump = [](int place) { return (place + kDistance - kFirst) % kDistance < kWidth; };
            field.setHeight(x, y, inLump(x) && inLump(y) ? rough.height(x, y) : 0);
        }
    }
    return field;
}

/// Returns a number of sweeps that is large enough for the clock's resolution, and so small that all sand still moves.
int sweepsFor(int side) { return std::clamp((1 << 24) / (side * side), 2, 64); }

/// A way of sweeping.
struct Variant {
    sand::Scheme scheme;
    base::CodePath path;
    int threads = 1;
    double band = 0;     // start threshold above the threshold, as a share of it
    bool lumpy = false;  // whether the sand is lumpyField() with a talus of 1, instead of roughField()
};

/// Returns the clock for work of several threads: CPU time of one thread, or wall time [s].
double (*clockFor(int threads))() { return threads > 1 ? wallSeconds : cpuSeconds; }

/// Returns the time per sweep of each run [s].
std::vector<double> measure(const Variant& variant, const sand::HeightField& start, int runs) {
    sand::Rules rules = rulesFor(start, variant.lumpy ? 1.0 : 64.0 / sand::kUnitsPerCell);
    rules.scheme = variant.scheme;
    // The threshold of the rough field is so low that the band would be rounded to 0. So it is at least one unit.
    rules.tuning.startThreshold +=
        variant.band > 0 ? std::max(1, static_cast<int>(rules.tuning.threshold * variant.band)) : 0;
    host::WorkerPool pool(variant.threads);
    const base::Executor executor = pool.executor();
    sand::grid::Erosion::Options options;
    options.path = variant.path;
    options.executor = variant.threads > 1 ? &executor : nullptr;
    const int count = sweepsFor(start.columns());
    std::vector<double> seconds;
    for (int run = 0; run < runs; ++run) {
        sand::HeightField field = start;
        sand::grid::Erosion erosion(field, rules, options);
        erosion.sweep(field, 1);  // touches every page and wakes the threads
        const auto clock = clockFor(variant.threads);
        const double before = clock();
        erosion.sweep(field, count);
        seconds.push_back((clock() - before) / count);
    }
    return seconds;
}

/// Reads and writes one number per cell. On some virtual machines memcpy copies data that fit into the cache ten times
/// slower than this loop.
void copyAndAdd(const std::int32_t* __restrict from, std::int32_t* __restrict to, std::size_t cells) {
    for (std::size_t i = 0; i < cells; ++i) {
        to[i] = from[i] + 1;
    }
}

std::vector<double> measureCopy(int side, int runs) {
    const auto cells = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    std::vector<std::int32_t> from(cells, 1);
    std::vector<std::int32_t> to(cells);
    const int count = 16 * sweepsFor(side);
    std::vector<double> seconds;
    for (int run = 0; run < runs; ++run) {
        const double before = cpuSeconds();
        for (int i = 0; i < count; ++i) {
            copyAndAdd(from.data(), to.data(), cells);
            from.swap(to);
        }
        seconds.push_back((cpuSeconds() - before) / count);
    }
    return seconds;
}

/// Advances a generator of random numbers (xorshift64). Each number depends on the one before, and no memory is needed.
std::uint64_t advance(std::uint64_t number, std::int64_t times) {
    for (std::int64_t i = 0; i < times; ++i) {
        number ^= number << 13;
        number ^= number >> 7;
        number ^= number << 17;
    }
    return number;
}

/// Returns the time of each run for one random number per cell [s]. It shows what threads can gain on this machine.
std::vector<double> measureLoop(int side, int threads, int runs) {
    constexpr int kTasks = 32;  // as many as a sweep has strips
    host::WorkerPool pool(threads);
    std::array<std::uint64_t, kTasks> numbers;
    numbers.fill(1);
    const auto clock = clockFor(threads);
    std::vector<double> seconds;
    for (int run = 0; run < runs; ++run) {
        const double before = clock();
        pool.run(kTasks, [&](int task) {
            std::uint64_t& number = numbers[static_cast<std::size_t>(task)];
            number = advance(number, std::int64_t{side} * side * sweepsFor(side) / kTasks);
        });
        seconds.push_back((clock() - before) / sweepsFor(side));
    }
    // The numbers are used, so that no compiler leaves them out.
    return std::ranges::count(numbers, 0) == 0 ? seconds : std::vector<double>{};
}

std::vector<double> measureBaseline(BaselineScheme scheme, const sand::HeightField& start, int runs) {
    FloatField field(start.columns());
    FloatField scratch(start.columns());
    for (int y = 0; y < field.side; ++y) {
        for (int x = 0; x < field.side; ++x) {
            field.row(y)[x] = static_cast<float>(start.height(x, y)) / sand::kUnitsPerCell;
        }
    }
    const bool hasV3 = base::machineHas(base::CodePath::v3);
    const int count = sweepsFor(start.columns());
    std::vector<double> seconds;
    for (int run = 0; run < runs; ++run) {
        const double before = cpuSeconds();
        for (int i = 0; i < count; ++i) {
            hasV3 ? v3::sweep(scheme, 1e-3F, field, scratch) : baseline::sweep(scheme, 1e-3F, field, scratch);
        }
        seconds.push_back((cpuSeconds() - before) / count);
    }
    return seconds;
}

/// A row of the table: its name, and what it measures on a field of this side.
struct Row {
    std::string name;
    int threads;
    std::function<std::vector<double>(int side, int runs)> measure;
};

/// Returns the rows that sweep `rough` or `lumps`, which live as long as the rows.
std::vector<Row> sweepRows(base::CodePath path, const sand::HeightField& rough, const sand::HeightField& lumps) {
    using enum sand::Scheme;
    constexpr double kBand = 1e-3;
    std::vector<Row> rows;
    const auto add = [&](const std::string& name, const Variant& variant) {
        rows.push_back({name, variant.threads, [&rough, &lumps, variant](int, int runs) {
                            return measure(variant, variant.lumpy ? lumps : rough, runs);
                        }});
    };
    add("G", {.scheme = isotropic, .path = path});
    add("G plain", {.scheme = plainIsotropic, .path = path});
    add("G baseline x86-64", {.scheme = isotropic, .path = base::CodePath::baseline});
    add("G band", {.scheme = isotropic, .path = path, .band = kBand});
    add("G lumps", {.scheme = isotropic, .path = path, .lumpy = true});
    add("G lumps band", {.scheme = isotropic, .path = path, .band = kBand, .lumpy = true});
    rows.push_back({"loop", 1, [](int side, int runs) { return measureLoop(side, 1, runs); }});
    for (int threads = 2; threads <= static_cast<int>(std::thread::hardware_concurrency()); threads *= 2) {
        add(fmt::format("G {} threads", threads), {.scheme = isotropic, .path = path, .threads = threads});
        rows.push_back({fmt::format("loop {} threads", threads), threads,
                        [threads](int side, int runs) { return measureLoop(side, threads, runs); }});
    }
    return rows;
}

/// Returns the rows with the names in `settings`, or all rows without a name.
std::vector<Row> rowsFor(const Settings& settings, const sand::HeightField& rough, const sand::HeightField& lumps) {
    std::vector<Row> rows{{"copy", 1, measureCopy}};
    std::ranges::move(sweepRows(base::chosenCodePath(settings.path.value_or(base::fastestCodePath())), rough, lumps),
                      std::back_inserter(rows));
    for (const auto& [name, scheme] : {std::pair{"float32 N4 Jacobi", BaselineScheme::jacobiN4},
                                       {"float32 N4 in place", BaselineScheme::inPlaceN4},
                                       {"float32 N8 sqrt2 Jacobi", BaselineScheme::jacobiN8r2}}) {
        rows.push_back(
            {name, 1, [&rough, kind = scheme](int, int runs) { return measureBaseline(kind, rough, runs); }});
    }
    return chosenRows(std::move(rows), settings.rows);
}

}  // namespace

void throughput(const Settings& settings, Csv& csv) {
    sand::HeightField rough(1, 1, 1.0), lumps(1, 1, 1.0);
    const std::vector<Row> rows = rowsFor(settings, rough, lumps);
    csv.note("a field in which all sand moves, or one lump per 128 x 128 cells; time per cell of the field");
    csv.note("band: sand starts to slide 0.1 % above the threshold at which it stops");
    csv.note("loop: one random number per cell, computed without memory");
    csv.note("CPU time of one thread, wall time of several threads");
    csv.note(
        "times_copy: over the median of reading and writing a 32-bit number per cell in the same run: the roofline");
    csv.columns("variant,threads,N,ns_per_cell_median,ns_per_cell_min,ns_per_cell_max,times_copy");
    for (const int side : settings.sizes) {
        const double nanoseconds = 1e9 / (static_cast<double>(side) * side);
        const double copy = spreadOf(measureCopy(side, settings.runs)).median;
        rough = roughField(side, settings.seed);
        lumps = lumpyField(side, settings.seed);
        for (const Row& row : rows) {
            progress("N = {}, {}", side, row.name);
            const Spread spread = spreadOf(row.measure(side, settings.runs));
            csv.row(row.name, row.threads, side, spread.median * nanoseconds, spread.lowest * nanoseconds,
                    spread.highest * nanoseconds, spread.median / copy);
        }
    }
}

}  // namespace bench
