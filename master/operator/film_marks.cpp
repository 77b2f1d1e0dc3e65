// SPDX-License-Identifier: Apache-2.0
#include "master/operator/film_marks.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/input_error.hpp"
#include "host/event.hpp"

namespace master {
namespace {

/// Makes film_001, or the first later folder that does not exist, and returns its name.
std::string makeFolder(const std::filesystem::path& out) {
    errno = EEXIST;
    for (int number = 1; errno == EEXIST; ++number) {
        const std::string name = fmt::format("film_{:03}", number);
        if (mkdir((out / name).c_str(), 0755) == 0) {
            return name;
        }
    }
    throw base::InputError(
        fmt::format("film: its folder in {} cannot be made ({})", out.string(), std::strerror(errno)));
}

}  // namespace

FilmMarks::FilmMarks(std::filesystem::path out, int stepsPerSecond)
    : out_(std::move(out)), stepsPerSecond_(stepsPerSecond) {}

MarkedFilm FilmMarks::end(std::uint64_t step) {
    const Begun begun = *std::exchange(begun_, std::nullopt);
    if (step <= begun.step) {
        throw base::InputError(
            "film: the sand has made no step since the film began, so the film would have no picture");
    }
    return {makeFolder(out_), begun.step, step, static_cast<double>(step - begun.step) / stepsPerSecond_, begun.view};
}

std::string inWords(const MarkedFilm& film) {
    const char* const events = std::getenv("SANDWALL_EVENTS");
    if (events != nullptr && std::string_view(events) == "1") {
        return fmt::format("film of {:.1f} s: being made into {}", film.seconds, film.folder);
    }
    return fmt::format("film of {:.1f} s: make it by sandwall film --from {} --to {}{}", film.seconds, film.from,
                       film.to, film.view ? " --view " + film.view->text() : "");
}

void emitEvent(const MarkedFilm& film) {
    host::emitEvent("film",
                    {{"folder", film.folder},
                     {"from", film.from},
                     {"to", film.to},
                     {"seconds", film.seconds},
                     {"view", film.view ? host::EventValue(film.view->text()) : host::EventValue(host::Json{"null"})}});
}

}  // namespace master
