// SPDX-License-Identifier: Apache-2.0
// Fuzzes a checkpoint, either as it is on disk or with a correct checksum. The correct checksum lets the fuzzer reach
// the state behind it, which a replica would load.
#include "master/journal/checkpoint.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/fuzz/checksummed.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/sand/sand_samples.hpp"

SANDWALL_FUZZER(checkpoint) {
    if (size == 0) {
        return 0;
    }
    static const scene::Scene kScene = samples::flatScene(24, 16);
    const base::Bytes file = fuzz::checksummed({data, size});
    fuzz::takeOrRefuse([&] {
        const master::Checkpoint checkpoint = master::Checkpoint::decode(file);
        sand::Replica replica(kScene);
        replica.decodeState(checkpoint.state);
        (void)replica.stateHash();
    });
    return 0;
}
