// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "pictures/png_file.hpp"
#include "pictures/stereo_packing.hpp"
#include "tests/cluster/session_fixture.hpp"

namespace {

constexpr int kSteps = 91;  // odd, so that the last frame of a film at half the rate shows one step instead of two

/// Films of the journal of one session, which all tests share. Its wall has two passive tiles.
class Film : public SessionTest {
protected:
    static void TearDownTestSuite() {
        std::error_code ignored;
        std::filesystem::remove_all(recorded_, ignored);
    }
    void SetUp() override {
        if (recorded_.empty()) {
            recorded_ = test::newFolder();
            record(wall(1, 2), recorded_);
        }
    }
    void record(const std::string& wallFile, const std::filesystem::path& folder) {
        const Ended ended = runToEnd({"--wall", wallFile, "--scene", scene(), "--device", "script:gis", "--pace",
                                      "fast", "--steps", std::to_string(kSteps), "--out", folder.string()});
        ASSERT_EQ(ended.status, 0) << ended.output;
    }
    Ended film(const std::string& wallFile, const std::vector<std::string>& options) const {
        return filmOf(recorded_ / "session.journal", wallFile, options);
    }
    [[nodiscard]] Ended filmOf(const std::filesystem::path& journal, const std::string& wallFile,
                               const std::vector<std::string>& options) const {
        std::vector<std::string> command{"/usr/bin/env",
                                         "-u",
                                         "DISPLAY",
                                         "OMPI_MCA_odls_base_sigkill_timeout=0",
                                         support::launcher(),
                                         "film",
                                         journal.string(),
                                         "--wall",
                                         wallFile,
                                         "--out",
                                         (folder_ / "film").string()};
        command.insert(command.end(), options.begin(), options.end());
        support::ChildProcess process(command, folder_ / "film.txt");
        const std::optional<int> status = process.wait(300);
        EXPECT_TRUE(status.has_value()) << process.output();
        return {status.value_or(-1), process.output()};
    }
    /// Returns the path of a copy of the journal, which the test may damage.
    [[nodiscard]] std::filesystem::path journalCopy() const {
        std::filesystem::copy_file(recorded_ / "session.journal", folder_ / "session.journal");
        return folder_ / "session.journal";
    }
    [[nodiscard]] static std::string hashOfSession() {
        return nlohmann::json::parse(std::ifstream(recorded_ / "summary.json"))["state_hash"];
    }
    [[nodiscard]] nlohmann::json filmSummary() const { return json("film/summary.json"); }
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
    [[nodiscard]] static pictures::Image live(const std::string& name) { return pictures::readPng(recorded_ / name); }
    /// The last picture of a film must equal the picture `expected` of the wall in every byte. The picture must have
    /// more than one colour.
    void expectLast(int number, const pictures::Image& expected, const std::string& what) const {
        const pictures::Image shown = pictures::readPng(frame(number));
        ASSERT_EQ(shown.width, expected.width) << what;
        ASSERT_EQ(shown.height, expected.height) << what;
        EXPECT_TRUE(shown.rgb == expected.rgb) << what << ": " << frame(number);
        EXPECT_FALSE(std::all_of(shown.rgb.begin() + 3, shown.rgb.end(),
                                 [&](std::uint8_t byte) { return byte == shown.rgb[3]; }));
    }

