// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "master/operator/control_socket.hpp"
#include "sand/model/step.hpp"
#include "scene/material.hpp"

namespace master {

/// Edits of the sand that were asked for and are in no step yet, in that order. One thread.
class EditQueue {
public:
    static constexpr std::size_t kMost = 16;

    struct Asked {
        sand::Edit edit;
        std::optional<ControlSocket::Client> client;  // that gets the answer; nobody for a line that was typed
        std::optional<scene::Material> material;      // that the edit makes the session's
    };

    /// Throws base::InputError while the queue is full, or if this is a load and another one waits: each holds the
    /// whole sand.
    void requireRoomFor(const sand::Edit& edit) const;
    void add(Asked asked) { asked_.push_back(std::move(asked)); }
    [[nodiscard]] std::size_t size() const { return asked_.size(); }
    /// Returns how much sand is loaded by the edits that wait [byte], and by `more`.
    [[nodiscard]] std::int64_t sandBytes(const sand::Edit& more = {}) const;
    /// Returns the materials that the edits of these steps make the session's.
    [[nodiscard]] std::vector<scene::Material> materialsOf(const std::vector<sand::Step>& steps) const;

    /// Removes the first edit if `edit` equals it, because a step with it is shown. Returns the client that waits for
    /// the answer, if there is one.
    [[nodiscard]] std::optional<ControlSocket::Client> shown(const sand::Edit& edit);
    /// Returns the clients that wait, and forgets them: the caller answers them at once. Their edits stay.
    [[nodiscard]] std::vector<ControlSocket::Client> releaseClients();

private:
    std::deque<Asked> asked_;
};

}  // namespace master
