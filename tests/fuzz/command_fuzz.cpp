// SPDX-License-Identifier: Apache-2.0
// Fuzzes an operator's commands, as `sandwall ctl` and standard input send them. They are carried out as far as that
// needs no session. Each accepted change of tool or material must be a step that haptic servers and ranks accept.
#include "master/journal/saved_sand.hpp"
#include "sand/model/step.hpp"
#include "scene/model/scene.hpp"
#include "tests/fuzz/fuzz_target.hpp"
#include "tests/support/noting_desk.hpp"
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

/// A desk that does what a command asks for, as far as no session is needed.
class FuzzDesk : public support::NotingDesk {
public:
    void changeTool(const scene::ToolChange& change, const Asker& /* asker */) {
        take(scene::withTool(material_, change, grid_));
    }
    void changeMaterial(const master::MaterialChange& change, const Asker& /* asker */) {
        take(scene::withNumber(material_, change.word, change.number, grid_));
    }
    void showStereo(walls::Stereo mode) {
        static const walls::Wall kOpened = passiveWall();
        (void)walls::shownOnItsOutputs(kOpened, mode);
    }
    void save(const std::string& name, const Asker& /* asker */) {
        fuzz::require(master::saveFile("out", name).lexically_normal().parent_path() == "out/saves",
                      "a name leads out of the session's folder");
    }
    void load(const std::string& name, const Asker& asker) { save(name, asker); }
    void separateEyes(double metres) {
        fuzz::require(metres >= 0 && metres <= walls::kMaxEyeSeparation, "an eye separation is out of range");
    }
    void shareForce(double share, const Asker& /* asker */) {
        fuzz::require(share >= 0 && share <= 1, "a share of the force is out of range");
    }

private:
    void take(const scene::Material& wanted) {
        sand::Step step;
        step.edit = sand::Edit::tuned(scene::tuningOf(wanted, grid_));
        base::ByteWriter writer;
        step.put(writer);
        base::ByteReader reader(writer.bytes());
        bool same = false;
        try {
            same = base::read<sand::Step>(reader) == step;
        } catch (const base::FormatError&) {
        }
        fuzz::require(same, "a command makes a step that cannot be sent");
        material_ = wanted;
    }

    inline static const scene::MaterialGrid grid_ = samples::flatScene(24, 16).grid();
    scene::Material material_;
};

}  // namespace

SANDWALL_FUZZER(command) {
    FuzzDesk desk;
    std::string_view text = fuzz::textOf({data, size});
    for (std::size_t lines = 0; lines < kMostLines && !text.empty(); ++lines) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, std::min(end, master::kLongestCommand));
        text.remove_prefix(std::min(end + 1, text.size()));
        fuzz::takeOrRefuse([&] { master::carryOut(desk, line, {}); });
    }
    return 0;
}
