// SPDX-License-Identifier: Apache-2.0
// Fuzzes a scene file, with fields of at most 99 cells per side. Larger fields are also valid, but take long.
#include <cctype>

#include "sand/replica.hpp"
#include "scene/load/scene_file.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

/// Returns true if the text has a number of three digits or more, or a number in another notation.
bool mayBeLarge(std::string_view text) {
    int digits = 0;
    for (const char c : text) {
        digits = std::isdigit(static_cast<unsigned char>(c)) != 0 ? digits + 1 : 0;
        if (digits > 2 || c == '_' || c == 'x') {
            return true;
        }
    }
    return false;
}

}  // namespace

SANDWALL_FUZZER(scene) {
    const fuzz::Input input(data, size);
    if (mayBeLarge(fuzz::textOf(input))) {
        return 0;
    }
    const fuzz::MemoryFile file(input);
    fuzz::takeOrRefuse([&] {
        const scene::Scene scene = scene::loadScene(file.path());
        sand::Replica replica(scene);
        replica.apply({.epoch = 1, .number = 1, .engaged = true, .path = {{0, 0, 0}}});
        (void)scene::Scene::decode(scene.encode());
    });
    return 0;
}
