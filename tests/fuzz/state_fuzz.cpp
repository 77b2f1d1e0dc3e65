// SPDX-License-Identifier: Apache-2.0
// Fuzzes a state that is sent to a replica, saved sand, and the scene at the start of a journal or of a master. If a
// bit of the input asks for it, the cells of states and sand are plain bytes, which are compressed here. A flipped bit
// of compressed data would never reach the code behind the decompression.
#include "sand/grid/snapshot.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/plain_sand.hpp"
#include "tests/support/sand/sand_samples.hpp"

SANDWALL_FUZZER(state) {
    if (size == 0) {
        return 0;
    }
    static const scene::Scene kScene = samples::flatScene(24, 16);
    const fuzz::Input raw = fuzz::Input(data, size).subspan(1);
    fuzz::takeOrRefuse([&] {
        base::Bytes packed(raw.begin(), raw.end());
        if ((data[0] & 4U) != 0 && (data[0] & 3U) == 0) {
            packed = fuzz::packedState(raw, kScene);
        } else if ((data[0] & 4U) != 0) {
            base::ByteReader plain(raw);
            packed = fuzz::packedSand(plain, kScene);
        }
        switch (data[0] & 3U) {
            case 0: {
                sand::Replica replica(kScene);
                replica.decodeState(packed);
                replica.apply({.epoch = 1, .number = replica.stepNumber() + 1, .engaged = true, .path = {{0, 0, 0}}});
                break;
            }
            case 1:
                (void)sand::grid::Snapshot::decode(packed, {{kScene.rules.columns, kScene.rules.rows}});
                break;
            case 2:
                (void)scene::Scene::decode(packed);
                break;
            default: {
                sand::Replica replica(kScene);
                replica.apply(
                    {.epoch = 1, .number = 1, .engaged = false, .path = {}, .edit = sand::Edit::loaded(packed)});
            }
        }
    });
    return 0;
}
