// SPDX-License-Identifier: Apache-2.0
#include "master/pictures/film.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/input_error.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

using master::Film;
using master::FilmEye;
using walls::Stereo;

class FilmOfAWall : public test::FolderTest {
protected:
    [[nodiscard]] std::string complaint(Stereo stereo, std::optional<FilmEye> eye) const {
        const walls::Wall wall =
            walls::shownIn(walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/anaglyph.toml"), stereo);
        try {
            const Film film(wall, eye, folder_);
        } catch (const base::InputError& error) {
            return error.what();
        }
        return "accepted";
    }
};

TEST_F(FilmOfAWall, ShowsAnEyeOnlyWhereTwoAreDrawn) {
    for (const FilmEye eye : {FilmEye::left, FilmEye::right, FilmEye::anaglyph}) {
        EXPECT_EQ(complaint(Stereo::passive, eye), "accepted");
        EXPECT_EQ(complaint(Stereo::anaglyphColour, eye), "accepted");
        const std::string refusal = complaint(Stereo::mono, eye);
        EXPECT_NE(refusal.find("draws one eye alone; choose another --stereo"), std::string::npos) << refusal;
    }
    EXPECT_EQ(complaint(Stereo::mono, std::nullopt), "accepted");
}

TEST_F(FilmOfAWall, ForgetsThePicturesOfAnEarlierFilmAndNoOtherFiles) {
    for (const char* name : {"frame_000001.png", "frame_000047.png", "frame_mine.png", "mine.png"}) {
        std::ofstream(folder_ / name) << "a picture";
    }
    Film::forget(folder_);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "frame_000001.png"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "frame_000047.png"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "frame_mine.png"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "mine.png"));
}

}  // namespace
