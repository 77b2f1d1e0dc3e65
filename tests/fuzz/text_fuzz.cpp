// SPDX-License-Identifier: Apache-2.0
// Fuzzes the reader of all texts: encodings, ends of lines, words and numbers.
#include <cmath>
#include <optional>

#include "base/number.hpp"
#include "base/text_reader.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace {

/// Returns the text of `bytes` that come in pieces of `most`, or nullopt if it is refused.
std::optional<std::string> decoded(std::string_view bytes, std::size_t most) {
    std::optional<std::string> text;
    fuzz::takeOrRefuse([&] {
        std::string made;
        base::TextDecoder decoder("t");
        for (std::size_t at = 0; at < bytes.size(); at += most) {
            decoder.add(bytes.substr(at, most), made);
        }
        decoder.finish(made);
        text = made;
    });
    return text;
}

void requireText(const std::string& text) {
    for (const char c : text) {
        if (c == '\0' || c == '\r' || c == '\x1A') {
            throw std::logic_error("a text keeps a byte that ends lines or texts");
        }
    }
    // The decoded text is UTF-8, so that decoding it again changes nothing.
    if (decoded(text, text.size() + 1) != text) {
        throw std::logic_error("a text changes when it is decoded twice");
    }
}

void requireWords(const std::string& text) {
    base::TextReader lines(text, "t"), words(text, "t");
    base::DecimalStyle style("t");
    long count = 0;
    for (std::string_view line; lines.nextLine(line);) {
        if (line.find('\n') != std::string_view::npos || lines.line() != ++count) {
            throw std::logic_error("a line is not one line");
        }
    }
    for (std::string word(words.nextWord()); !word.empty(); word = words.nextWord()) {
        const std::optional<double> number = base::numberOf(word), comma = base::commaNumberOf(word);
        if ((number && (comma || !std::isfinite(*number))) || (base::spellsNan(word) && (number || comma))) {
            throw std::logic_error("a word is two numbers, or a number that is not finite");
        }
        fuzz::takeOrRefuse([&] { (void)style.numberOf(word, words.line()); });
    }
    if (words.line() > std::max(count, 1L) + 1) {
        throw std::logic_error("a word is behind the last line");
    }
}

}  // namespace

SANDWALL_FUZZER(text) {
    const std::string_view bytes = fuzz::textOf({data, size});
    const std::optional<std::string> whole = decoded(bytes, size + 1);
    for (const std::size_t piece : {std::size_t{1}, std::size_t{3}, std::size_t{7}}) {
        if (decoded(bytes, piece) != whole) {
            throw std::logic_error("a text depends on the pieces in which it comes");
        }
    }
    if (whole) {
        requireText(*whole);
        requireWords(*whole);
    }
    return 0;
}
