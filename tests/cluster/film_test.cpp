// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "pictures/png_file.hpp"
#include "pictures/stereo_packing.hpp"
#include "tests/cluster/session_fixture.hpp"

namespace {

constexpr int kSteps = 91;  // odd, so that the last frame of a film at half the rate shows one step instead of two

/// A session on a wall of two passive tiles, and films of its journal.
class Film : public SessionTest {
protected:
    void record(const std::string& wallFile) {
        const Ended ended = runToEnd({"--wall", wallFile, "--scene", scene(), "--device", "script:gis", "--pace",
                                      "fast", "--steps", std::to_string(kSteps), "--out", out()},
                                     300);
        ASSERT_EQ(ended.status, 0) << ended.output;
    }
    Ended film(const std::string& wallFile, const std::vector<std::string>& options) {
        std::vector<std::string> command{"/usr/bin/env", "-u",
                                         "DISPLAY",      SANDWALL_SOURCE_DIR "/scripts/sandwall",
                                         "film",         journal(),
                                         "--wall",       wallFile,
                                         "--out",        (folder_ / "film").string()};
        command.insert(command.end(), options.begin(), options.end());
        support::ChildProcess process(command, folder_ / "film.txt");
        const std::optional<int> status = process.wait(300);
        EXPECT_TRUE(status.has_value()) << process.output();
        return {status.value_or(-1), process.output()};
    }
    [[nodiscard]] std::string journal() const { return out() + "/session.journal"; }
    [[nodiscard]] nlohmann::json filmSummary() const { return nlohmann::json::parse(read("film/summary.json")); }
    [[nodiscard]] std::string frame(int number) const {
        return (folder_ / "film" / fmt::format("frame_{:06}.png", number)).string();
    }
    [[nodiscard]] int frames() const {
        int count = 0;
        while (std::filesystem::exists(frame(count + 1))) {
            ++count;
        }
        return count;
    }
    [[nodiscard]] pictures::Image live(const std::string& name) const {
        return pictures::readPng(folder_ / "out" / name);
    }
    /// The last picture of a film and that of the wall are equal to the byte, and neither is of one colour.
    void expectLast(int number, const pictures::Image& expected, const std::string& what) const {
        const pictures::Image shown = pictures::readPng(frame(number));
        ASSERT_EQ(shown.width, expected.width) << what;
        ASSERT_EQ(shown.height, expected.height) << what;
        EXPECT_TRUE(shown.rgb == expected.rgb) << what << ": " << frame(number);
        EXPECT_FALSE(std::all_of(shown.rgb.begin() + 3, shown.rgb.end(),
                                 [&](std::uint8_t byte) { return byte == shown.rgb[3]; }));
    }
    void expectRefused(const Ended& ended, const std::string& line) const {
        EXPECT_EQ(ended.status, 2) << ended.output;
        EXPECT_NE(ended.output.find(line), std::string::npos) << ended.output;
        EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << ended.output;
    }
};

TEST_F(Film, EndsInTheSessionsSandAndItsPicture) {
    const std::string passive = wall(1, 2);
    record(passive);
    const pictures::Image left = live("wall_left.png");
    const pictures::Image right = live("wall_right.png");
    struct Way {
        std::vector<std::string> options;
        pictures::Image expected;
    };
    using walls::Stereo;
    const std::vector<Way> ways{
        {{"--stereo", "anaglyph"}, live("wall_anaglyph.png")},
        {{"--stereo", "side_by_side"}, pictures::packStereo(Stereo::sideBySide, left, right)},
        {{}, left},
        {{"--eye", "right"}, right},
        {{"--eye", "anaglyph"}, live("wall_anaglyph.png")},
    };
    for (const Way& way : ways) {
        const std::string what = way.options.empty() ? "as the wall file says" : way.options.back();
        const Ended ended = film(passive, way.options);
        ASSERT_EQ(ended.status, 0) << what << "\n" << ended.output;
        EXPECT_EQ(frames(), 46) << what;  // 91 steps of 1/60 s in frames of 1/30 s
        EXPECT_EQ(filmSummary()["frames"], 46);
        EXPECT_EQ(filmSummary()["steps"], kSteps);
        EXPECT_EQ(filmSummary()["divergences"], 0);
        EXPECT_EQ(filmSummary()["state_hash"], summary()["state_hash"]) << what;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "film" / "session.journal"));
        expectLast(46, way.expected, what);
    }
}

