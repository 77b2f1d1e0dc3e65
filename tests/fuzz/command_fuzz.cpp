// SPDX-License-Identifier: Apache-2.0
// Fuzzes an operator's commands, as `sandwall ctl` and standard input send them. They are carried out as far as that
// needs no session. Each accepted change of tool or material must be a step that haptic servers and ranks accept.
#include "master/journal/saved_sand.hpp"
#include "master/operator/operator_command.hpp"
#include "sand/model/step.hpp"
#include "scene/model/scene.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "walls/stereo_change.hpp"
#include "walls/wall_check.hpp"

namespace {

constexpr std::size_t kMostLines = 8;

walls::Wall passiveWall() {
    walls::Wall wall;
    wall.stereo = walls::Stereo::passive;
    wall.grid = walls::Grid{.rows = 1, .columns = 2};
    wall.tiles = walls::tilesOf(*wall.grid, wall.stereo);
    return wall;
}

void change(scene::Material& material, const scene::Material& wanted, const scene::MaterialGrid& grid) {
    sand::Step step;
    step.edit = sand::Edit::tuned(scene::tuningOf(wanted, grid));
    base::ByteWriter writer;
    step.put(writer);
    base::ByteReader reader(writer.bytes());
    bool same = false;
    try {
        same = base::read<sand::Step>(reader) == step;
    } catch (const base::FormatError&) {
    }
    fuzz::require(same, "a command makes a step that cannot be sent");
    material = wanted;
}

void carryOut(const master::Command& command, const scene::MaterialGrid& grid, scene::Material& material) {
    using master::Verb;
    static const walls::Wall kOpened = passiveWall();
    switch (command.verb) {
        case Verb::tool:
            change(material, scene::withTool(material, command.tool, grid), grid);
            break;
        case Verb::material:
            change(material, scene::withNumber(material, command.word, command.number, grid), grid);
            break;
        case Verb::stereo:
            (void)walls::shownOnItsOutputs(kOpened, command.stereo);
            break;
        case Verb::save:
        case Verb::load:
            fuzz::require(master::saveFile("out", command.word).lexically_normal().parent_path() == "out/saves",
                          "a name leads out of the session's folder");
            break;
        case Verb::eyeSeparation:
            fuzz::require(command.number >= 0 && command.number <= walls::kMaxEyeSeparation,
                          "an eye separation is out of range");
            break;
        case Verb::force:
            fuzz::require(command.number >= 0 && command.number <= 1, "a share of the force is out of range");
            break;
        default:
            break;
    }
}

}  // namespace

SANDWALL_FUZZER(command) {
    static const scene::MaterialGrid kGrid = samples::flatScene(24, 16).grid();
    scene::Material material;
    std::string_view text = fuzz::textOf({data, size});
    for (std::size_t lines = 0; lines < kMostLines && !text.empty(); ++lines) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, std::min(end, master::kLongestCommand));
        text.remove_prefix(std::min(end + 1, text.size()));
        fuzz::takeOrRefuse([&] { carryOut(master::parseCommand(line), kGrid, material); });
    }
    return 0;
}
