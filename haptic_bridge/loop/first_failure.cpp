// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/first_failure.hpp"

#include <stdexcept>

#include "base/input_error.hpp"

namespace haptic_bridge {
namespace {

std::string reasonOf(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const std::exception& known) {
        return known.what();
    } catch (...) {  // a driver may throw anything
        return "an exception without a text";
    }
}

}  // namespace

void FirstFailure::keep(const std::string& name, const std::exception_ptr& error) noexcept {
    {
        const std::lock_guard lock(mutex_);
        if (failed_) {
            return;
        }
        failed_ = true;
        try {
            line_ = base::InputError::oneLine(name + " has failed: " + reasonOf(error));
        } catch (const std::exception&) {
            line_ = "no memory left";  // short enough to need none
        }
    }
    if (wake_) {
        wake_();
    }
}

void FirstFailure::rethrow() const {
    const std::lock_guard lock(mutex_);
    if (failed_) {
        throw std::runtime_error(line_);
    }
}

}  // namespace haptic_bridge
