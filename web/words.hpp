// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "sand/model/step.hpp"
#include "scene/model/material.hpp"

// The words of the page's controls. The page has no such list of its own: it shows what it gets here, and what it does
// not know by its name.
namespace web {

/// Returns what a hand can choose, as JSON. `tools` and `edits`: names. `material`: each number by its `word`, with its
/// limits. `depth`: limits, usual value and notch of the tool's depth [tool radius].
[[nodiscard]] std::string wordsOfPage();
/// Returns a material as JSON. `material`: each number by its word. `tool`: each part that it has by its name.
[[nodiscard]] std::string materialText(const scene::Material& material);

/// Returns the change of one part of the tool, `kind`, `radius`, `width`, `heading` or `foot`. Throws base::InputError
/// for another part or value.
[[nodiscard]] scene::ToolChange toolChange(std::string_view part, std::string_view value);
/// Returns the edit of that name. Throws base::InputError for another name, and for an edit that needs more than a
/// name.
[[nodiscard]] sand::Edit editNamed(std::string_view name);
inline constexpr std::string_view kRedo = "redo";  // among the edits of wordsOfPage(), but no sand::Edit

}  // namespace web
