// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "journal/format.hpp"
#include "journal/reader.hpp"
#include "scene/model/scene.hpp"

namespace journal {

/// A material that an operator has set.
struct JournalMaterial {
    std::size_t frame = 0;  // index in Journal::frames of the frame whose steps set it
    scene::Material material;
};

/// A whole session, read from its journal. Takes about 400 bytes per step and 65 bytes per tick of the tick track.
struct Journal {
    scene::Scene scene;  // with its material, if the journal has it
    std::string buildId;
    std::vector<JournalFrame> frames;
    std::vector<JournalMaterial> materials;
    std::vector<base::Bytes> ticks;  // pieces of the haptic server's tick track, if it recorded one
    std::vector<JournalResumed> resumes;
    std::optional<JournalEnd> end;  // nullopt if the session was cut off
    std::int64_t tornBytes = 0;     // [byte], behind the last whole record of the last part; ignored
};

/// Reads a whole journal from the place of `reader` on. Throws base::InputError as JournalReader::next() does, and if
/// its scene is invalid.
[[nodiscard]] Journal readAll(JournalReader& reader);
/// Decodes the scene in the header. Throws base::InputError if it is invalid.
[[nodiscard]] scene::Scene sceneOf(const JournalReader& reader, scene::Scene::Keep keep = scene::Scene::Keep::heights);
/// Decodes only the rules of the scene in the header, not its heights. Throws base::InputError if they are invalid.
[[nodiscard]] sand::Rules rulesOf(const JournalReader& reader);

}  // namespace journal
