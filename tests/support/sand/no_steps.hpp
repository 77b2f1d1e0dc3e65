// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "master/steps/step_source.hpp"

namespace test {

/// A source that returns no step. Tests of one part of a session override the function that this part calls.
class NoSteps : public master::StepSource {
public:
    master::ArrivedSteps next(const sand::Replica& /* sand */, std::uint64_t /* hash */,
                              std::size_t /* most */) override {
        return {};
    }
    [[nodiscard]] std::size_t mostPerFrame() const override { return 0; }
    [[nodiscard]] const char* hand() const override { return ""; }
};

}  // namespace test
