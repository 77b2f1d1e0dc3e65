// SPDX-License-Identifier: Apache-2.0
#include "master/measure/incidents.hpp"

#include <fmt/format.h>

#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/byte_stream.hpp"
#include "base/input_error.hpp"
#include "host/json_fields.hpp"
#include "host/print_line.hpp"
#include "host/regular_file.hpp"
#include "host/whole_file.hpp"

namespace master {
namespace {

constexpr std::int64_t kSeldomNs = 250'000'000;  // so that a flood of incidents does not become a flood of files
constexpr std::size_t kMostBytes = 1 << 16;      // of the file

Incidents incidentsOf(const std::filesystem::path& file) {
    const host::RegularFile opened(file, host::RegularFile::Links::refused);
    const std::optional<base::Bytes> text = opened.error().empty() ? opened.read(kMostBytes) : std::nullopt;
    if (!text) {
        return {};
    }
    return host::fromJson<Incidents>(nlohmann::ordered_json::parse(*text));
}

}  // namespace

IncidentFile::IncidentFile(const std::filesystem::path& folder, bool resumed) : file_(folder / "incidents.json") {
    if (!resumed) {
        return;
    }
    try {
        before_ = kept_ = incidentsOf(file_);
    } catch (const std::exception& error) {  // such as text that is not JSON, or a negative number
        host::printLine("{}: {}; the summary counts from here on", file_.string(), error.what());
    }
}

void IncidentFile::forget() const { host::forgetFile(file_); }

void IncidentFile::keep(const Incidents& sinceTheBeginning, std::int64_t nowNs) {
    if (sinceTheBeginning == kept_ || (triedNs_ != 0 && nowNs - triedNs_ < kSeldomNs)) {
        return;
    }
    triedNs_ = nowNs;
    write(sinceTheBeginning);
}

void IncidentFile::keepLast(const Incidents& sinceTheBeginning) {
    if (!(sinceTheBeginning == kept_)) {
        write(sinceTheBeginning);
    }
}

void IncidentFile::write(const Incidents& incidents) {
    try {
        host::WholeFile whole(file_, host::WholeFile::Other::refused);
        whole.stream() << host::jsonOf(incidents).dump() << '\n';
        whole.keep();
        kept_ = incidents;
        printedFailure_ = false;
    } catch (const base::InputError& error) {
        if (!std::exchange(printedFailure_, true)) {  // once, because it tries again four times a second
            host::printLine("{}; the incidents are counted, and written when that is possible", error.what());
        }
    }
}

}  // namespace master
