// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "journal/reader.hpp"
#include "sand/start.hpp"
#include "scene/model/scene.hpp"

namespace web {

/// Returns a reader of a journal. Throws base::InputError, with what a page can do, if the journal cannot be read, or
/// if its sand needs more than `memory` bytes.
[[nodiscard]] journal::JournalReader openedJournal(const std::string& name, std::vector<base::Bytes> parts,
                                                   std::string_view release, std::int64_t memory);
/// Returns the scene with which a journal begins, with its material.
[[nodiscard]] scene::Scene sceneWithMaterial(const journal::JournalReader& reader);
/// Throws base::InputError if sand of this size, with `more` bytes, needs more than `memory` bytes. `name` is that of
/// its file.
void requireMemory(const std::string& name, const sand::FieldSize& size, std::int64_t memory, std::int64_t more = 0);

}  // namespace web
