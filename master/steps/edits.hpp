// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "master/steps/arrived_step.hpp"

namespace master {

/// Edits of the sand that operators have asked for and that are in no step yet, in the order of the requests. Used by
/// one thread.
class Edits {
public:
    static constexpr std::size_t kMost = 16;
    using Client = std::uint64_t;  // of ControlSocket

    struct Asked {
        sand::Edit edit;
        std::optional<Client> client;             // that gets the answer; nullopt for standard input and keys
        std::optional<scene::Material> material;  // the session's material after the edit; nullopt if unchanged
        sand::History::Intent intent{};           // whether the edit undoes or redoes others
        std::uint32_t epoch = 0;                  // in which a server was asked for the edit; 0: none was
    };

    /// `last` is the last number of an edit in the resumed session; 0 in a new one.
    explicit Edits(std::uint64_t last = 0) : last_(last) {}

    /// Throws base::InputError if too many edits wait. Also throws if `edit` is a load and another load waits, because
    /// each load holds the whole sand. `count` edits are added together.
    void requireRoomFor(const sand::Edit& edit, std::size_t count = 1) const;
    /// Adds an edit under the next number, and returns this number.
    std::uint64_t add(sand::Edit edit, std::optional<Client> client, std::optional<scene::Material> material,
                      const sand::History::Intent& intent = {});
    [[nodiscard]] const std::deque<Asked>& waiting() const { return waiting_; }
    /// Returns the size of the sand that the waiting edits and `more` load [byte].
    [[nodiscard]] std::int64_t sandBytes(const sand::Edit& more = {}) const;
    /// Returns the clients that wait, and forgets them, because the caller answers them at once. Their edits stay.
    [[nodiscard]] std::vector<Client> releaseClients();

    /// Returns the oldest edit, or Edit::none.
    [[nodiscard]] sand::Edit next() const { return waiting_.empty() ? sand::Edit() : waiting_.front().edit; }
    /// Returns the edit for which the server that numbers `epoch` is to be asked now, or null. It is asked for one edit
    /// at a time, because it keeps only one for its next step. If a link was lost with an edit, the next server is
    /// asked for it again.
    [[nodiscard]] const sand::Edit* nextToAsk(std::uint32_t epoch);
    /// Removes the edits in `steps`, whose clients, materials and intents these steps get. Finds edits by their
    /// numbers.
    void moveInto(ArrivedSteps& steps);

private:
    [[nodiscard]] std::deque<Asked>::iterator find(std::uint64_t number);

    std::deque<Asked> waiting_;
    std::uint64_t last_;
};

}  // namespace master
