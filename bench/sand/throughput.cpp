// SPDX-License-Identifier: Apache-2.0
// Measures the time of a sweep per cell, beside the time of a copy, which is the limit of the machine's memory.
#include <algorithm>
#include <random>
#include <thread>

#include "bench/curves.hpp"
#include "bench/sand/baseline_schemes.hpp"
#include "bench/sand/relaxations.hpp"
#include "bench/timing.hpp"
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

struct Variant {
    std::string name;
    sand::Scheme scheme;
    base::CodePath path;
    int threads;
    double band = 0;     // start threshold above the threshold, as a share of it
    bool lumpy = false;  // whether the sand is lumpyField() with a talus of 1, instead of roughField()
};

/// Returns the time per sweep of each run [s]: CPU time of one thread, or wall time of several threads.
std::vector<double> measure(const Variant& variant, const sand::HeightField& start, int runs) {
    sand::Rules rules = rulesFor(start, variant.lumpy ? 1.0 : 64.0 / sand::kUnitsPerCell);
    rules.scheme = variant.scheme;
    // At least one unit, because the band would otherwise be none with the low threshold of the rough field.
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
        const auto clock = variant.threads > 1 ? wallSeconds : cpuSeconds;
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

}  // namespace

void throughput(const Settings& settings, Csv& csv) {
    using sand::Scheme;
    constexpr double kBand = 1e-3;
    std::vector<Variant> variants{{"G", Scheme::isotropic, base::fastestCodePath(), 1},
                                  {"G plain", Scheme::plainIsotropic, base::fastestCodePath(), 1},
                                  {"G baseline x86-64", Scheme::isotropic, base::CodePath::baseline, 1},
                                  {"G band", Scheme::isotropic, base::fastestCodePath(), 1, kBand},
                                  {"G lumps", Scheme::isotropic, base::fastestCodePath(), 1, 0, true},
                                  {"G lumps band", Scheme::isotropic, base::fastestCodePath(), 1, kBand, true}};
    for (int threads = 2; threads <= static_cast<int>(std::thread::hardware_concurrency()); threads *= 2) {
        variants.push_back({fmt::format("G {} threads", threads), Scheme::isotropic, base::fastestCodePath(), threads});
    }
    csv.note("a field in which all sand moves, or one lump per 128 x 128 cells; time per cell of the field");
    csv.note("band: sand starts to slide 0.1 % above the threshold at which it stops");
    csv.note("CPU time of one thread, wall time of several threads");
    csv.note(
        "times_copy: over the median of reading and writing a 32-bit number per cell in the same run: the roofline");
    csv.columns("variant,threads,N,ns_per_cell_median,ns_per_cell_min,ns_per_cell_max,times_copy");
    for (const int side : settings.sizes) {
        const double nanoseconds = 1e9 / (static_cast<double>(side) * side);
        const double copy = spreadOf(measureCopy(side, settings.runs)).median;
        const auto row = [&](const std::string& name, int threads, const std::vector<double>& seconds) {
            progress("N = {}, {}", side, name);
            const Spread spread = spreadOf(seconds);
            csv.row(name, threads, side, spread.median * nanoseconds, spread.lowest * nanoseconds,
                    spread.highest * nanoseconds, spread.median / copy);
        };
        row("copy", 1, measureCopy(side, settings.runs));
        const sand::HeightField start = roughField(side, settings.seed);
        const sand::HeightField lumps = lumpyField(side, settings.seed);
        for (const Variant& variant : variants) {
            row(variant.name, variant.threads, measure(variant, variant.lumpy ? lumps : start, settings.runs));
        }
        row("float32 N4 Jacobi", 1, measureBaseline(BaselineScheme::jacobiN4, start, settings.runs));
        row("float32 N4 in place", 1, measureBaseline(BaselineScheme::inPlaceN4, start, settings.runs));
        row("float32 N8 sqrt2 Jacobi", 1, measureBaseline(BaselineScheme::jacobiN8r2, start, settings.runs));
    }
}

}  // namespace bench
