// SPDX-License-Identifier: Apache-2.0
#include "lockstep/healing.hpp"

#include <algorithm>

namespace lockstep {

Healing heal(FrameBarrier& barrier, sand::Replica& replica, const Remedy& fromMaster) {
    const Remedy remedy = base::decoded<Remedy>(barrier.broadcast(base::encoded(fromMaster)));
    if (!remedy.goOn) {
        return Healing::ended;
    }
    const int rank = barrier.cluster().rank();
    const bool odd = std::find(remedy.odd.begin(), remedy.odd.end(), rank) != remedy.odd.end();
    if (!remedy.odd.empty()) {
        const bool gives = rank == remedy.source;
        const base::Bytes state =
            barrier.pass(remedy.source, remedy.odd, gives ? replica.encodeState() : base::Bytes());
        if (odd) {
            replica.decodeState(state);
        }
    }
    replica.audit(replica.hashTiles().tileCount());
    return odd ? Healing::healed : Healing::spared;
}

}  // namespace lockstep
