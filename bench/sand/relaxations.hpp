// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sand/model/height_field.hpp"
#include "scene/model/scene.hpp"

namespace bench {

/// One pile that one method brings to rest. Adapts the interface of every solver to the benchmarks.
class Relaxation {
public:
    virtual ~Relaxation() = default;
    /// Runs at most `count` more sweeps. G begins with more inertia if `count` is small. Otherwise several calls give
    /// the same heights as one.
    virtual void sweep(int count) = 0;
    [[nodiscard]] virtual bool atRest() const = 0;
    [[nodiscard]] virtual std::int64_t sweepsDone() const = 0;
    /// Returns the heights row by row [cell].
    [[nodiscard]] virtual std::vector<double> heights() const = 0;
};

inline constexpr double kTalus = 0.6745;  // 34 degrees, as in the scenes

/// A way to bring sand to rest: ours, or one in common use.
struct Method {
    std::string name;
    bool integers;  // whether heights are integers, which come to rest; floats may creep without end
    std::function<std::unique_ptr<Relaxation>(const sand::HeightField&, const sand::Rules&)> start;
};

/// Returns every method; methods with integers come first.
[[nodiscard]] std::vector<Method> allMethods();
/// Returns the methods with the names in `names`, in that order. Throws std::logic_error for an unknown name.
[[nodiscard]] std::vector<Method> methods(const std::vector<std::string>& names);

/// The methods whose time to rest is measured: the reference first, the most exact one last.
inline const std::vector<std::string> kToRest{"G plain full sweeps", "G plain", "G", "settle"};

/// Returns the rules of a closed box. `talus` is a tangent; `band` is a share of the talus.
[[nodiscard]] sand::Rules rulesFor(const sand::HeightField& field, double talus = 1, double band = 0);

/// Runs the scheme of `rules` until the sand is at rest. Returns the number of sweeps.
std::int64_t sweepToRest(sand::HeightField& field, const sand::Rules& rules);

inline constexpr int kMostSweeps = 1 << 22;      // more than any method in integers needs
inline constexpr float kFloatTolerance = 1e-6F;  // [cell]; a baseline is at rest when no sweep moves more

}  // namespace bench
