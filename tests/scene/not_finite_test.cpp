// SPDX-License-Identifier: Apache-2.0
// nan and inf in place of every number of a scene file.
#include "tests/support/files/not_finite_toml.hpp"
#include "tests/support/files/scene_fixture.hpp"

namespace {

class NotFiniteScene : public SceneFile {
protected:
    NotFiniteScene() {
        complain_ = [this](const std::string& text) {
            const std::string line = complaint(text);
            return line.starts_with("s.toml") ? "f" + line.substr(1) : line;
        };
    }
    support::Complain complain_;
};

TEST_F(NotFiniteScene, IsRefusedWithTheLineOfEachNumberOfTheSamples) {
    int samples = 0;
    for (const auto& entry : std::filesystem::directory_iterator(SANDWALL_SOURCE_DIR "/scenes")) {
        SCOPED_TRACE(entry.path().filename().string());
        std::ifstream file(entry.path());
        EXPECT_GE(support::tryEachNumber({std::istreambuf_iterator<char>(file), {}}, complain_), 5);
        ++samples;
    }
    EXPECT_GE(samples, 8);
}

TEST_F(NotFiniteScene, IsRefusedForEveryKeyThatATableKnows) {
    std::set<std::string> tried;
    const std::string rest = "[material]\n[tool]\n[force]\n[look]\n";
    write("t.asc", "ncols 2\nnrows 2\ncellsize 1\n1 2\n3 4\n");
    for (const char* terrain : {"[field]\ncolumns = 8\n[terrain]\n", "[field]\n[terrain]\nkind = \"dunes\"\n",
                                "[terrain]\nkind = \"esri_ascii\"\nfile = \"t.asc\"\n"}) {
        tried.merge(support::tryEachOtherKey(terrain + rest, complain_));
    }
    tried.merge(support::tryEachOtherKey("[field]\n[terrain]\n[tin]\nmax_error = 0.01\n" + rest, complain_));
    for (const char* key : {"[field] width", "[terrain] dune_height", "[terrain] datum", "[material] settling_time",
                            "[tool] heading_deg", "[force] recovery_time", "[tin] spacing"}) {
        EXPECT_TRUE(tried.contains(key)) << key;
    }
}

}  // namespace
