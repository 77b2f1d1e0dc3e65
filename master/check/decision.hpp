// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "journal/format.hpp"

namespace master {

/// Sand that a majority of the ranks has decided on.
struct Decision {
    journal::JournalEnd sand;
    std::uint64_t movement = 0;  // sand::Replica::movementDigest()
};

}  // namespace master
