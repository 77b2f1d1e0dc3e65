// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace host {

/// Returns the memory that the control groups of this process leave it [byte]. Its own group counts, and each group
/// around that one. Memory of unused files counts as free, because the system gives it back.
/// Returns nullopt without a limit. Reads groups of version 1 and 2 (cgroups(7)), also of a container, which may see
/// only a part of the groups.
///
/// `root` is the folder that has `proc` and `sys`; tests give another one.
[[nodiscard]] std::optional<std::int64_t> freeInControlGroups(const std::filesystem::path& root = "/");

}  // namespace host
