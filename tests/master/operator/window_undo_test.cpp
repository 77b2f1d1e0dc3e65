// SPDX-License-Identifier: Apache-2.0
// Undo and redo by keys of the windows.
#include <gtest/gtest.h>

#include "tests/master/operator/window_desk_fixture.hpp"

namespace {

using base::Keystroke;
using test::control;
using test::kShiftR;
using test::plain;

class WindowUndo : public test::WindowDeskTest {};

TEST_F(WindowUndo, UndoesTheLastStrokeByControlZAndByU) {
    openForPointer();
    stroke();
    press(control('z'));
    ASSERT_EQ(edits().size(), 1U);
    EXPECT_EQ(edits()[0].kind, sand::Edit::undo);
    press(plain('u'));
    EXPECT_EQ(edits().size(), 1U) << "the second one waits until the first one is shown";
    show(edits()[0]);
    EXPECT_EQ(answerIn(1), "undone; nothing more to undo");
    desk_->obey({});
    EXPECT_EQ(answerIn(1), "nothing to undo");
    EXPECT_EQ(edits().size(), 1U);
}

TEST_F(WindowUndo, RedoesByControlYAndByControlShiftZ) {
    openForPointer();
    press(control('y'));
    EXPECT_EQ(answerIn(1), "nothing to redo");
    stroke();
    const base::Bytes dug = sand_.replica().copySand()->encode();
    for (const Keystroke key : {control('y'), Keystroke{'z', Keystroke::kControl | Keystroke::kShift, 0}}) {
        const std::size_t before = edits().size();
        press(control('z'));
        obeyUntil([&] { return edits().size() == before + 1; });
        show(edits().back());
        EXPECT_EQ(answerIn(1), "undone; nothing more to undo");
        press(key);
        obeyUntil([&] { return edits().size() == before + 2; });
        EXPECT_EQ(edits().back().kind, sand::Edit::load);
        show(edits().back());
        EXPECT_EQ(answerIn(1), "redone; nothing more to redo");
        EXPECT_EQ(sand_.replica().copySand()->encode(), dug);
    }
}

TEST_F(WindowUndo, UndoesAReset) {
    openForPointer();
    stroke();
    const base::Bytes dug = sand_.replica().copySand()->encode();
    press(kShiftR);
    ASSERT_EQ(edits().size(), 1U);
    show(edits()[0]);
    ASSERT_NE(sand_.replica().copySand()->encode(), dug);
    press(control('z'));
    obeyUntil([&] { return edits().size() == 2; });
    show(edits()[1]);
    EXPECT_EQ(answerIn(1), "undone; 1 more to undo");
    EXPECT_EQ(sand_.replica().copySand()->encode(), dug);
}

// Humidity returns with the sand, and the tool stays.
TEST_F(WindowUndo, UndoesHumidityWithoutTheTool) {
    openForPointer();
    press(plain('w'));
    show(edits().back());
    press(plain('3'));
    show(edits().back());
    ASSERT_EQ(edits().size(), 2U);
    press(control('z'));
    obeyUntil([&] { return edits().size() == 4; });
    EXPECT_EQ(edits()[2].kind, sand::Edit::tune);
    EXPECT_EQ(edits()[3].kind, sand::Edit::load);
    show(edits()[2]);
    show(edits()[3]);
    EXPECT_EQ(answerIn(1), "undone; nothing more to undo");
    EXPECT_EQ(sand_.replica().rules().tuning.tool.kind, sand::ToolKind::rectangle);
    press(plain('w'));
    EXPECT_EQ(answerIn(1), "humidity 10 %") << "from 0 again";
}

TEST_F(WindowUndo, LetsAnUndoWaitWhileTheSessionIsPaused) {
    openForPointer();
    stroke();
    press(plain(' '));
    press(control('z'));
    EXPECT_EQ(answerIn(1), "undo waits until Space resumes");
    ASSERT_EQ(edits().size(), 1U);
    press(plain(' '));
    show(edits()[0]);
    EXPECT_EQ(sand_.history()->entries().redosLeft(), 1U);
}

}  // namespace
