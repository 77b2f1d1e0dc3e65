// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "walls/orbit.hpp"

namespace master {

/// Part of a running session that people have marked for a film.
struct MarkedFilm {
    std::string folder;                // new and empty, in the session's folder: film_001 or a later one
    std::uint64_t from = 0;            // step before the first one
    std::uint64_t to = 0;              // last step
    double seconds = 0;                // [s] of sand
    std::optional<walls::Orbit> view;  // of a desktop when the film began
};

/// The beginning and the end of films that people mark in a running session. Main thread only.
///
/// The launcher makes a film of the journal beside the session, when it reads the event `film` (docs/events.md).
class FilmMarks {
public:
    /// `out` is the session's folder.
    FilmMarks(std::filesystem::path out, int stepsPerSecond);

    [[nodiscard]] bool begun() const { return begun_.has_value(); }
    /// Begins a film behind step `step`, with the present view of a desktop.
    void begin(std::uint64_t step, const std::optional<walls::Orbit>& view) { begun_ = {step, view}; }
    /// Ends the film at step `step`, and makes its folder. Throws base::InputError if no step was shown since begin(),
    /// or if the folder cannot be made; then begun() is false, too. Requires begun().
    [[nodiscard]] MarkedFilm end(std::uint64_t step);

private:
    struct Begun {
        std::uint64_t step = 0;
        std::optional<walls::Orbit> view;
    };

    std::filesystem::path out_;
    int stepsPerSecond_;
    std::optional<Begun> begun_;
};

/// Emits the event `film`.
void emitEvent(const MarkedFilm& film);
/// Returns a sentence for the person who has marked the film. If no launcher reads the event, it names the options of
/// the command that makes the film.
[[nodiscard]] std::string inWords(const MarkedFilm& film);

}  // namespace master
