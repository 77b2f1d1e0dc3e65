// SPDX-License-Identifier: Apache-2.0
#include "sand/model/step.hpp"

#include <gtest/gtest.h>

#include <random>
#include <span>

#include "tests/support/files/overlong.hpp"
#include "tests/support/sand/relaxing.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace {

base::Bytes bytesOf(const sand::Step& step) {
    base::ByteWriter writer;
    step.put(writer);
    return writer.take();
}

TEST(Step, SurvivesItsEncoding) {
    std::mt19937 random(41);
    for (int i = 0; i < (samples::kSlowBuild ? 100 : 1000); ++i) {
        sand::Step step = samples::randomStep(random(), samples::flatScene(900, 900).rules, random);
        step.epoch = static_cast<std::uint32_t>(random());
        step.sweeps = static_cast<std::int32_t>(random() % (sand::kMostSweeps + 1));
        const base::Bytes bytes = bytesOf(step);
        base::ByteReader reader(bytes);
        ASSERT_EQ(base::read<sand::Step>(reader), step);
        ASSERT_TRUE(reader.atEnd());
    }
}

TEST(Step, EveryEditSurvivesAndNoOtherIsRead) {
    for (int kind = 0; kind < sand::kEdits; ++kind) {
        sand::Edit edit = static_cast<sand::Edit::Kind>(kind);
        if (edit.kind == sand::Edit::tune) {
            edit = sand::Edit::tuned({7, 11, 13, {.radius = 17}});
        } else if (edit.kind == sand::Edit::load) {
            edit = sand::Edit::loaded({3, 1, 4, 1, 5});
        }
        edit.number = edit.any() ? ~std::uint64_t{0} - static_cast<std::uint64_t>(kind) : 0;
        for (const bool engaged : {false, true}) {
            const sand::Step step{1, 2, engaged, {{5, 6, 7}}, edit};
            const base::Bytes bytes = bytesOf(step);
            base::ByteReader reader(bytes);
            EXPECT_EQ(base::read<sand::Step>(reader), step);
        }
    }
    const base::Bytes bytes = bytesOf({1, 2, false, {}, static_cast<sand::Edit::Kind>(sand::kEdits)});
    base::ByteReader reader(bytes);
    EXPECT_THROW((void)base::read<sand::Step>(reader), base::FormatError);
}

// A release that does not know an edit or a tool cannot play its journal. A new one therefore raises the version, and
// its writer puts both numbers here.
TEST(Step, HasTheEditsAndToolsOfThisVersionOfTheAlgorithm) {
    EXPECT_EQ(sand::kEdits, 6);
    EXPECT_EQ(sand::kToolKinds, 6);
    EXPECT_GE(sand::kAlgorithmVersion, 14U) << "the first with so many";
}

TEST(Step, HasOneFormOfEachNumber) {
    const sand::Step step{.epoch = 3,
                          .number = 300,
                          .engaged = true,
                          .path = {{5, -6, 70}, {5, 900, 70}},
                          .edit = samples::withNumber(7, sand::Edit::settle)};
    const int refused = test::widenedNumbers(bytesOf(step), [](const base::Bytes& wide) {
        base::ByteReader reader(wide);
        const auto read = base::read<sand::Step>(reader);
        base::requireEnd(reader);
        return bytesOf(read);
    });
    EXPECT_EQ(refused, 3 + 6 + 1) << "epoch, number and sweeps, two points, and the number of the edit";
}

TEST(Step, WithAPathBeyondTheLimitsIsRefusedByName) {
    const sand::StepLimits limits{1, 4, 8};
    sand::Step step{.number = 7, .engaged = true, .path = {{0, 0, 0}}, .sweeps = 1};
    EXPECT_EQ(step.refusal(limits), "") << "a path of one point, whose way only a replica knows";
    step.path.push_back({8 * sand::kProbePerCell, 0, 0});
    EXPECT_EQ(step.refusal(limits), "");
    step.path.push_back({8 * sand::kProbePerCell, 0, 0});
    EXPECT_EQ(step.refusal(limits), "step 7 has a path of 9 sub-steps; a step of this sand has at most 8")
        << "a press without a way is a sub-step";
    step.engaged = false;
    EXPECT_EQ(step.refusal(limits), "") << "a tool that hovers takes no time of the sand";
}

