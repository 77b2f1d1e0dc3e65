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

/// Throws base::InputError for a file that is missing, no journal, of a release with another format or algorithm, or
/// damaged before its end, and for a journal of whose parts one is missing.
[[nodiscard]] Journal readJournal(const std::filesystem::path& file);
/// Of the header. Throws base::InputError.
[[nodiscard]] scene::Scene sceneOf(const JournalReader& reader);
/// The rules of that scene, read without its heights. Throws base::InputError.
[[nodiscard]] sand::Rules rulesOf(const JournalReader& reader);

}  // namespace master
