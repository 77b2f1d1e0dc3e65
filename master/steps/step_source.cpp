// SPDX-License-Identifier: Apache-2.0
#include "master/steps/step_source.hpp"

#include <chrono>
#include <thread>

namespace master {

ArrivedSteps awaitSteps(StepSource& source, const sand::Replica& sand, std::uint64_t hash, std::size_t most,
                        const std::function<bool()>& stop) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point until =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(source.patience()));
    ArrivedSteps steps = source.next(sand, hash, most);
    while (most > 0 && steps.empty() && Clock::now() < until && !stop()) {
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        steps = source.next(sand, hash, most);
    }
    return steps;
}

}  // namespace master