TEST(Step, WithALoadBeyondTheLimitsIsRefusedByName) {
    sand::StepLimits limits;
    limits.mostSandBytes = 10;
    sand::Step step{.number = 7, .edit = sand::Edit::loaded(base::Bytes(10)), .sweeps = 1};
    EXPECT_EQ(step.refusal(limits), "");
    step.edit = sand::Edit::loaded(base::Bytes(11));
    EXPECT_EQ(step.refusal(limits), "step 7 loads 11 bytes of sand; a step of this sand loads at most 10");
}

// Journals and messages have exactly these bytes.
TEST(Step, TakesTheseBytes) {
    sand::Step step{
        3, 300, true, {{5, -6, 70}}, samples::withNumber(200, sand::Edit::tuned({7, 11, 13, {.radius = 17}}))};
    step.sweeps = 621;  // 0xed, 4
    const base::Bytes expected{3, 0xac, 2, 0xed, 4, 9, 1,  10, 11, 0x8c, 1, 0xc8, 1, 7, 0, 0,    0, 11, 0, 0,
                               0, 13,   0, 0,    0, 0, 17, 0,  0,  0,    0, 0,    0, 0, 0, 0x40, 0, 0,  0};
    EXPECT_EQ(bytesOf(step), expected);
    base::ByteReader reader(expected);
    EXPECT_EQ(base::read<sand::Step>(reader), step);
    step.heading = *sand::headingOf(30, true);
    EXPECT_EQ(bytesOf(step).size(), expected.size() + 5) << "only a step that turns the tool says how";
}

TEST(Step, AHeadingAndEveryToolSurviveAndWhatIsNoneIsRefused) {
    for (int kind = 0; kind < sand::kToolKinds; ++kind) {
        for (const bool mirrored : {false, true}) {
            sand::Tuning tuning{7, 11, 13, {.radius = 2000}};
            tuning.tool.kind = static_cast<sand::ToolKind>(kind);
            tuning.tool.halfWidth = sand::isRound(tuning.tool.kind) ? 0 : 700;
            tuning.tool.heading = *sand::headingOf(77, mirrored);
            sand::Step step{1, 2, true, {{5, 6, 7}}, sand::Edit::tuned(tuning)};
            step.heading = *sand::headingOf(-123, !mirrored);
            const base::Bytes bytes = bytesOf(step);
            base::ByteReader reader(bytes);
            EXPECT_EQ(base::read<sand::Step>(reader), step);
            for (std::size_t length = 0; length < bytes.size(); ++length) {
                base::ByteReader cut{std::span(bytes).first(length)};
                EXPECT_THROW((void)base::read<sand::Step>(cut), base::FormatError) << length;
            }
        }
    }
    const auto refused = [](const sand::Step& step) {
        const base::Bytes bytes = bytesOf(step);
        base::ByteReader reader(bytes);
        EXPECT_THROW((void)base::read<sand::Step>(reader), base::FormatError);
    };
    sand::Step crooked{1, 2, true, {}};
    crooked.heading = sand::Heading{100, 100};
    refused(crooked);
    sand::Tuning wide{7, 11, 13, {sand::ToolKind::ellipse, 17, 18}};
    refused({1, 2, true, {}, sand::Edit::tuned(wide)});
    wide.tool.halfWidth = 3;
    wide.tool.kind = static_cast<sand::ToolKind>(sand::kToolKinds);
    refused({1, 2, true, {}, sand::Edit::tuned(wide)});
}

TEST(Step, SeventeenSamplesOfAHandFitInEightyBytes) {
    sand::Step step{3, 1000000, true, {}};
    for (int i = 0; i < 17; ++i) {  // 1.5 cells in a step of 1/60 s
        step.path.push_back({60000 + 23 * i, 70000 - 11 * i, 512 + i % 3});
    }
    EXPECT_LE(bytesOf(step).size(), 80U);
}

TEST(Step, RefusesEveryTruncation) {
    const base::Bytes bytes = bytesOf({1, 2, true, {{1000, 2000, 3000}, {-5, 7, 9}}});
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        base::ByteReader reader{std::span(bytes).first(length)};
        EXPECT_THROW((void)base::read<sand::Step>(reader), base::FormatError) << length;
    }
}

TEST(Step, RefusesMoreSweepsThanAStepMayRun) {
    sand::Step step{1, 2, true, {{5, 6, 7}}};
    for (const std::int32_t sweeps : {sand::kMostSweeps, sand::kMostSweeps + 1, -1}) {
        step.sweeps = sweeps;
        const base::Bytes bytes = bytesOf(step);
        base::ByteReader reader(bytes);
        if (sweeps == sand::kMostSweeps) {
            EXPECT_EQ(base::read<sand::Step>(reader), step);
        } else {
            EXPECT_THROW((void)base::read<sand::Step>(reader), base::FormatError) << sweeps;
        }
    }
}

