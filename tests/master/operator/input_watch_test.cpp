// SPDX-License-Identifier: Apache-2.0
#include "master/operator/input_watch.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <future>
#include <string_view>

namespace {

using namespace std::chrono_literals;

/// A pipe whose ends close at the latest with this object.
class Pipe {
public:
    Pipe() { EXPECT_EQ(pipe2(ends_.data(), O_CLOEXEC), 0); }
    ~Pipe() {
        endWriting();
        close(ends_[0]);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    [[nodiscard]] int reading() const { return ends_[0]; }
    void write(std::string_view text) const {
        EXPECT_EQ(::write(ends_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    }
    void endWriting() {
        if (ends_[1] >= 0) {
            close(ends_[1]);
            ends_[1] = -1;
        }
    }

private:
    std::array<int, 2> ends_{-1, -1};
};

TEST(InputWatch, TellsTheEndOfTheInputOnceThoughLinesAreUnread) {
    Pipe input;
    std::promise<void> told;
    std::future<void> ended = told.get_future();
    const master::InputWatch watch(input.reading(), [&told] { told.set_value(); });  // a second call would throw
    input.write("capture\n");
    EXPECT_EQ(ended.wait_for(200ms), std::future_status::timeout) << "a line is no end";
    input.endWriting();
    EXPECT_EQ(ended.wait_for(60s), std::future_status::ready);
    std::array<char, 16> line{};
    EXPECT_EQ(read(input.reading(), line.data(), line.size()), 8) << "the line is still there";
}

TEST(InputWatch, SaysNothingAfterItsEnd) {
    Pipe input;
    bool told = false;
    {
        const master::InputWatch watch(input.reading(), [&told] { told = true; });
    }
    input.endWriting();
    EXPECT_FALSE(told);
}

}  // namespace