    static inline std::filesystem::path recorded_;  // the --out folder of the session
};

TEST_F(Film, EndsInTheSessionsSandAndItsPicture) {
    const std::string passive = wall(1, 2);
    const pictures::Image left = live("wall_left.png");
    const pictures::Image right = live("wall_right.png");
    struct Way {
        std::vector<std::string> options;
        int frames;
        pictures::Image expected;
    };
    const std::vector<Way> ways{
        {{}, 46, left},  // 91 steps of 1/60 s in frames of 1/30 s
        {{"--fps", "4", "--stereo", "side_by_side"}, 7, pictures::packStereo(walls::Stereo::sideBySide, left, right)},
        {{"--fps", "4", "--eye", "anaglyph"}, 7, live("wall_anaglyph.png")},
    };
    for (const Way& way : ways) {
        const std::string what = way.options.empty() ? "as the wall file says" : way.options.back();
        std::filesystem::remove_all(folder_ / "film");
        const Ended ended = film(passive, way.options);
        ASSERT_EQ(ended.status, 0) << what << "\n" << ended.output;
        EXPECT_EQ(frames(), way.frames) << what;
        EXPECT_EQ(filmSummary()["frames"], way.frames);
        EXPECT_EQ(filmSummary()["steps"], kSteps);
        EXPECT_EQ(filmSummary()["divergences"], 0);
        EXPECT_EQ(filmSummary()["state_hash"], hashOfSession()) << what;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "film" / "session.journal"));
        expectLast(way.frames, way.expected, what);
    }
}

// The folder already has a longer film and a file of the user.
TEST_F(Film, ShowsASessionOnAnyOtherWallAtAnyRate) {
    std::filesystem::create_directories(folder_ / "film");
    write("film/frame_000012.png", "of a film before");
    write("film/frame_mine.png", "of the user");
    // A session on the other wall must end with the same picture as the film on that wall.
    const std::string other = wall(1, 1, "side_by_side");
    const Ended ended = film(other, {"--fps", "7"});
    ASSERT_EQ(ended.status, 0) << ended.output;
    EXPECT_EQ(frames(), 11);  // 91 / 60 * 7 = 10.6
    EXPECT_EQ(filmSummary()["state_hash"], hashOfSession());
    EXPECT_TRUE(std::filesystem::exists(folder_ / "film" / "frame_mine.png"));
    record(other, out());
    ASSERT_EQ(summary()["state_hash"], hashOfSession()) << "the same script led to other sand in a second fast session";
    expectLast(11, pictures::readPng(folder_ / "out" / "tile_r1c1_output.png"), "one tile's output");
}

TEST_F(Film, ATruncatedJournalIsShownToItsLastWholeRecord) {
    const std::filesystem::path journal = journalCopy();
    std::filesystem::resize_file(journal, std::filesystem::file_size(journal) - 40);
    const Ended ended = filmOf(journal, wall(1, 1, "mono"), {"--fps", "6"});
    EXPECT_EQ(ended.status, 0) << ended.output;
    const int steps = filmSummary()["steps"];
    EXPECT_LT(steps, kSteps);
    EXPECT_GE(steps, kSteps - 4);  // a record of a fast session holds at most four steps
    EXPECT_EQ(frames(), (steps + 9) / 10);
}

// One journal that cannot be filmed. tests/master/pictures/film_test.cpp and tests/scripts/launcher/film_test.py test
// the other refusals.
TEST_F(Film, RefusesADamagedJournalInOneLine) {
    const std::filesystem::path journal = journalCopy();
    const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(journal) * 3 / 4);
    std::fstream stream(journal, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(middle);
    const int before = stream.get();
    stream.seekp(middle);
    stream.put(static_cast<char>(before ^ 1));
    stream.close();
    expectOneLine(filmOf(journal, wall(1, 1, "mono"), {}), journal.string());
    EXPECT_EQ(frames(), 0);
}

TEST_F(Film, LeavesTheFolderOfASessionAlone) {
    expectOneLine(film(wall(1, 1, "mono"), {"--out", recorded_.string()}), recorded_.string());
    EXPECT_FALSE(std::filesystem::exists(recorded_ / "frame_000001.png"));
    EXPECT_FALSE(hashOfSession().empty());
}

TEST_F(Film, APictureThatCannotBeWrittenEndsIt) {
    std::filesystem::create_directories(folder_ / "film" / "frame_000003.png" / "in the way");
    const Ended ended = film(wall(1, 1, "mono"), {});
    EXPECT_EQ(ended.status, 2) << ended.output;
    EXPECT_NE(ended.output.find("frame_000003.png"), std::string::npos) << ended.output;
    EXPECT_FALSE(std::filesystem::exists(frame(4)));
}

}  // namespace
