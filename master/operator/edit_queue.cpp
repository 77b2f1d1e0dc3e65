// SPDX-License-Identifier: Apache-2.0
#include "master/operator/edit_queue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/input_error.hpp"

namespace master {
namespace {

std::int64_t bytesOf(const sand::Edit& edit) { return edit.sand ? static_cast<std::int64_t>(edit.sand->size()) : 0; }

}  // namespace

void EditQueue::requireRoomFor(const sand::Edit& edit) const {
    const auto loads = [](const Asked& asked) { return asked.edit.kind == sand::Edit::load; };
    if (edit.kind == sand::Edit::load && std::any_of(asked_.begin(), asked_.end(), loads)) {
        throw base::InputError("another load waits for its step already");
    }
    if (asked_.size() >= kMost) {
        throw base::InputError(fmt::format("{} edits wait for their steps already", asked_.size()));
    }
}

std::int64_t EditQueue::sandBytes(const sand::Edit& more) const {
    std::int64_t bytes = bytesOf(more);
    for (const Asked& asked : asked_) {
        bytes += bytesOf(asked.edit);
    }
    return bytes;
}

std::vector<scene::Material> EditQueue::materialsOf(const std::vector<sand::Step>& steps) const {
    std::vector<scene::Material> materials;
    for (const sand::Step& step : steps) {
        const auto made = find(step.edit.number);
        if (made != asked_.end() && made->material) {
            materials.push_back(*made->material);
        }
    }
    return materials;
}

std::deque<EditQueue::Asked>::const_iterator EditQueue::find(std::uint64_t number) const {
    return std::find_if(asked_.begin(), asked_.end(), [&](const Asked& asked) { return asked.edit.number == number; });
}

std::optional<ControlSocket::Client> EditQueue::shown(std::uint64_t number) {
    const auto asked = find(number);
    if (asked == asked_.end()) {
        return std::nullopt;
    }
    const std::optional<ControlSocket::Client> client = asked->client;
    asked_.erase(asked);
    return client;
}

std::vector<ControlSocket::Client> EditQueue::releaseClients() {
    std::vector<ControlSocket::Client> clients;
    for (Asked& asked : asked_) {
        if (asked.client) {
            clients.push_back(*asked.client);
            asked.client.reset();
        }
    }
    return clients;
}

}  // namespace master
