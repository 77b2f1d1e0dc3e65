// SPDX-License-Identifier: Apache-2.0
#include "master/journal/saved_sand.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/input_error.hpp"
#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/blocked_child.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

using master::SandPlace;
using master::SavedSand;

class SavedSandFile : public test::FolderTest {
protected:
    [[nodiscard]] SavedSand sand() const {
        sand::Replica replica(scene_);
        replica.apply({1, 1, true, {{8000, 8000, 0}}, sand::Edit::none});
        return {SandPlace::of(scene_), 1, replica.stateHash(), replica.copySand()->encode()};
    }
    [[nodiscard]] std::string complaint(const scene::Scene& scene) const {
        try {
            (void)master::readSavedSand(file_, SandPlace::of(scene), sand::Replica(scene).sandReader());
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "nothing";
    }
    void expectComplaint(const scene::Scene& scene, const std::string& part) const {
        const std::string said = complaint(scene);
        EXPECT_NE(said.find(part), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
        EXPECT_EQ(said.find(file_.string()), 0U) << said;
    }
    scene::Scene scene_ = samples::flatScene(64, 48);
    const std::filesystem::path file_ = master::saveFile(folder_, "dug");
};

TEST_F(SavedSandFile, GivesBackWhatWasSavedAndLeavesNothingBeside) {
    const SavedSand saved = sand();
    for (int i = 0; i < 2; ++i) {  // the second file replaces the first
        master::writeSavedSand(file_, saved);
    }
    const SavedSand read = master::readSavedSand(file_, SandPlace::of(scene_), sand::Replica(scene_).sandReader());
    EXPECT_EQ(read.sand, saved.sand);
    EXPECT_EQ(read.step, 1U);
    EXPECT_EQ(read.stateHash, saved.stateHash);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "saves"), {}), 1);
}

TEST_F(SavedSandFile, APipeIsRefusedWithoutWaitingForItsWriter) {
    std::filesystem::create_directory(folder_ / "saves");
    support::makePipe(file_);
    EXPECT_TRUE(
        support::endsByItself([this] { expectComplaint(scene_, "is not a regular file; nothing was loaded"); }));
    EXPECT_TRUE(
        support::endsByItself([this] { EXPECT_THROW(master::writeSavedSand(file_, sand()), base::InputError); }));
    EXPECT_TRUE(std::filesystem::is_fifo(file_)) << "the pipe was replaced";
}

TEST_F(SavedSandFile, IsNeitherWrittenNorReadThroughALink) {
    master::writeSavedSand(folder_ / "other", sand());
    const auto before = std::filesystem::last_write_time(folder_ / "other");
    std::filesystem::create_directory(folder_ / "saves");
    std::filesystem::create_symlink(folder_ / "other", file_);
    expectComplaint(scene_, "is a link, which is not followed; nothing was loaded");
    EXPECT_THROW(master::writeSavedSand(file_, sand()), base::InputError);
    EXPECT_EQ(std::filesystem::last_write_time(folder_ / "other"), before);
}

TEST_F(SavedSandFile, IsWrittenWhereAKilledSessionLeftAPipeOrLink) {
    const auto other = folder_ / "other";
    std::ofstream(other) << "of another program";
    std::filesystem::create_directory(folder_ / "saves");
    // Each process counts its saves, so the names of its unfinished files begin at 1. Earlier tests may have saved too.
    for (int number = 1; number <= 64; ++number) {
        const auto half = file_.string() + "." + std::to_string(number) + ".part";
        if (number % 2 == 0) {
            support::makePipe(half);
        } else {
            std::filesystem::create_symlink(other, half);
        }
    }
    EXPECT_TRUE(support::endsByItself([this] {
        for (int turn = 0; turn < 2; ++turn) {
            master::writeSavedSand(file_, sand());
        }
    }));
    EXPECT_EQ(complaint(scene_), "nothing");
    EXPECT_EQ(std::filesystem::file_size(other), 18U) << "the link was followed";
}

TEST_F(SavedSandFile, AnyByteThatChangedAndAnyThatIsMissingIsFound) {
    master::writeSavedSand(file_, sand());
    const auto size = std::filesystem::file_size(file_);
    for (std::uintmax_t at = 0; at < size; at += 7) {
        std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
        stream.seekg(static_cast<std::streamoff>(at));
        const char was = static_cast<char>(stream.get());
        stream.seekp(static_cast<std::streamoff>(at));
        stream.put(static_cast<char>(was ^ 4)).flush();
        expectComplaint(scene_, "nothing was loaded");
        stream.seekp(static_cast<std::streamoff>(at));
        stream.put(was);
    }
    EXPECT_EQ(complaint(scene_), "nothing");
    for (std::uintmax_t cut = size; cut-- > 0;) {
        std::filesystem::resize_file(file_, cut);
        expectComplaint(scene_, "nothing was loaded");
    }
}

TEST_F(SavedSandFile, OfAnotherSceneIsRefusedWithWhatDiffers) {
    master::writeSavedSand(file_, sand());
    scene::Scene other = scene_;
    other.name = "dunes";
    expectComplaint(other, "sand of scene 'flat', and this is 'dunes'");
    expectComplaint(samples::flatScene(48, 64), "sand of 64 x 48 cells, and the scene has 48 x 64");
    other = scene_;
    other.rules.ground = 7;
    expectComplaint(other, "with other cells or other rock");
}

// Sand that was saved can be loaded again, up to the limit of a step of this field.
TEST_F(SavedSandFile, IsBoundedByTheLimitOfALoad) {
    SavedSand saved = sand();
    saved.place.mostBytes = static_cast<std::int64_t>(saved.sand.size());
    master::writeSavedSand(file_, saved);
    const auto read = sand::Replica(scene_).sandReader();
    EXPECT_EQ(master::readSavedSand(file_, saved.place, read).sand, saved.sand);
    --saved.place.mostBytes;
    try {
        master::writeSavedSand(file_, saved);
        ADD_FAILURE() << "written";
    } catch (const base::InputError& error) {
        EXPECT_NE(std::string(error.what()).find(" bytes of sand could not be loaded again, "), std::string::npos)
            << error.what();
    }
    saved.place.mostBytes = 0;
    std::filesystem::resize_file(file_, 1 << 20);
    EXPECT_THROW((void)master::readSavedSand(file_, saved.place, read), base::InputError);
    EXPECT_EQ(SandPlace::of(scene_).mostBytes, scene_.rules.stepLimits().mostSandBytes);
}

TEST_F(SavedSandFile, ThatIsNotThereOrCannotBeMadeIsOneLine) {
    expectComplaint(scene_, "No such file or directory; nothing was loaded");
    std::ofstream(folder_ / "saves") << "no folder";
    EXPECT_THROW(master::writeSavedSand(file_, sand()), base::InputError);
    expectComplaint(scene_, "Not a directory; nothing was loaded");
}

TEST(SaveName, LeadsNowhereElse) {
    for (const char* good : {"a", "Dug_2-b", "0"}) {
        EXPECT_TRUE(master::isSaveName(good)) << good;
    }
    for (const std::string bad : {"", ".", "..", "../x", "a/b", "a.sand", "a b", "\xc3\xa4"}) {
        EXPECT_FALSE(master::isSaveName(bad)) << bad;
    }
    EXPECT_FALSE(master::isSaveName(std::string(65, 'a')));
    EXPECT_FALSE(master::isSaveName(std::string_view("a\0b", 3)));
}

}  // namespace
