// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sand/model/height_field.hpp"
#include "scene/scene.hpp"

namespace bench {

/// One pile on its way to rest by one method. The one place where the benchmarks meet the solvers' interfaces.
class Relaxation {
public:
    virtual ~Relaxation() = default;
    /// At most so many more sweeps. G begins with more inertia when they are few; else parts give the same.
    virtual void sweep(int count) = 0;
    [[nodiscard]] virtual bool atRest() const = 0;
    [[nodiscard]] virtual std::int64_t sweepsDone() const = 0;
    /// Heights row by row [cell].
    [[nodiscard]] virtual std::vector<double> heights() const = 0;
};

inline constexpr double kTalus = 0.6745;  // 34 degrees, as the scenes have

/// A way to bring sand to rest: ours, or one in common use.
struct Method {
    std::string name;
    bool integers;  // counts in integers, and so comes to rest; floats may creep for ever
    std::function<std::unique_ptr<Relaxation>(const sand::HeightField&, const sand::Rules&)> start;
};

/// Every method that can relax a pile, those in integers first.
[[nodiscard]] std::vector<Method> allMethods();
/// The ones whose name is in `names`, in that order. Throws std::logic_error for a name that no method has.
[[nodiscard]] std::vector<Method> methods(const std::vector<std::string>& names);

/// What the time to rest is measured of: the reference first, the one nearest to the truth last.
inline const std::vector<std::string> kToRest{"G plain full sweeps", "G plain", "G", "settle"};

/// Rules of a closed box for sand at `talus` (a tangent), band 0 unless told.
[[nodiscard]] sand::Rules rulesFor(const sand::HeightField& field, double talus = 1, double band = 0);

/// Runs our own scheme of these rules until nothing moves; returns the sweeps it took.
std::int64_t sweepToRest(sand::HeightField& field, const sand::Rules& rules);

/// "x86-64-v3" or "baseline": what the sweeps run with on this machine.
[[nodiscard]] const char* codePath();

inline constexpr int kMostSweeps = 1 << 22;      // more than any method in integers needs
inline constexpr float kFloatTolerance = 1e-6F;  // [cell]: a baseline stops when nothing moves further in a sweep

}  // namespace bench
