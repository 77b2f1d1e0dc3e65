// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace test {

/// One form in which a program may save a text.
struct TextForm {
    std::string_view name;
    std::string bytes;
};

/// Returns a text of ASCII, whose lines end with line feeds, in forms that each reader of texts must read as the same
/// text. base/text_cases.json has the bytes of these forms one by one.
inline std::array<TextForm, 9> formsOf(const std::string& text) {
    std::string little = "\xFF\xFE", big = "\xFE\xFF", plain, dos, mac;
    for (const char c : text) {
        little += {c, '\0'};
        big += {'\0', c};
        plain += {c, '\0'};
        dos += c == '\n' ? "\r\n" : std::string(1, c);
        mac += c == '\n' ? '\r' : c;
    }
    return {{{"as it is", text},
             {"byte order mark of UTF-8", "\xEF\xBB\xBF" + text},
             {"UTF-16, little-endian", little},
             {"UTF-16, big-endian", big},
             {"UTF-16 without a mark", plain},
             {"ends of DOS, and its end of the text", dos + "\x1A"},
             {"ends of old Macs", mac},
             {"a byte 0 at the end", text + std::string(1, '\0')},
             {"mark and end of DOS", "\xEF\xBB\xBF" + dos + "\x1A\r\n"}}};
}

}  // namespace test
