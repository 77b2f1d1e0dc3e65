// SPDX-License-Identifier: Apache-2.0
#include "master/measure/failure_report.hpp"

#include <nlohmann/json.hpp>

#include "base/input_error.hpp"
#include "host/event.hpp"
#include "host/json_fields.hpp"
#include "host/print_line.hpp"
#include "host/whole_file.hpp"

namespace master {

bool writeFailure(const FailureReport& failure, const std::filesystem::path& folder) {
    const nlohmann::ordered_json json = host::jsonOf(failure);
    // The event is emitted even if OUT cannot be written. The launcher then reads the event.
    host::emitEvent("failure",
                    {{"failure", host::Json{json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)}}});
    try {
        host::WholeFile file(folder / "failure.json", host::WholeFile::Other::refused);
        file.stream() << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
        file.keepSynced();
        return true;
    } catch (const base::InputError& error) {
        host::printLine("{}", error.what());
        return false;
    }
}

}  // namespace master
