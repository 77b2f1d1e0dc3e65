// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "master/operator/control_socket.hpp"

namespace master {

/// The origin of a command gets the answer. It is a client of the control socket, or a window in which a key was
/// pressed. Standard input has neither.
struct Asker {
    std::optional<ControlSocket::Client> client{};
    std::optional<int> window{};  // rank of the window

    [[nodiscard]] static Asker at(int rank) { return {{}, rank}; }
    friend bool operator==(const Asker&, const Asker&) = default;
};
using Askers = std::vector<Asker>;  // all of them wait for one answer

}  // namespace master
