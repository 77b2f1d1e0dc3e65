// SPDX-License-Identifier: Apache-2.0
// Fuzzes a TIN in a state, in saved sand or in a scene: its layer, its start and the imprint of a tool. An accepted TIN
// must be equal after it is encoded and decoded. Then its sand moves: digging, sliding and removing vertices.
#include <array>

#include "sand/replica.hpp"
#include "sand/tin/surface.hpp"
#include "scene/model/scene.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/fuzz/plain_sand.hpp"
#include "tests/support/sand/tin_scene.hpp"

namespace {

using sand::ProbePoint;
using sand::tin::TinSurface;

/// Returns sand as a state has it. `plain` holds a TinState, and behind it the vertices.
base::Bytes packed(fuzz::Input plain) {
    base::ByteReader reader(plain);
    return fuzz::packedTin(reader);
}

void goOn(TinSurface& surface, const scene::Scene& scene) {
    const sand::Tool& tool = scene.rules.tuning.tool;
    const auto outside = surface.outflow();
    const auto volume = surface.layer().volume();
    const std::array path{ProbePoint{1500, 1500, 300}, ProbePoint{2600, 1900, 200}};
    surface.drag(tool, path);
    surface.sweep(sand::SweepPart::all(2), &tool, path.back());
    surface.leave(tool);
    surface.sweep(sand::SweepPart::all(4), nullptr, path.back());
    fuzz::require(surface.layer().volume() + surface.outflow() == volume + outside,
                  "the volume of the sand has changed");
    (void)surface.hash();
}

void takeState(fuzz::Input bytes) {
    static const scene::Scene kScene = samples::tinScene();
    TinSurface surface(kScene.rules, kScene.tin);
    const auto copy = surface.reader()(bytes);
    fuzz::require(surface.reader()(copy->encode())->encode() == copy->encode(),
                  "a state differs after it is encoded and decoded");
    surface.replace(*copy);
    const std::uint64_t hash = surface.hash();
    surface.audit(1 << 20);
    fuzz::require(surface.hash() == hash, "the hash differs after an audit");
    goOn(surface, kScene);
}

}  // namespace

SANDWALL_FUZZER(tin) {
    if (size == 0) {
        return 0;
    }
    const fuzz::Input raw = fuzz::Input(data, size).subspan(1);
    fuzz::takeOrRefuse([&] {
        switch (data[0] & 3U) {
            case 0:
                takeState(packed(raw));
                break;
            case 1:
                takeState(raw);
                break;
            case 3: {  // a whole state, with the sand that is kept for an undo
                static const scene::Scene kScene = samples::tinScene();
                sand::Replica replica(kScene);
                replica.decodeState(fuzz::packedState(raw, kScene));
                sand::Replica again(kScene);
                again.decodeState(replica.encodeState());
                fuzz::require(again.stateHash() == replica.stateHash() && again.encodeState() == replica.encodeState(),
                              "a whole state differs after it is encoded and decoded");
                break;
            }
            default: {
                base::ByteReader reader(raw);
                const auto start = sand::tin::TinStart::decode(reader);
                base::ByteWriter writer;
                start.encode(writer);
                base::ByteReader again(writer.bytes());
                fuzz::require(sand::tin::TinStart::decode(again).digest() == start.digest(),
                              "a start differs after it is encoded and decoded");
                if (start.places.size() < 1000) {
                    (void)sand::tin::layerOf(start).volume();
                }
            }
        }
    });
    return 0;
}
