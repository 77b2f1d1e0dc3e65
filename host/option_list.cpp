// SPDX-License-Identifier: Apache-2.0
#include "host/option_list.hpp"

#include <nlohmann/json.hpp>

namespace host {
namespace {

using nlohmann::ordered_json;

ordered_json jsonOf(const ListedOption& option) {
    ordered_json json{{"name", option.name}, {"kind", option.kind}, {"help", option.help}};
    const auto add = [&json](const char* key, const auto& value) {
        if (!value.empty()) {
            json[key] = value;
        }
    };
    const auto addKnown = [&json](const char* key, const auto& value) {
        if (value) {
            json[key] = *value;
        }
    };
    add("metavar", option.metavar);
    addKnown("default", option.fallback);
    add("values", option.values);
    add("beginnings", option.beginnings);
    addKnown(option.aboveLeast ? "above" : "least", option.least);
    addKnown("most", option.most);
    if (option.several) {
        json["several"] = true;
    }
    add("excludes", option.excludes);
    add("offered_by", option.offeredBy);
    return json;
}

ordered_json jsonOf(const OptionList& list) {
    ordered_json json{{"name", list.name}, {"what", list.what}, {"options", ordered_json::array()}};
    for (const ListedOption& option : list.options) {
        json["options"].push_back(jsonOf(option));
    }
    for (const OptionList& command : list.commands) {
        json["commands"].push_back(jsonOf(command));
    }
    for (const auto& [name, words] : list.words) {
        json[name] = words;
    }
    return json;
}

}  // namespace

std::string OptionList::json() const { return jsonOf(*this).dump(1); }

}  // namespace host
