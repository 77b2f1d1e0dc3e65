// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/report/csv.hpp"

/// The curves of the report. Each function writes the definitions of its columns, their names and the rows.
namespace bench {

void workPrecision(const Settings& settings, Csv& csv);
void errorAtRest(const Settings& settings, Csv& csv);
void sweeps(const Settings& settings, Csv& csv);
void anisotropy(const Settings& settings, Csv& csv);
void decay(const Settings& settings, Csv& csv);
void heightBits(const Settings& settings, Csv& csv);
void band(const Settings& settings, Csv& csv);
void bounds(const Settings& settings, Csv& csv);
void heldTools(const Settings& settings, Csv& csv);
void edit(const Settings& settings, Csv& csv);
void dig(const Settings& settings, Csv& csv);
void largeTools(const Settings& settings, Csv& csv);
void throughput(const Settings& settings, Csv& csv);
void massDrift(const Settings& settings, Csv& csv);
void certificate(const Settings& settings, Csv& csv);
void budget(const Settings& settings, Csv& csv);
void parts(const Settings& settings, Csv& csv);
void rest(const Settings& settings, Csv& csv);
void restMoving(const Settings& settings, Csv& csv);
void forceRate(const Settings& settings, Csv& csv);
void forceWork(const Settings& settings, Csv& csv);
void hashes(const Settings& settings, Csv& csv);
void stability(const Settings& settings, Csv& csv);
void guardedSweep(const Settings& settings, Csv& csv);
void betweenStability(const Settings& settings, Csv& csv);
void forceLoop(const Settings& settings, Csv& csv);
void tap(const Settings& settings, Csv& csv);
void tinPiles(const Settings& settings, Csv& csv);
void tinActive(const Settings& settings, Csv& csv);
void tinStep(const Settings& settings, Csv& csv);
void extremes(const Settings& settings, Csv& csv);
void explain(const Settings& settings, Csv& csv);
void imprint(const Settings& settings, Csv& csv);
void simplify(const Settings& settings, Csv& csv);

}  // namespace bench
