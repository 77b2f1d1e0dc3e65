// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace base {

/// Makes plain text of the bytes of a text file, piece by piece: UTF-8 whose lines end with a line feed.
///
/// Reads UTF-8 with and without a byte order mark, UTF-16 in both byte orders, and Latin-1, to which bytes belong that
/// are not UTF-8. Lines may end as on Unix, DOS and old Macs. A byte 0x1A or 0 ends the text, as programs of DOS and C
/// write it; blanks may follow it. A no-break space becomes a space. Used by one thread.
class TextDecoder {
public:
    /// `file` is for messages.
    explicit TextDecoder(std::string file) : file_(std::move(file)) {}

    /// Appends the text of the next bytes. Up to three bytes wait for the next call. Throws InputError with the line
    /// for UTF-32, and for a text that continues behind its end.
    void add(std::string_view bytes, std::string& text);
    /// Appends what waits. Call it once, behind the last byte.
    void finish(std::string& text);

private:
    enum class Encoding { unknown, bytes, utf16Little, utf16Big };

    void choose(bool atEnd);
    [[nodiscard]] std::size_t takeBytes(bool atEnd, std::string& text);
    [[nodiscard]] std::size_t takeUtf16(std::string& text);
    void put(char32_t character, std::string& text);
    void putPlain(char character, std::string& text);
    [[noreturn]] void fail(const std::string& message) const;

    std::string file_;
    std::string waiting_;  // bytes that are not decoded yet
    Encoding encoding_ = Encoding::unknown;
    long line_ = 1;
    bool afterReturn_ = false;  // the last character was a carriage return
    int end_ = -1;              // byte that ended the text; -1 before its end
};

}  // namespace base
