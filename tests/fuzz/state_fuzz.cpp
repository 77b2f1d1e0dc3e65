// SPDX-License-Identifier: Apache-2.0
// Fuzzes a state that is sent to a replica, saved sand, and the scene at the start of a journal or of a master. The
// input is compressed first if a bit of it asks for that. A flipped bit of compressed data would never reach the code
// behind the decompression.
#include <zstd.h>

#include "sand/grid/snapshot.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/sand_samples.hpp"

namespace {

base::Bytes compressed(fuzz::Input bytes) {
    base::Bytes packed(ZSTD_compressBound(bytes.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
    return packed;
}

}  // namespace

SANDWALL_FUZZER(state) {
    if (size == 0) {
        return 0;
    }
    static const scene::Scene kScene = samples::flatScene(24, 16);
    const fuzz::Input raw = fuzz::Input(data, size).subspan(1);
    const base::Bytes packed = (data[0] & 4U) != 0 ? compressed(raw) : base::Bytes(raw.begin(), raw.end());
    fuzz::takeOrRefuse([&] {
        switch (data[0] & 3U) {
            case 0: {
                sand::Replica terrain(kScene);
                terrain.decodeState(packed);
                terrain.apply({.epoch = 1, .number = terrain.stepNumber() + 1, .engaged = true, .path = {{0, 0, 0}}});
                break;
            }
            case 1:
                (void)sand::grid::Snapshot::decode(packed, kScene.terrain.columns(), kScene.terrain.rows(),
                                                   kScene.terrain.cellSize());
                break;
            case 2:
                (void)scene::Scene::decode(packed);
                break;
            default: {
                sand::Replica terrain(kScene);
                terrain.apply(
                    {.epoch = 1, .number = 1, .engaged = false, .path = {}, .edit = sand::Edit::loaded(packed)});
            }
        }
    });
    return 0;
}
