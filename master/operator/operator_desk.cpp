// SPDX-License-Identifier: Apache-2.0
#include "master/operator/operator_desk.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/input_error.hpp"
#include "host/clock.hpp"
#include "host/event.hpp"
#include "host/json_fields.hpp"
#include "host/print_line.hpp"
#include "master/operator/verbs.hpp"
#include "walls/stereo_change.hpp"
#include "walls/window_size.hpp"

namespace master {
namespace {

using Json = nlohmann::json;

Json orNull(const std::optional<double>& number) { return number ? Json(*number) : Json(); }

}  // namespace

OperatorDesk::OperatorDesk(const scene::Scene& scene, const scene::Material& material, const walls::Wall& wall,
                           std::filesystem::path out, const DeskOptions& options, SessionParts session)
    : wall_(wall),
      shown_(wall),
      place_(SandPlace::of(scene)),
      grid_(scene.grid()),
      material_(material),
      out_(std::move(out)),
      session_(std::move(session)),
      views_(wall, scene, options.tracker),
      input_(options.readInput),
      undo_({session_.sand, jobs_, place_.mostBytes,
             [this](sand::Edit edit, const scene::UndoHistory::Return& wanted, const Asker& asker) {
                 return addReturn(std::move(edit), wanted, asker);
             },
             [this](const std::string& why, const Askers& askers) { refuse(why, askers); }}),
      captures_(out_),
      films_(out_, scene.rules.stepsPerSecond),
      force_(options.force),
      film_(options.film),
      windows_(scene, out_, options.pointer,
               {views_, material_, paused_, walls::followsWindow(wall),
                [this] { return session_.sand.replica().surface().heights(); },
                [this](const std::string& command, int rank) { carryOut(*this, command, Asker::at(rank)); }}) {
    if (session_.force != nullptr) {
        control_.emplace(out_);
    }
    views_.show(options.pattern);
    views_.show(options.layers);
    views_.setHumidity(material_.humidity);
    windows_.frameView();
    if (options.view) {
        views_.show(*options.view);
    }
    if (options.visibleTool) {
        windows_.enlargeTool();
    }
    if (const int port = views_.viewer().port(); port != 0) {
        fmt::print("head tracking listens on port {}\n", port);
        std::fflush(stdout);
        host::emitEvent("head_tracking", {{"state", "listening"}, {"port", port}});
    }
}

void OperatorDesk::obey(const std::vector<lockstep::Arrival>& arrivals) {
    const std::vector<std::string> lines = input_.takeLines();
    if (control_) {
        for (const std::string& typed : lines) {
            obeyLine(typed, {});
        }
        for (const ControlSocket::Asked& asked : control_->take()) {
            obeyLine(asked.line, {.client = asked.client});
        }
    }
    finishJobs(false);
    undo_.proceed();
    for (std::size_t rank = 0; rank < arrivals.size(); ++rank) {
        if (arrivals[rank].key.code != 0) {
            windows_.obey(arrivals[rank].key, static_cast<int>(rank), host::monotonicNs());
        }
    }
}

void OperatorDesk::obeyLine(const std::string& text, const Asker& asker) {
    try {
        if (carryOut(*this, text, asker) == Answered::atOnce && asker.client) {
            control_->answer(*asker.client, answerLine({{"ok", true}}));
        }
    } catch (const base::InputError& error) {
        refuse(error.what(), {asker});
    }
}

void OperatorDesk::pause(bool paused) {
    paused_ = paused;
    answerSettle({});  // a paused session would let the client wait
}

void OperatorDesk::showPattern(std::optional<lockstep::Pattern> pattern) {
    views_.show(pattern.value_or(lockstep::nextPattern(views_.pattern())));
}

void OperatorDesk::changeTool(const scene::ToolChange& change, const Asker& asker) {
    askMaterial(scene::withTool(material_, change, grid_), asker);
}

void OperatorDesk::changeMaterial(const MaterialChange& change, const Asker& asker) {
    askMaterial(scene::withNumber(material_, change.word, change.number, grid_), asker);
}

void OperatorDesk::shareForce(double share, const Asker& asker) {
    session_.force->shareForce(share);
    force_ = share;
    host::emitEvent("force", {{"share", share}});
    session_.keepForce(share);
    const std::optional<double> ceiling = session_.force->forceCeiling();
    Json answer{{"ok", true}, {"force_share", share}, {"force_ceiling", orNull(ceiling)}};
    const bool capped = ceiling && *ceiling < share;
    if (capped) {
        answer["note"] = fmt::format(
            "the hand feels {:g} of the force, because --force or --force-scale of the haptic server is a ceiling; "
            "start that server with a higher one, or with --force-until-ctl",
            *ceiling);
    }
    if (asker.client) {
        control_->answer(*asker.client, answerLine(answer));
    } else if (capped) {
        host::printLine("{}", answer["note"].get<std::string>());
    }
}

void OperatorDesk::swapEyes(bool swapEyes) {
    if (walls::eyesOf(shown_.stereo).size() < 2) {
        throw base::InputError(
            fmt::format("swap-eyes: the wall shows one eye ({}), so there is nothing to swap; choose a mode with two "
                        "eyes first, such as stereo anaglyph",
                        walls::stereoName(shown_.stereo)));
    }
    showWall(shown_.stereo, window_, swapEyes);
}

void OperatorDesk::followWindow(const std::vector<lockstep::Arrival>& arrivals) {
    if (film_ || !walls::followsWindow(wall_) || arrivals.size() < 2) {
        return;
    }
    const glm::ivec2 window(arrivals[1].window[0], arrivals[1].window[1]);
    if (window != glm::ivec2(0) && window != window_) {
        showWall(shown_.stereo, window, shown_.swapEyes);
    }
}

void OperatorDesk::showWall(walls::Stereo stereo, glm::ivec2 window, bool swapEyes) {
    shown_ = walls::withSwappedEyes(walls::shownInWindow(walls::shownOnItsOutputs(wall_, stereo), window), swapEyes);
    window_ = window;
    views_.show(stereo);
    views_.show(window);
    views_.swapEyes(swapEyes);
}

void OperatorDesk::save(const std::string& name, const Asker& asker) {
    jobs_.requireRoom();
    // Copying takes a fraction of a frame. A thread compresses and writes the copy while frames continue.
    auto copy = session_.sand.replica().copySand();
    SavedSand saved{place_, session_.sand.replica().stepNumber(), session_.sand.hash(), {}};
    jobs_.start(
        [copy = std::move(copy), saved = std::move(saved), file = saveFile(out_, name)]() mutable {
            saved.sand = copy->encode();
            copy.reset();
            writeSavedSand(file, saved);
            return BackgroundJobs::Result{answerLine({{"ok", true},
                                                      {"file", "saves/" + file.filename().string()},
                                                      {"bytes", saved.sand.size()},
                                                      {"step", saved.step},
                                                      {"state_hash", fmt::format("{:016x}", saved.stateHash)}}),
                                          {},
                                          fmt::format("sand saved as saves/{}", file.filename().string())};
        },
        {asker});
}

void OperatorDesk::load(const std::string& name, const Asker& asker) {
    jobs_.requireRoom();
    jobs_.start(
        [file = saveFile(out_, name), place = place_, read = session_.sand.replica().sandReader()] {
            return BackgroundJobs::Result{{}, sand::Edit::loaded(readSavedSand(file, place, read).sand)};
        },
        {asker});
}

void OperatorDesk::finishJobs(bool wait) {
    for (BackgroundJobs::Done& done : jobs_.finished(wait)) {
        try {
            if (done.kind == BackgroundJobs::Kind::undo) {
                undo_.take(std::move(done));
            } else if (!done.error.empty()) {
                refuse(done.error, done.askers);
            } else if (done.result.edit.any()) {
                askEdit(std::move(done.result.edit), done.askers.front());
            } else {
                answerAll(done.askers, done.result);
            }
        } catch (const base::InputError& error) {
            refuse(error.what(), done.askers);
        }
    }
}

void OperatorDesk::markFilm(const Asker& asker) {
    if (!session_.keepsJournal) {
        throw base::InputError("film: a film is made of the journal, and this session keeps none");
    }
    BackgroundJobs::Result answer;
    if (films_.begun()) {
        answer = endFilm();
    } else {
        const std::uint64_t step = session_.sand.replica().stepNumber();
        films_.begin(step, views_.orbit());
        answer.json = answerLine({{"ok", true}, {"film", "begins"}, {"step", step}});
        answer.words = "film begins; the same again ends it";
    }
    if (!asker.client && !asker.window) {
        host::printLine("{}", answer.words);
    }
    answerAll({asker}, answer);
}

/// Ends the film that has begun. Throws as FilmMarks::end() does.
BackgroundJobs::Result OperatorDesk::endFilm() {
    const MarkedFilm film = films_.end(session_.sand.replica().stepNumber());
    emitEvent(film);
    BackgroundJobs::Result answer;
    answer.json = answerLine({{"ok", true},
                              {"film", "ends"},
                              {"folder", film.folder},
                              {"from", film.from},
                              {"to", film.to},
                              {"seconds", film.seconds},
                              {"view", film.view ? Json(film.view->text()) : Json()}});
    answer.words = inWords(film);
    return answer;
}

void OperatorDesk::close() {
    if (films_.begun()) {
        try {
            host::printLine("{}", endFilm().words);
        } catch (const base::InputError& error) {
            host::printLine("{}", error.what());
        }
    }
    finishJobs(true);
    answerSettle({});
    control_.reset();
}

void OperatorDesk::takeCapture(std::uint64_t frame, lockstep::FrameBarrier& barrier) {
    captures_.take(frame, session_.sand, shown_, barrier, jobs_);
}

void OperatorDesk::reportStatus(const Asker& asker) {
    Json status = session_.status();
    status["ok"] = true;
    status["paused"] = paused_;
    status["pattern"] = std::string(lockstep::patternName(views_.pattern()));
    status["stereo"] = std::string(walls::stereoName(shown_.stereo));
    status["swap_eyes"] = shown_.swapEyes;
    status["eye_separation"] = views_.eyeSeparation();
    status["material"] = host::jsonOf<Json>(scene::MaterialNumbers{material_});
    status["force_share"] = orNull(force_);
    status["force_ceiling"] = orNull(session_.force->forceCeiling());
    status["edits_waiting"] = session_.edits.waiting().size();
    if (asker.client) {
        control_->answer(*asker.client, answerLine(status));
    } else {
        fmt::print("{}\n", answerLine(status));
        std::fflush(stdout);
    }
}

void OperatorDesk::answerAll(const Askers& askers, const BackgroundJobs::Result& result) {
    for (const Asker& asker : askers) {
        if (asker.client) {
            control_->answer(*asker.client, result.json);
        } else if (asker.window) {
            windows_.answer(*asker.window, result.words);
        }
    }
}

void OperatorDesk::refuse(const std::string& why, const Askers& askers) {
    for (const Asker& asker : askers) {
        if (asker.client) {
            control_->answer(*asker.client, answerLine({{"ok", false}, {"error", why}}));
        } else if (asker.window) {
            windows_.answer(*asker.window, why);
        } else {
            host::printLine("{}", why);
            host::emitEvent("command_refused", {{"error", why}});
        }
    }
}

}  // namespace master
