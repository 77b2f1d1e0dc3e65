// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace base {

/// Returns `text` with A to Z as a to z in any locale. Other bytes stay.
[[nodiscard]] std::string lowerCase(std::string_view text);

/// Returns the extension of `file` in small letters: ".tif" for "A.TIF". Returns an empty text if it has none.
[[nodiscard]] std::string endingOf(const std::filesystem::path& file);

/// Returns `text` without the spaces, tabs and carriage returns around it.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Returns the trimmed parts of `text` between separators. An empty text is one empty part.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

/// Returns the words of `text`. Spaces, tabs and carriage returns separate them, any number in a row.
[[nodiscard]] std::vector<std::string_view> words(std::string_view text);

/// Returns the index of `name` in `names`. Throws InputError, "no WHAT 'name'; there are …", if it is not there.
[[nodiscard]] std::size_t indexOf(std::string_view name, const std::string_view* names, std::size_t count,
                                  std::string_view what);
template <std::size_t kCount>
[[nodiscard]] std::size_t indexOf(std::string_view name, const std::array<std::string_view, kCount>& names,
                                  std::string_view what) {
    return indexOf(name, names.data(), kCount, what);
}

}  // namespace base
