// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"

namespace web {

/// The sand that a page shows, and the source of its steps: a journal (PageSession) or a hand (DugSession).
class StepSource {
public:
    StepSource() = default;
    virtual ~StepSource() = default;
    StepSource(const StepSource&) = delete;
    StepSource& operator=(const StepSource&) = delete;

    [[nodiscard]] virtual const scene::Scene& scene() const = 0;
    [[nodiscard]] virtual sand::Replica& replica() = 0;
    /// Returns the humidity of the sand that is shown, 0 to 1.
    [[nodiscard]] virtual double humidity() const = 0;
    /// Returns a line for the user about what is wrong with the file that it began with; empty if nothing is.
    [[nodiscard]] virtual const std::string& shortcoming() const = 0;
};

}  // namespace web
