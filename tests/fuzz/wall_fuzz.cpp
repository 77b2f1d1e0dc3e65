// SPDX-License-Identifier: Apache-2.0
// Fuzzes a wall file, and the wall that a master sends to its ranks.
#include "tests/fuzz/fuzz_target.hpp"
#include "walls/wall.hpp"

SANDWALL_FUZZER(wall) {
    const fuzz::Input input(data, size);
    fuzz::takeOrRefuse([&] { (void)walls::parseWall(fuzz::textOf(input), "wall.toml"); });
    fuzz::takeOrRefuse([&] { (void)walls::Wall::decode(input); });
    return 0;
}
