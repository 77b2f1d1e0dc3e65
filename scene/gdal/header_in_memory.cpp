// SPDX-License-Identifier: Apache-2.0
#include "scene/gdal/header_in_memory.hpp"

#include <cpl_vsi.h>

#include <cctype>
#include <fstream>
#include <string_view>

#include "base/text.hpp"
#include "base/text_reader.hpp"

namespace scene {
namespace {

constexpr const char* kHeader = "/vsimem/sandwall_header.asc";

}  // namespace

HeaderInMemory::HeaderInMemory(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string begin(4096, '\0');
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    const bool marked = begin.starts_with("\xEF\xBB\xBF");
    if (!marked && begin.find('\0') == std::string::npos && begin.find('\n') != std::string::npos) {
        return;
    }
    stream.clear();
    stream.seekg(0);
    base::TextReader lines(stream, file.string());
    for (std::string_view line; lines.nextLine(line);) {
        text_.append(line).push_back('\n');
        const std::string_view words = base::trimmed(line);
        if (!words.empty() && std::isalpha(static_cast<unsigned char>(words.front())) == 0) {
            break;  // behind the header
        }
    }
    VSIFCloseL(VSIFileFromMemBuffer(kHeader, reinterpret_cast<GByte*>(text_.data()), text_.size(), FALSE));
}

HeaderInMemory::~HeaderInMemory() { VSIUnlink(kHeader); }

std::filesystem::path HeaderInMemory::path() const { return text_.empty() ? "" : kHeader; }

}  // namespace scene
