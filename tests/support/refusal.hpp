// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "base/input_error.hpp"

namespace test {

/// Returns the error line with which `act` refuses its input, or "nothing" if it accepts the input.
inline std::string refusalOf(const std::function<void()>& act) {
    try {
        act();
    } catch (const base::InputError& error) {
        return error.what();
    }
    return "nothing";
}

}  // namespace test
