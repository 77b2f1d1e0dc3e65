// SPDX-License-Identifier: Apache-2.0
#include "scene/import/prj_file.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <vector>

#include "base/input_error.hpp"
#include "base/text.hpp"
#include "base/text_reader.hpp"

namespace scene {
namespace {

namespace fs = std::filesystem;

/// Returns the word behind `key` in the first line that begins with this word, in small letters. Returns an empty text
/// without such a line.
std::string valueOf(const std::string& text, std::string_view key) {
    base::TextReader lines(text, "");
    for (std::string_view line; lines.nextLine(line);) {
        const std::vector<std::string_view> words = base::words(line);
        if (!words.empty() && base::lowerCase(words[0]) == key) {
            return words.size() > 1 ? base::lowerCase(words[1]) : "";
        }
    }
    return "";
}

}  // namespace

bool PrjFile::inDegrees() const {
    constexpr std::array<std::string_view, 6> kGeographic{"geogcs",      "geogcrs",       "geodcrs",
                                                          "geodeticcrs", "geographiccrs", "basegeogcrs"};
    const std::string begin = base::lowerCase(text.substr(0, text.find('[')));
    const bool wkt = std::find(kGeographic.begin(), kGeographic.end(), base::trimmed(begin)) != kGeographic.end();
    return wkt || valueOf(text, "projection") == "geographic" || valueOf(text, "units") == "dd";
}

std::optional<std::string> PrjFile::heightUnit() const {
    const std::string unit = valueOf(text, "zunits");
    return unit.empty() || unit == "no" || unit == "none" ? std::nullopt : std::optional(unit);
}

std::optional<PrjFile> prjBeside(const fs::path& raster) {
    for (const char* ending : {".prj", ".PRJ", ".Prj"}) {
        const fs::path file = fs::path(raster).replace_extension(ending);
        std::error_code none;
        if (!fs::is_regular_file(file, none)) {
            continue;
        }
        std::ifstream stream(file, std::ios::binary);
        base::TextReader lines(stream, file.string());
        PrjFile prj{file, {}};
        for (std::string_view line; lines.nextLine(line);) {
            prj.text.append(line).push_back('\n');
        }
        if (!stream.is_open() || stream.bad()) {
            throw base::InputError(file.string() + ": cannot be read; check the path");
        }
        return prj;
    }
    return std::nullopt;
}

}  // namespace scene
