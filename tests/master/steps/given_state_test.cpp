// SPDX-License-Identifier: Apache-2.0
#include "master/steps/given_state.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "master/journal/keeper.hpp"
#include "tests/support/processes/server_process.hpp"
#include "tests/support/sand/sand_samples.hpp"
#include "tests/support/seed.hpp"

namespace {

/// A field that takes several frames to copy.
class GivenStateTest : public testing::Test {
protected:
    static constexpr int kColumns = 1600, kRows = 1500;
    static_assert(std::int64_t{kColumns} * kRows > 2 * master::JournalKeeper::kCopiedCells);

    static void dig(sand::Replica& replica) {
        std::mt19937 random(test::randomSeed());
        for (std::uint64_t step = replica.stepNumber() + 1, last = step + 3; step < last; ++step) {
            replica.apply(samples::randomStep(step, replica.rules(), random));
        }
    }
    /// Returns the bytes, and sets `frames` to the number of frames that it took.
    std::optional<base::Bytes> given(master::GivenState& state) {
        std::optional<base::Bytes> bytes;
        (void)test::eventually([&] {
            ++frames_;
            bytes = state.next(replica_);
            return bytes.has_value();
        });
        return bytes;
    }
    bool isState(const std::optional<base::Bytes>& bytes, const sand::Replica& expected) const {
        sand::Replica other(scene_);
        other.decodeState(bytes.value());
        return other.stateHash() == sand::Replica(expected).stateHash() && *bytes == expected.encodeState();
    }

    const scene::Scene scene_ = samples::flatScene(kColumns, kRows);
    sand::Replica replica_{scene_};
    int frames_ = 0;
};

TEST_F(GivenStateTest, IsTheStateAndTakesSeveralFrames) {
    dig(replica_);
    master::GivenState state;
    EXPECT_EQ(state.next(replica_), std::nullopt);
    EXPECT_TRUE(isState(given(state), replica_));
    EXPECT_GE(frames_, 2);
    dig(replica_);
    EXPECT_TRUE(isState(given(state), replica_)) << "the next state is a new one";
}

TEST_F(GivenStateTest, IsOfOneMomentIfTheReplicaIsHealedMeanwhile) {
    const sand::Replica before = replica_;
    sand::Replica other(scene_);
    dig(other);
    master::GivenState state;
    EXPECT_EQ(state.next(replica_), std::nullopt);
    replica_.decodeState(other.encodeState());
    EXPECT_TRUE(isState(given(state), before));
}

TEST_F(GivenStateTest, BeginsAgainWithAnotherReplicaInItsPlace) {
    sand::Replica other(scene_);
    dig(other);
    master::GivenState state;
    EXPECT_EQ(state.next(replica_), std::nullopt);
    replica_ = other;
    EXPECT_TRUE(isState(given(state), other));
}

TEST_F(GivenStateTest, ForgetsTheSandWhileItIsCopiedAndWhileItIsCompressed) {
    for (int frames = 1; frames < 6; ++frames) {
        master::GivenState state;
        for (int i = 0; i < frames; ++i) {
            (void)state.next(replica_);
        }
        state.drop();
        dig(replica_);
        EXPECT_TRUE(isState(given(state), replica_)) << frames;
    }
}

TEST_F(GivenStateTest, IsDroppedWithItsOwner) {
    for (int frames = 1; frames < 6; ++frames) {
        master::GivenState state;
        for (int i = 0; i < frames; ++i) {
            (void)state.next(replica_);
        }
    }
}

}  // namespace
