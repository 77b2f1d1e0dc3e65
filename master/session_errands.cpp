// SPDX-License-Identifier: Apache-2.0
// What an operator asks for and no frame waits for: a thread does it, a later frame answers.
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "files/input_error.hpp"
#include "master/saved_sand.hpp"
#include "master/session.hpp"

namespace master {
namespace {

using Client = ControlSocket::Client;

constexpr std::size_t kMostErrands = 4;  // at once; each save holds a copy of the sand

}  // namespace

void Session::runErrand(std::function<ErrandDone()> work, std::optional<Client> client) {
    if (errands_.size() >= kMostErrands) {
        throw files::InputError(fmt::format("{} files are being written or read already; try again", errands_.size()));
    }
    errands_.push_back({std::async(std::launch::async, std::move(work)), client});
}

void Session::save(const std::string& name, std::optional<Client> client) {
    // Copied here, which takes a fraction of a frame; compressed and written beside the frames.
    auto copy = std::make_shared<const sand::SandCopy>(terrain_.copySand());
    SavedSand saved{place_, terrain_.stepNumber(), hash_, {}};
    runErrand(
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
        client);
}

void Session::load(const std::string& name, std::optional<Client> client) {
    runErrand(
        [file = saveFile(options_.out, name), place = place_] {
            return ErrandDone{{}, sand::Edit::loaded(readSavedSand(file, place).sand)};
        },
        client);
}

void Session::finishErrands(bool wait) {
    for (std::size_t i = 0; i < errands_.size();) {
        Errand& errand = errands_[i];
        if (!wait && errand.work.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            ++i;
            continue;
        }
        const std::optional<Client> client = errand.client;
        try {
            ErrandDone done = errand.work.get();
            if (done.edit.any()) {
                askEdit(std::move(done.edit), client);
            } else if (client) {
                control_->answer(*client, std::move(done.json));
            }
        } catch (const files::InputError& error) {
            refuse(error.what(), client);
        }
        errands_.erase(errands_.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

}  // namespace master
