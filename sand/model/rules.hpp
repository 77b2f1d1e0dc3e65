// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "base/field_forms.hpp"
#include "base/names.hpp"
#include "sand/model/sweep_plan.hpp"
#include "sand/model/tuning.hpp"
#include "sand/model/units.hpp"

namespace sand {

/// Version of the algorithm. It increases with every change to what a step does to the sand. Programs of different
/// versions refuse to run together.
inline constexpr std::uint32_t kAlgorithmVersion = 17;

/// Law by which sand slides on a height field. The documents call `isotropic` G and `plainIsotropic` plain G;
/// docs/sand.md states both laws.
///
/// A scheme keeps its number forever, because digests, messages, journals and checkpoints contain the number. Number 1
/// belonged to a scheme that was removed; rules with it are refused.
enum class Scheme : std::uint8_t { isotropic = 0, plainIsotropic = 2 };

/// The names are those of scene files and command lines. The default is the first.
constexpr auto valuesOf(Scheme) {
    return std::array{base::Named{Scheme::isotropic, "g"}, base::Named{Scheme::plainIsotropic, "g_plain"}};
}

/// Border of the field.
enum class Rim : std::uint8_t {
    closed,  // keeps all sand on the field
    open     // lets sand fall over it, as outflow
};
constexpr auto valuesOf(Rim) { return std::array{base::Named{Rim::closed, "closed"}, base::Named{Rim::open, "open"}}; }

/// Most sub-steps in the path of a step with the smallest tool. They take about half a second. A tool of a TIN
/// costs more, because its outline goes into the mesh and out of it. `sandwall-bench bounds` measures them.
inline constexpr std::int64_t kMostSubsteps = 1 << 21, kMostSubstepsOfTin = 1 << 14;

/// Largest size of the compressed sand in a load, unless a height field can need more (Rules::stepLimits()) [byte].
inline constexpr std::int64_t kMaxSandBytes = std::int64_t{192} << 20;

/// Limits of the numbers that a step states in bytes.
struct StepLimits {
    std::int32_t leastSweeps = 1, mostSweeps = kMostSweeps;
    std::int64_t mostSubsteps = kMostSubsteps;   // of its path
    std::int64_t mostSandBytes = kMaxSandBytes;  // of a load
};

/// The rules by which every replica computes its sand, as numbers. The process that loads the scene derives them once
/// and sends them to all other processes. These never derive them again, because the last digit of libm's results
/// differs between hosts.
struct Rules {
    std::int32_t columns = 0, rows = 0;  // [cell]
    /// Side of a cell from south to north, divided by its side from west to east [2^-16].
    std::int32_t aspect = kUnitsPerCell;
    Tuning tuning{};
    std::int32_t stepsPerSecond = 0;
    Scheme scheme = Scheme::isotropic;
    Rim rim = Rim::closed;
    std::uint64_t ground = 0;  // Ground::digest(); 0 without rock and wall cells
    std::uint64_t tin = 0;     // tin::TinStart::digest(), which makes columns and rows nominal; 0 for a height field

    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        constexpr std::int32_t kAny = std::numeric_limits<std::int32_t>::max();
        visit("columns", base::limited(it.columns, 1, kMaxSide));
        visit("rows", base::limited(it.rows, 1, kMaxSide));
        visit("aspect", base::limited(it.aspect, 1, kAny));
        visit("tuning", it.tuning);
        visit("steps_per_second", base::limited(it.stepsPerSecond, 1, kAny));
        visit("scheme", it.scheme);
        visit("rim", it.rim);
        visit("ground", it.ground);
        visit("tin", it.tin);
    }

    /// Returns a digest of what heights belong to, beside the size: rock and walls of a height field, or the start of a
    /// TIN.
    [[nodiscard]] std::uint64_t siteDigest() const { return ground ^ tin; }
    [[nodiscard]] SweepPlan sweepPlan() const { return sweepPlan(tuning); }
    /// Returns the plan after an operator's tuning.
    [[nodiscard]] SweepPlan sweepPlan(const Tuning& tuned) const {
        return tin == 0 ? gridSweepPlan(tuned) : tinSweepPlan(tuned);
    }
    /// Returns what a step of this sand may state. Steps of a TIN state no sweeps, because all of its sweeps run in one
    /// step: the fluxes between two of them are no state.
    [[nodiscard]] StepLimits stepLimits() const;
    /// Returns an upper bound of the compressed bytes of so many numbers for each cell of a height field, at most
    /// 2^32 - 2^26 [byte]. Saved sand has three: the height, and the fluxes through two faces.
    [[nodiscard]] std::int64_t mostBytesOf(int numbers) const;
    /// Returns the length of a sub-step of the tool along every axis [probe unit].
    [[nodiscard]] std::int32_t substepLength() const { return tin == 0 ? substepOnGrid(tuning.tool) : kProbePerCell; }
    /// Returns how many sub-steps the path of a step may have with the tool of these rules, at least 1. A replica
    /// leaves out a longer path, and a program that numbers steps divides it.
    [[nodiscard]] std::int64_t mostSubsteps() const;
    /// Returns a hash of the encoded rules and kAlgorithmVersion. Server and master compare it: replicas with equal
    /// digests and equal sand stay equal under equal steps.
    [[nodiscard]] std::uint64_t digest() const;
    friend bool operator==(const Rules&, const Rules&) = default;
};

}  // namespace sand
