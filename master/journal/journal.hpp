// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "master/journal/format.hpp"
#include "master/journal/reader.hpp"
#include "master/journal/writer.hpp"
#include "scene/scene.hpp"

namespace master {

/// A session read back, all of it: about 400 bytes a step and 65 a tick of the track.
struct Journal {
    scene::Scene scene;
    std::string buildId;
    std::vector<JournalFrame> frames;
    std::vector<base::Bytes> ticks;  // pieces of the haptic server's tick track, when it recorded
    std::vector<JournalResumed> resumes;
    std::optional<JournalEnd> end;  // absent when the session was cut off
    std::int64_t tornBytes = 0;     // at the end of the last part, behind the last whole record; left out
};

/// Throws base::InputError if the file is missing, is not a journal, has another format or algorithm, or is damaged
/// before its end, and if one of its parts is missing.
[[nodiscard]] Journal readJournal(const std::filesystem::path& file);
/// Decodes the scene in the header. Throws base::InputError.
[[nodiscard]] scene::Scene sceneOf(const JournalReader& reader);
/// Decodes only the rules of that scene, not its heights. Throws base::InputError.
[[nodiscard]] sand::Rules rulesOf(const JournalReader& reader);

}  // namespace master
