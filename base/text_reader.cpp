// SPDX-License-Identifier: Apache-2.0
#include "base/text_reader.hpp"

#include <algorithm>
#include <utility>

#include "base/input_error.hpp"

namespace base {
namespace {

constexpr std::size_t kPiece = 1 << 16;  // of a file [byte]

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n'; }

}  // namespace

TextReader::TextReader(std::string_view bytes, std::string file)
    : stream_(nullptr), file_(std::move(file)), decoder_(file_) {
    decoder_.add(bytes, text_);
    decoder_.finish(text_);
    ended_ = true;
}

void TextReader::fail(const std::string& message) const { throw InputError(file_, line(), message); }

bool TextReader::readOn() {
    if (ended_) {
        return false;
    }
    text_.erase(0, at_);
    at_ = 0;
    const std::size_t size = text_.size();
    std::string bytes(kPiece, '\0');
    while (text_.size() == size && !ended_) {
        stream_->read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        const auto count = static_cast<std::size_t>(stream_->gcount());
        bytesRead_ += count;
        if (count > 0) {
            decoder_.add(std::string_view(bytes).substr(0, count), text_);
        } else {
            decoder_.finish(text_);
            ended_ = true;
        }
    }
    return text_.size() > size;
}

bool TextReader::nextLine(std::string_view& line) {
    std::size_t end = text_.find('\n', at_);
    while (end == std::string::npos) {
        const std::size_t seen = text_.size() - at_;
        if (!readOn()) {
            break;
        }
        end = text_.find('\n', at_ + seen);
    }
    if (at_ == text_.size()) {
        return false;
    }
    const std::size_t length = std::min(end, text_.size()) - at_;
    line = std::string_view(text_).substr(at_, length);
    at_ += length + (end == std::string::npos ? 0 : 1);
    ++line_;
    return true;
}

std::string_view TextReader::nextWord() {
    line_ = line() + std::exchange(linesBefore_, 0);
    while (at_ < text_.size() || readOn()) {
        if (!isBlank(text_[at_])) {
            break;
        }
        line_ += text_[at_++] == '\n' ? 1 : 0;
    }
    std::size_t length = 0;
    while ((at_ + length < text_.size() || readOn()) && !isBlank(text_[at_ + length])) {
        ++length;
    }
    at_ += length;
    return std::string_view(text_).substr(at_ - length, length);
}

std::string_view TextReader::peekWord() {
    const long line = this->line();
    const std::string_view word = nextWord();
    at_ -= word.size();
    linesBefore_ = line_ - line;
    line_ = line;
    return word;
}

char separatorOf(std::string_view firstLine) {
    for (const char separator : {';', ',', '\t'}) {
        if (firstLine.find(separator) != std::string_view::npos) {
            return separator;
        }
    }
    return ',';
}

std::string_view unquoted(std::string_view cell) {
    const bool quoted = cell.size() > 1 && cell.front() == '"' && cell.back() == '"';
    return quoted ? cell.substr(1, cell.size() - 2) : cell;
}

}  // namespace base
