// SPDX-License-Identifier: Apache-2.0
#include "scene/relax/relaxation.hpp"

#include "sand/grid/net_flux.hpp"
#include "sand/grid/settle.hpp"

namespace scene::relax {
namespace {

Relaxed settleAll(GridSand& sand) {
    const sand::HeightField start = sand.field;
    sand::grid::NetFlux flux(start.columns(), start.rows());
    const sand::grid::Settled settled = sand::grid::settle(sand.field, sand.rules, &flux);
    return {.settled = true,
            .sweeps = settled.sweeps,
            .iterations = settled.iterations,
            .atRest = true,
            .certificate = sand::grid::certify(start, sand.field, flux, sand.rules)};
}

Relaxed sweepAll(GridSand& sand, const Manner& manner) {
    std::optional<sand::HeightField> start;
    std::optional<sand::grid::NetFlux> flux;
    if (!sand.ground) {
        start = sand.field;
        flux.emplace(sand.field.columns(), sand.field.rows());
    }
    sand::grid::Erosion erosion(sand.field, sand.rules,
                                {.ground = sand.ground ? &*sand.ground : nullptr, .executor = manner.executor});
    // Sweeps one by one, because a call for a few sweeps begins with more inertia.
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
        relaxed.certificate = sand::grid::certify(*start, sand.field, *flux, sand.rules);
    }
    return relaxed;
}

}  // namespace

Relaxed relax(GridSand& sand, const Manner& manner) {
    return manner.settle && !sand.ground ? settleAll(sand) : sweepAll(sand, manner);
}

}  // namespace scene::relax
