// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>

#include "base/text_decoder.hpp"

namespace base {

/// Lines or words of a text file in any encoding that TextDecoder reads. All readers of texts use it, so that a file
/// which one of them accepts is not refused by another because of its bytes. Reads the stream piece by piece.
class TextReader {
public:
    /// `stream` must outlive the reader. `file` is for messages.
    TextReader(std::istream& stream, std::string file) : stream_(&stream), file_(std::move(file)), decoder_(file_) {}
    /// Reads bytes that are in memory, which are copied.
    TextReader(std::string_view bytes, std::string file);

    /// Sets `line` to the next line without its end and returns true, or returns false behind the last line. The line
    /// is valid until the next call.
    [[nodiscard]] bool nextLine(std::string_view& line);
    /// Returns the next word, or an empty one at the end of the text. It is valid until the next call.
    [[nodiscard]] std::string_view nextWord();
    /// Returns the word that nextWord() will return. Does not change line().
    [[nodiscard]] std::string_view peekWord();
    /// Returns the number of the line that was read last, or in which the last word is. It is 1 before the first.
    [[nodiscard]] long line() const { return line_ < 1 ? 1 : line_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    /// Returns how many bytes were taken from the stream [byte]. Grows by a piece at a time.
    [[nodiscard]] std::uint64_t bytesRead() const { return bytesRead_; }
    /// Throws InputError about line().
    [[noreturn]] void fail(const std::string& message) const;

private:
    bool readOn();

    std::istream* stream_;  // nullptr if all bytes are in text_
    std::string file_;
    TextDecoder decoder_;
    std::string text_;      // current piece
    std::size_t at_ = 0;    // position in text_, behind what was read
    long line_ = 0;         // line that was read last; words count from 1
    long linesBefore_ = 0;  // lines between the last word and a word that peekWord() has read
    std::uint64_t bytesRead_ = 0;
    bool ended_ = false;
};

/// Returns the character between the cells of a table, by its first line: a semicolon, a comma, or a tab. Returns a
/// comma if the line has none of them.
[[nodiscard]] char separatorOf(std::string_view firstLine);

/// Returns a cell without the quotation marks around it.
[[nodiscard]] std::string_view unquoted(std::string_view cell);

}  // namespace base
