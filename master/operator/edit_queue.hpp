// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "master/operator/control_socket.hpp"
#include "sand/model/step.hpp"
#include "scene/model/material.hpp"

namespace master {

/// Edits of the sand that operators have asked for and that are not in a step yet, in the order of the requests. Used
/// by one thread.
class EditQueue {
public:
    static constexpr std::size_t kMost = 16;

    struct Asked {
        sand::Edit edit;
        /// Client that gets the answer; nullopt for a line from standard input or a key in a window.
        std::optional<ControlSocket::Client> client;
        std::optional<scene::Material> material;  // the session's material after the edit; nullopt if unchanged
    };

    /// Throws base::InputError if the queue is full. Also throws if `edit` is a load and another load waits, because
    /// each load holds the whole sand.
    void requireRoomFor(const sand::Edit& edit) const;
    void add(Asked asked) { asked_.push_back(std::move(asked)); }
    [[nodiscard]] std::size_t size() const { return asked_.size(); }
    /// Returns the size of the sand that the waiting edits and `more` load [byte].
    [[nodiscard]] std::int64_t sandBytes(const sand::Edit& more = {}) const;
    /// Returns the materials that the edits of `steps` set. Finds edits by their numbers.
    [[nodiscard]] std::vector<scene::Material> materialsOf(const std::vector<sand::Step>& steps) const;

    /// Removes the edit with this number, because the wall shows a step with it. Returns the client that waits for the
    /// answer; nullopt without one, or if no such edit waits.
    [[nodiscard]] std::optional<ControlSocket::Client> shown(std::uint64_t number);
    /// Returns the clients that wait, and removes them from the queue, because the caller answers them at once. Their
    /// edits stay.
    [[nodiscard]] std::vector<ControlSocket::Client> releaseClients();

private:
    [[nodiscard]] std::deque<Asked>::const_iterator find(std::uint64_t number) const;

    std::deque<Asked> asked_;
};

}  // namespace master
