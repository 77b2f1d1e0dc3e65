// SPDX-License-Identifier: Apache-2.0
// What an operator asks for and no frame waits for: a thread does it, a later frame answers.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/input_error.hpp"
#include "master/journal/saved_sand.hpp"
#include "master/session.hpp"

namespace master {
namespace {

using Client = ControlSocket::Client;

constexpr std::size_t kMostErrands = 4;  // at once; each save holds a copy of the sand

}  // namespace

void Session::requireFewErrands() const {
    if (errands_.size() >= kMostErrands) {
        throw base::InputError(fmt::format("{} files are being written or read already; try again", errands_.size()));
    }
}

void Session::startErrand(std::function<ErrandDone()> work, Clients clients, bool capture) {
    errands_.push_back({std::async(std::launch::async, std::move(work)), std::move(clients), capture});
}

void Session::save(const std::string& name, std::optional<Client> client) {
    requireFewErrands();
    // Copied here, which takes a fraction of a frame; compressed and written beside the frames.
    auto copy = terrain_.copySand();
    SavedSand saved{place_, terrain_.stepNumber(), hash_, {}};
    startErrand(
        [copy = std::move(copy), saved = std::move(saved), file = saveFile(options_.out, name)]() mutable {
            saved.sand = copy->encode();
            copy.reset();
            writeSavedSand(file, saved);
            return ErrandDone{nlohmann::json({{"ok", true},
                                              {"file", "saves/" + file.filename().string()},
                                              {"bytes", saved.sand.size()},
                                              {"step", saved.step},
                                              {"state_hash", fmt::format("{:016x}", saved.stateHash)}})
                                  .dump(),
                              {}};
        },
        {client});
}

void Session::load(const std::string& name, std::optional<Client> client) {
    requireFewErrands();
    startErrand(
        [file = saveFile(options_.out, name), place = place_, read = terrain_.sandReader()] {
            return ErrandDone{{}, sand::Edit::loaded(readSavedSand(file, place, read).sand)};
        },
        {client});
}

void Session::finishErrands(bool wait) {
    for (std::size_t i = 0; i < errands_.size();) {
        Errand& errand = errands_[i];
        if (!wait && errand.work.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            ++i;
            continue;
        }
        const Clients clients = errand.clients;
        try {
            ErrandDone done = errand.work.get();
            if (done.edit.any()) {
                askEdit(std::move(done.edit), clients.front());
            } else {
                answerAll(clients, done.json);
            }
        } catch (const std::exception& error) {  // whatever befell the thread, frames go on
            refuse(error.what(), clients);
        }
        errands_.erase(errands_.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

}  // namespace master
