// SPDX-License-Identifier: Apache-2.0
#include "master/steps/edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/input_error.hpp"

namespace master {
namespace {

std::int64_t bytesOf(const sand::Edit& edit) { return edit.sand ? static_cast<std::int64_t>(edit.sand->size()) : 0; }

}  // namespace

void Edits::requireRoomFor(const sand::Edit& edit, std::size_t count) const {
    const auto loads = [](const Asked& asked) { return asked.edit.kind == sand::Edit::load; };
    if (edit.kind == sand::Edit::load && std::ranges::any_of(waiting_, loads)) {
        throw base::InputError("another load waits for its step already");
    }
    if (waiting_.size() + count > kMost) {
        throw base::InputError(fmt::format("{} edits wait for their steps already", waiting_.size()));
    }
}

std::uint64_t Edits::add(sand::Edit edit, std::optional<Client> client, std::optional<scene::Material> material,
                         const sand::History::Intent& intent) {
    edit.number = ++last_;
    waiting_.push_back({std::move(edit), client, std::move(material), intent});
    return last_;
}

std::int64_t Edits::sandBytes(const sand::Edit& more) const {
    std::int64_t bytes = bytesOf(more);
    for (const Asked& asked : waiting_) {
        bytes += bytesOf(asked.edit);
    }
    return bytes;
}

std::vector<Edits::Client> Edits::releaseClients() {
    std::vector<Client> clients;
    for (Asked& asked : waiting_) {
        if (const std::optional<Client> client = std::exchange(asked.client, {})) {
            clients.push_back(*client);
        }
    }
    return clients;
}

const sand::Edit* Edits::nextToAsk(std::uint32_t epoch) {
    if (waiting_.empty() || waiting_.front().epoch == epoch) {
        return nullptr;
    }
    waiting_.front().epoch = epoch;
    return &waiting_.front().edit;
}

std::deque<Edits::Asked>::iterator Edits::find(std::uint64_t number) {
    return std::ranges::find(waiting_, number, [](const Asked& asked) { return asked.edit.number; });
}

void Edits::moveInto(ArrivedSteps& steps) {
    for (ArrivedStep& arrived : steps) {
        const auto asked = find(arrived.step.edit.number);
        if (asked != waiting_.end()) {
            arrived.client = asked->client;
            arrived.material = std::move(asked->material);
            arrived.intent = asked->intent;
            waiting_.erase(asked);
        }
    }
}

}  // namespace master
