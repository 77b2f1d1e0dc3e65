// SPDX-License-Identifier: Apache-2.0
#include "tests/impaired_link/schedule.hpp"

#include <algorithm>

namespace impaired_link {

Schedule::Schedule(const Impairment& impairment, std::uint32_t stream) : impairment_(impairment) {
    std::seed_seq seeds{impairment.seed, stream};
    random_.seed(seeds);
}

double Schedule::chance() { return static_cast<double>(random_()) * 0x1p-32; }

std::int64_t Schedule::leaves(std::int64_t arrivedNs) {
    double ms = impairment_.delayMs + impairment_.jitterMs * chance();
    if (chance() < impairment_.stallShare) {
        ms += impairment_.stallMs;
        ++stalls_;
    }
    last_ = std::max(last_, arrivedNs + static_cast<std::int64_t>(ms * 1e6));
    return last_;
}

}  // namespace impaired_link
