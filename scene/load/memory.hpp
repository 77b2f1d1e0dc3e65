// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "scene/load/scene_file.hpp"
#include "scene/model/session_memory.hpp"

/// Checks of memory for one program, made before it takes the memory.
namespace scene {

/// Returns the checks of a program that runs one replica of the scene in `file` and may take `freeBytes`. They compare
/// lower bounds: a scene that is refused cannot fit, and an accepted scene may still be too large.
[[nodiscard]] SizeChecks checksOfOneReplica(const std::string& file, std::int64_t freeBytes);
/// Throws base::InputError unless a replica of this scene fits. `freeBytes` is the memory that was free before the
/// scene was made. `file` names the scene in the message.
void requireReplica(const Scene& scene, const std::string& file, std::int64_t freeBytes);
/// Throws base::InputError unless a scene of this size fits with a replica of it.
void requireReplica(const sand::FieldSize& size, const std::string& file, std::int64_t freeBytes);

/// Returns the checks of a haptic server that may take `freeBytes`. They compare the memory with all sand moving.
[[nodiscard]] SizeChecks checksOfServer(const std::string& file, std::int64_t freeBytes);
/// Throws base::InputError unless a haptic server of this scene fits. Call it when the scene was made: only then the
/// memory of its tool and the vertices of its TIN are known.
void requireServer(const Scene& scene, const std::string& file, std::int64_t freeBytes);

}  // namespace scene
