// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace replay {

/// Writes every step up to `until` as a row of a CSV file (docs/journal.md). Prints on standard error what the journal
/// lacks. Reads the journal record by record, so that the memory does not grow with the session. Throws
/// base::InputError if the journal cannot be used, or if it ends before `until`, and then leaves the file unchanged.
void exportSteps(const std::filesystem::path& journal, const std::filesystem::path& file,
                 std::optional<std::uint64_t> until = {});

}  // namespace replay
