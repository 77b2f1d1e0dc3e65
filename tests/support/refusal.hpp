// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "base/input_error.hpp"

namespace test {

/// Returns the text of the Error with which `act` refuses its input, or "nothing" if it accepts the input.
template <class Error = base::InputError>
std::string refusalOf(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing";
}

}  // namespace test
