// SPDX-License-Identifier: Apache-2.0
#include "render_node/gl/button_watch.hpp"

#include <gtest/gtest.h>

namespace {

using render_node::ButtonWatch;
using render_node::PointerEvent;
using Kind = PointerEvent::Kind;

constexpr ButtonWatch::Down kLeft{.left = true}, kView{.view = true}, kNone{};

PointerEvent event(Kind kind) { return {kind, 1, {20, 30}, 5}; }

/// Looks at the buttons as often as `downs` says, a pause after each other. Returns the kinds of the lost releases.
std::vector<Kind> lost(ButtonWatch& watch, std::initializer_list<ButtonWatch::Down> downs) {
    static std::int64_t now = 1;
    std::vector<Kind> kinds;
    for (const ButtonWatch::Down& down : downs) {
        now += ButtonWatch::kPause;
        for (const PointerEvent& found : watch.look(down, now)) {
            EXPECT_EQ(found.window, 1);
            EXPECT_EQ(found.at, glm::dvec2(20, 30));
            EXPECT_EQ(found.ns, now);
            kinds.push_back(found.kind);
        }
    }
    return kinds;
}

ButtonWatch following(std::initializer_list<Kind> kinds) {
    ButtonWatch watch;
    for (const Kind kind : kinds) {
        const PointerEvent one = event(kind);
        watch.follow({&one, 1});
    }
    return watch;
}

TEST(ButtonWatch, ReleasesAButtonThatIsUpAtTwoLooks) {
    for (const auto& [press, down, release] : {std::tuple{Kind::press, kLeft, Kind::release},
                                               {Kind::turnPress, kView, Kind::viewRelease},
                                               {Kind::panPress, kView, Kind::viewRelease}}) {
        ButtonWatch watch = following({press});
        EXPECT_EQ(lost(watch, {down, down, kNone}), std::vector<Kind>{}) << "the release may be on its way";
        EXPECT_EQ(lost(watch, {kNone}), std::vector{release});
        EXPECT_EQ(lost(watch, {kNone, kNone}), std::vector<Kind>{}) << "once";
    }
}

TEST(ButtonWatch, LeavesAButtonThatIsHeldAlone) {
    ButtonWatch watch = following({Kind::press, Kind::move});
    EXPECT_EQ(lost(watch, {kLeft, kLeft, kLeft, kNone, kLeft, kNone, kLeft}), std::vector<Kind>{});
}

TEST(ButtonWatch, AddsNothingToAReleaseThatHasCome) {
    ButtonWatch watch = following({Kind::press});
    EXPECT_EQ(lost(watch, {kLeft, kNone}), std::vector<Kind>{});
    const PointerEvent release = event(Kind::release);
    watch.follow({&release, 1});
    EXPECT_EQ(lost(watch, {kNone, kNone}), std::vector<Kind>{});
}

TEST(ButtonWatch, KnowsTheNextPressFromTheOneBefore) {
    ButtonWatch watch = following({Kind::press});
    EXPECT_EQ(lost(watch, {kLeft, kNone}), std::vector<Kind>{});
    for (const Kind kind : {Kind::release, Kind::press}) {
        const PointerEvent one = event(kind);
        watch.follow({&one, 1});
    }
    EXPECT_EQ(lost(watch, {kNone, kNone, kNone}), std::vector<Kind>{}) << "a program has sent the second one";
    EXPECT_EQ(lost(watch, {kLeft, kNone, kNone}), std::vector{Kind::release});
}

TEST(ButtonWatch, LooksAtOncePerPressAndThenInPauses) {
    ButtonWatch watch;
    EXPECT_FALSE(watch.due(ButtonWatch::kPause)) << "nothing is held";
    watch = following({Kind::press});
    EXPECT_TRUE(watch.due(1));
    (void)watch.look(kLeft, 1);
    EXPECT_FALSE(watch.due(ButtonWatch::kPause));
    EXPECT_TRUE(watch.due(1 + ButtonWatch::kPause));
    const PointerEvent second = event(Kind::turnPress);
    watch.follow({&second, 1});
    EXPECT_TRUE(watch.due(2));
    (void)watch.look({true, true}, 2);
    for (const Kind kind : {Kind::release, Kind::viewRelease}) {
        const PointerEvent one = event(kind);
        watch.follow({&one, 1});
    }
    EXPECT_FALSE(watch.due(10 * ButtonWatch::kPause));
}

}  // namespace
