// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/hand/hand.hpp"

#include <utility>

namespace haptic_bridge {

void Hand::begin(const sand::Replica& sand) {
    present_ = true;
    liftFirst_ = sand.engaged();
    last_ = {.readNs = 0, .probe = sand.probe()};
    path_.restart(last_.probe);
}

void Hand::end() {
    present_ = false;
    path_.dropWaiting();
}

void Hand::add(const HandSample& sample) {
    if (present_) {
        last_ = sample;
        path_.add(sample);
    }
}

std::int64_t Hand::fill(sand::Step& step, const SubstepLimit& limit) {
    if (!present_ || std::exchange(liftFirst_, false)) {
        return 0;
    }
    collect();
    return path_.take(step, limit);
}

}  // namespace haptic_bridge
