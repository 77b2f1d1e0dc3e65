// SPDX-License-Identifier: Apache-2.0
// Simulated hardware: a driver's extension tables and a counter of retraces.
#include "render_node/gl/swap_sync.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>

#include "render_node/gl/eye_target.hpp"
#include "render_node/gl/part_copy.hpp"
#include "render_node/gl/window_context.hpp"

namespace {

using render_node::BackBuffer;
using render_node::EyesByRetrace;
using render_node::GlxDrawable;
using render_node::GlxLoader;
using render_node::PartCopy;
using render_node::SwapGroup;

/// Simulated driver. Its functions are plain pointers, so that all tests share one driver. Each test resets it.
struct FakeDriver {
    std::string extensions;
    unsigned groups = 1, barriers = 1;
    GlxDrawable refused = 0;                // window that cannot join
    std::map<GlxDrawable, unsigned> group;  // group of each window that has joined
    unsigned barrier = 0;
    std::int64_t msc = 0;  // retraces so far
    bool counting = true;
    std::array<std::int64_t, 3> wanted{};  // target, divisor, remainder of the last swap
    unsigned accelerated = 0;              // 1: draws with a graphics card
    std::array<int, 4> copied{};           // x, y, width, height of the last partial copy
};
FakeDriver driver;

int queryMost(void* /* display */, int /* screen */, unsigned* groups, unsigned* barriers) {
    *groups = driver.groups;
    *barriers = driver.barriers;
    return 1;
}
int joinGroup(void* /* display */, GlxDrawable window, unsigned group) {
    if (window == driver.refused) {
        return 0;
    }
    driver.group[window] = group;
    return 1;
}
int bindBarrier(void* /* display */, unsigned /* group */, unsigned barrier) {
    driver.barrier = barrier;
    return 1;
}
int syncValues(void* /* display */, GlxDrawable /* window */, std::int64_t* ust, std::int64_t* msc, std::int64_t* sbc) {
    *ust = *sbc = 0;
    *msc = driver.msc;
    return driver.counting ? 1 : 0;
}
/// Waits for the next retrace with the remainder, as the specification requires.
std::int64_t swapAt(void* /* display */, GlxDrawable /* window */, std::int64_t target, std::int64_t divisor,
                    std::int64_t remainder) {
    driver.wanted = {target, divisor, remainder};
    do {
        ++driver.msc;
    } while (driver.msc % divisor != remainder);
    return 1;
}

int queryRenderer(int attribute, unsigned* value) {
    constexpr int kAccelerated = 0x8186;  // from the specification of GLX_MESA_query_renderer
    *value = driver.accelerated;
    return attribute == kAccelerated ? 1 : 0;
}
void copySubBuffer(void* /* display */, GlxDrawable /* window */, int x, int y, int width, int height) {
    driver.copied = {x, y, width, height};
}

GlxLoader loader() {
    using Function = void (*)();
    return {[](const char* name) { return driver.extensions.find(name) != std::string::npos; },
            [](const char* name) -> Function {
                const std::map<std::string, Function> table{
                    {"glXQueryMaxSwapGroupsNV", reinterpret_cast<Function>(queryMost)},
                    {"glXJoinSwapGroupNV", reinterpret_cast<Function>(joinGroup)},
                    {"glXBindSwapBarrierNV", reinterpret_cast<Function>(bindBarrier)},
                    {"glXGetSyncValuesOML", reinterpret_cast<Function>(syncValues)},
                    {"glXSwapBuffersMscOML", reinterpret_cast<Function>(swapAt)},
                    {"glXQueryCurrentRendererIntegerMESA", reinterpret_cast<Function>(queryRenderer)},
                    {"glXCopySubBufferMESA", reinterpret_cast<Function>(copySubBuffer)}};
                return table.at(name);
            },
            nullptr, 0};
}

class SwapSync : public testing::Test {
protected:
    void SetUp() override {
        driver = {};
        driver.extensions = "GLX_NV_swap_group GLX_OML_sync_control";
    }
};

TEST_F(SwapSync, JoinsAllWindowsAndTheBarrierAndLeavesThem) {
    {
        const SwapGroup group(loader(), {11, 12});
        EXPECT_EQ(group.state(), "joined");
        EXPECT_TRUE(group.joined());
        EXPECT_EQ(group.framesToIgnore(), 8);
        EXPECT_EQ(driver.group, (std::map<GlxDrawable, unsigned>{{11, 1}, {12, 1}}));
        EXPECT_EQ(driver.barrier, 1U);
    }
    EXPECT_EQ(driver.group, (std::map<GlxDrawable, unsigned>{{11, 0}, {12, 0}}));
    EXPECT_EQ(driver.barrier, 0U);
}

TEST_F(SwapSync, CountsEveryFrameWithoutAHardwareBarrier) {
    driver.barriers = 0;
    const SwapGroup group(loader(), {11});
    EXPECT_EQ(group.state(), "joined, no barrier");
    EXPECT_TRUE(group.joined());
    EXPECT_EQ(group.framesToIgnore(), 0);
}

TEST_F(SwapSync, LeavesTheGroupWhenOneWindowIsRefused) {
    driver.refused = 12;
    const SwapGroup group(loader(), {11, 12});
    EXPECT_EQ(group.state(), "refused");
    EXPECT_FALSE(group.joined());
    EXPECT_EQ(driver.group[11], 0U);
    EXPECT_EQ(driver.barrier, 0U);
}

TEST_F(SwapSync, AsksNothingOfADriverWithoutTheExtension) {
    driver.extensions = "GLX_OML_sync_control";
    EXPECT_EQ(SwapGroup(loader(), {11}).state(), "no extension");
    driver.extensions = "";
    EyesByRetrace eyes(loader(), 11);
    EXPECT_FALSE(eyes.available());
    EXPECT_FALSE(eyes.swap(0));
    EXPECT_TRUE(driver.group.empty());
}

TEST_F(SwapSync, RefusesWhereTheDriverHasNoGroups) {
    driver.groups = 0;
    EXPECT_EQ(SwapGroup(loader(), {11}).state(), "refused");
}

TEST_F(SwapSync, KeepsEachEyeOnItsRetracesWhenSomeAreMissed) {
    for (const std::int64_t first : {1000, 1001}) {
        driver.msc = first;
        EyesByRetrace eyes(loader(), 11);
        ASSERT_TRUE(eyes.available());
        ASSERT_TRUE(eyes.swap(6));
        const std::int64_t leftParity = driver.msc % 2;
        EXPECT_EQ(driver.msc, first + 1) << "the first frame waits only for the next retrace";
        std::uint64_t frame = 6;
        for (const int missed : {0, 0, 1, 0, 2, 3, 0, 1, 1}) {
            driver.msc += missed;
            ASSERT_TRUE(eyes.swap(++frame));
            const std::int64_t wanted = frame % 2 == 0 ? leftParity : 1 - leftParity;
            EXPECT_EQ(driver.msc % 2, wanted) << "frame " << frame;
        }
    }
}

TEST_F(SwapSync, StartsWithEitherEye) {
    driver.msc = 7;
    EyesByRetrace eyes(loader(), 11);
    ASSERT_TRUE(eyes.swap(3));
    EXPECT_EQ(driver.msc, 8);
    ASSERT_TRUE(eyes.swap(4));
    EXPECT_EQ(driver.msc, 9);
}

TEST_F(SwapSync, LeavesTheSwapToOthersWhereNothingIsCounted) {
    driver.counting = false;
    EyesByRetrace eyes(loader(), 11);
    EXPECT_FALSE(eyes.available());
    EXPECT_FALSE(eyes.swap(0));
    EXPECT_EQ(driver.msc, 0);
}

TEST_F(SwapSync, CopiesPartsOnlyForASoftwareRendererThatCan) {
    const std::string both = "GLX_MESA_copy_sub_buffer GLX_MESA_query_renderer";
    driver.extensions = both;
    const PartCopy software(loader(), 11);
    ASSERT_TRUE(software.available());
    software.show({3, 5, 10, 25});
    EXPECT_EQ(driver.copied, (std::array{3, 5, 7, 20}));
    driver.accelerated = 1;
    EXPECT_FALSE(PartCopy(loader(), 11).available());
    driver.accelerated = 0;
    for (const char* only : {"GLX_MESA_copy_sub_buffer", "GLX_MESA_query_renderer", ""}) {
        driver.extensions = only;
        EXPECT_FALSE(PartCopy(loader(), 11).available()) << only;
    }
}

TEST(OutputPictures, FillBothQuadBuffersInEveryFrame) {
    // Only the addresses of the pictures are used.
    const auto* left = reinterpret_cast<const render_node::EyeTarget*>(&driver);
    const auto* right = reinterpret_cast<const render_node::EyeTarget*>(&driver.msc);
    for (const std::uint64_t frame : {0U, 1U}) {
        EXPECT_EQ(render_node::copiesOf({left, right}, true, frame),
                  (std::vector<render_node::Copy>{{left, BackBuffer::left}, {right, BackBuffer::right}}));
    }
    EXPECT_EQ(render_node::copiesOf({left, right}, false, 4), (std::vector<render_node::Copy>{{left}}));
    EXPECT_EQ(render_node::copiesOf({left, right}, false, 5), (std::vector<render_node::Copy>{{right}}));
    for (const bool quad : {false, true}) {
        EXPECT_EQ(render_node::copiesOf({left, nullptr}, quad, 5), (std::vector<render_node::Copy>{{left}}));
    }
}

TEST(PlatformRequest, AsksForTheWallsRefreshRateOfEveryScreenOfTheCave) {
    const walls::Wall cave = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/flex_cave.toml");
    ASSERT_EQ(cave.tiles.size(), 4U);
    for (const walls::Tile& tile : cave.tiles) {
        const render_node::PlatformRequest request =
            render_node::platformRequest(render_node::Backend::glfw, cave, tile);
        EXPECT_TRUE(request.eyesInTurn) << tile.name;
        EXPECT_EQ(request.refreshHz, 120) << tile.name;
        ASSERT_EQ(request.windows.size(), 1U) << tile.name;
        EXPECT_EQ(request.windows[0].pixels, tile.pixels) << "one eye's size: the eyes are shown in turn";
        EXPECT_TRUE(render_node::platformRequest(render_node::Backend::osmesa, cave, tile).windows.empty());
    }
    const walls::Wall mono = walls::shownIn(cave, walls::Stereo::mono);
    EXPECT_FALSE(render_node::platformRequest(render_node::Backend::glfw, mono, mono.tiles[0]).eyesInTurn);
}

}  // namespace