TEST(Step, RefusesEveryTruncationOfAnEdit) {
    for (const sand::Edit& edit :
         {sand::Edit::tuned({7, 11, 13, {.radius = 17}}), sand::Edit::loaded({3, 1, 4, 1, 5})}) {
        const base::Bytes bytes = bytesOf({1, 2, true, {{5, 6, 7}}, edit});
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            base::ByteReader reader{std::span(bytes).first(length)};
            EXPECT_THROW((void)base::read<sand::Step>(reader), base::FormatError) << length;
        }
    }
}

TEST(Step, PathInSubstepsLeavesOutPointsThatAreNear) {
    const auto along = [](std::initializer_list<int> places) {
        std::vector<sand::ProbePoint> path;
        for (const int x : places) {
            path.push_back({x, 7, 9});
        }
        return path;
    };
    const auto thinned = [](const std::vector<sand::ProbePoint>& path) { return sand::pathInSubsteps(path, 1000); };
    const std::vector<sand::ProbePoint> cells = along({0, 100, 200, 300});
    EXPECT_EQ(sand::pathInSubsteps(cells, sand::kProbePerCell), cells) << "sub-steps of a cell keep all points";
    EXPECT_EQ(thinned(along({0, 400, 800, 1200, 1600, 2000})), along({0, 800, 1600, 2000}));
    EXPECT_EQ(thinned(along({0, 500, 1000, 1500})), along({0, 1000, 1500}));
    EXPECT_EQ(thinned(along({0, 0, 400, 800})), along({0, 0, 800})) << "a press in place stays";
    EXPECT_EQ(thinned(along({0, 600, 0, 600, 0})), along({0, 600, 0, 600, 0})) << "the length of the path counts";
    EXPECT_EQ(thinned(along({0, 5000, 5001})), along({0, 5000, 5001}));
    EXPECT_EQ(thinned(along({0, 5000})), along({0, 5000}));
    EXPECT_EQ(thinned(along({3})), along({3}));
    EXPECT_EQ(thinned({}), along({}));
    EXPECT_EQ(sand::substepsOf({.engaged = true, .path = along({400, 800, 1200})}, {0, 7, 9}, true, 1000), 2);
    EXPECT_EQ(sand::substepsOf({.engaged = true, .path = along({400, 800, 1200})}, {0, 7, 9}, false, 1000), 2)
        << "a press in place, and a drag";
    EXPECT_EQ(sand::substepsOf({.engaged = true, .path = along({5000})}, {0, 7, 9}, true, 1000), 5);
}

TEST(Step, RefusesAMaterialOrToolThatNoSceneGives) {
    const sand::Tuning good{7, 11, 13, {.radius = 17}};
    const auto refused = [](const sand::Tuning& tuning) {
        const base::Bytes bytes = bytesOf({1, 2, false, {}, sand::Edit::tuned(tuning)});
        base::ByteReader reader(bytes);
        EXPECT_THROW((void)base::read<sand::Step>(reader), base::FormatError);
    };
    const auto with = [&good](const auto& change) {
        sand::Tuning tuning = good;
        change(tuning);
        return tuning;
    };
    for (const std::int32_t bad : {-1, sand::kLargestThreshold + 1}) {
        refused(with([bad](sand::Tuning& tuning) { tuning.threshold = bad; }));
        refused(with([bad](sand::Tuning& tuning) { tuning.startThreshold = bad; }));
        refused(with([bad](sand::Tuning& tuning) { tuning.sweepsPerStep = bad; }));
        refused(with([bad](sand::Tuning& tuning) { tuning.tool.radius = bad; }));
    }
    refused({12, 11, 13, {.radius = 17}});  // the start threshold would be below the threshold
    refused({7, 11, 0, {.radius = 17}});    // a step runs at least one sweep
    refused({7, 11, sand::kMostSweepsToRest + 1, {.radius = 17}});
}

TEST(Step, RefusesPathsTooLongAndPointsOutOfReach) {
    base::Bytes bytes = bytesOf({1, 2, true, {}});
    bytes.back() = sand::kMaxPathPoints + 1;
    base::ByteReader tooLong(bytes);
    EXPECT_THROW((void)base::read<sand::Step>(tooLong), base::FormatError);
    const base::Bytes far = bytesOf({1, 2, true, {{sand::kMaxProbe + 1, 0, 0}}});
    base::ByteReader outOfReach(far);
    EXPECT_THROW((void)base::read<sand::Step>(outOfReach), base::FormatError);
}

}  // namespace