TEST_F(Film, ShowsASessionOnAnyOtherWallAtAnyRate) {
    record(wall(1, 2));
    const std::string hash = summary()["state_hash"];
    // The picture that a session leaves on the other wall is that of a film of it.
    const std::string other = wall(1, 1, "side_by_side");
    const Ended ended = film(other, {"--fps", "7"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_EQ(frames(), 11);  // 91 / 60 * 7 = 10.6
    EXPECT_EQ(filmSummary()["state_hash"], hash);
    record(other);
    ASSERT_EQ(summary()["state_hash"], hash) << "a script moves the same hand in every fast session";
    expectLast(11, live("tile_r1c1_output.png"), "one tile's output");
}

TEST_F(Film, LeavesNothingOfALongerFilmBefore) {
    const std::string mono = wall(1, 1, "mono");
    record(mono);
    std::filesystem::create_directories(folder_ / "film");
    write("film/frame_000047.png", "of a film before");
    write("film/frame_mine.png", "of the user");
    ASSERT_EQ(film(mono, {}).status, 0);
    EXPECT_FALSE(std::filesystem::exists(frame(47)));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "film" / "frame_mine.png"));
    expectLast(46, live("wall.png"), "mono");
}

TEST_F(Film, ATruncatedJournalIsShownToItsLastWholeRecord) {
    const std::string mono = wall(1, 1, "mono");
    record(mono);
    std::filesystem::resize_file(journal(), std::filesystem::file_size(journal()) - 40);
    const Ended ended = film(mono, {});
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_NE(ended.output.find("bytes are no whole record and were left out; it ends at step"), std::string::npos)
        << ended.output;
    const int steps = filmSummary()["steps"];
    EXPECT_LT(steps, kSteps);
    EXPECT_GE(steps, kSteps - 4);  // a record of a fast session holds at most four
    EXPECT_EQ(frames(), (steps + 1) / 2);
}

TEST_F(Film, RefusesADamagedJournalInOneLine) {
    const std::string mono = wall(1, 1, "mono");
    record(mono);
    const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(journal()) * 3 / 4);
    std::fstream stream(journal(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(middle);
    const int before = stream.get();
    stream.seekp(middle);
    stream.put(static_cast<char>(before ^ 1));
    stream.close();
    expectRefused(film(mono, {}), "damaged at byte");
    EXPECT_EQ(frames(), 0);
}

TEST_F(Film, RefusesWhatCannotBeFilmedInOneLine) {
    const std::string mono = wall(1, 1, "mono");
    record(mono);
    expectRefused(film(mono, {"--eye", "left"}), "draws one eye alone; choose another --stereo");
    expectRefused(film(mono, {"--fps", "0"}), "--fps");
    expectRefused(film(mono, {"--out", out()}), "holds a session, whose results would be lost; choose another --out");
    const std::string file = write("file", "in the way");
    expectRefused(film(mono, {"--out", file}), file + ": cannot be made");
    std::filesystem::remove(journal());
    expectRefused(film(mono, {}), "session.journal: cannot be read; check the path");
}

TEST_F(Film, APictureThatCannotBeWrittenEndsIt) {
    const std::string mono = wall(1, 1, "mono");
    record(mono);
    std::filesystem::create_directories(folder_ / "film" / "frame_000003.png" / "in the way");
    const Ended ended = film(mono, {});
    EXPECT_EQ(ended.status, 2) << ended.output;
    EXPECT_NE(ended.output.find("frame_000003.png: picture cannot be written"), std::string::npos) << ended.output;
    EXPECT_FALSE(std::filesystem::exists(frame(4)));
}

}  // namespace
