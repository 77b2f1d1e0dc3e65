// SPDX-License-Identifier: Apache-2.0
#include "scene/relax/relaxation.hpp"

#include "sand/grid/net_flux.hpp"
#include "sand/grid/settle.hpp"

namespace sand::relax {
namespace {

Relaxed settleAll(GridSand& sand) {
    const HeightField start = sand.field;
    NetFlux flux(start.columns(), start.rows());
    const Settled settled = settle(sand.field, sand.rules, &flux);
    return {.settled = true,
            .sweeps = settled.sweeps,
            .iterations = settled.iterations,
            .atRest = true,
            .certificate = certify(start, sand.field, flux, sand.rules)};
}

Relaxed sweepAll(GridSand& sand, const Manner& manner) {
    std::optional<HeightField> start;
    std::optional<NetFlux> flux;
    if (!sand.ground) {
        start = sand.field;
        flux.emplace(sand.field.columns(), sand.field.rows());
    }
    Erosion erosion(sand.field, sand.rules,
                    {.ground = sand.ground ? &*sand.ground : nullptr, .executor = manner.executor});
    // One by one: a call for several sweeps begins with more inertia when they are few.
    while (!erosion.settled() && erosion.sweepsDone() < manner.mostSweeps) {
        erosion.sweep(sand.field, 1);
        if (flux) {
            erosion.addFluxes(*flux);
        }
        if (manner.afterSweep) {
            manner.afterSweep(erosion);
        }
    }
    Relaxed relaxed{.sweeps = erosion.sweepsDone(), .atRest = erosion.settled(), .certificate = std::nullopt};
    if (flux) {
        relaxed.certificate = certify(*start, sand.field, *flux, sand.rules);
    }
    return relaxed;
}

}  // namespace

Relaxed relax(GridSand& sand, const Manner& manner) {
    return manner.settle && !sand.ground ? settleAll(sand) : sweepAll(sand, manner);
}

}  // namespace sand::relax
