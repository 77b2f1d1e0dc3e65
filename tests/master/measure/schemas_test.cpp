// SPDX-License-Identifier: Apache-2.0
// Compares docs/schemas with the fields that the described types list. schema_test.py validates files of real sessions.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "host/json_fields.hpp"
#include "master/measure/failure_report.hpp"
#include "master/measure/recovery.hpp"
#include "master/measure/summary.hpp"
#include "scene/model/material.hpp"
#include "tests/support/files/folder_test.hpp"

namespace {

using Json = nlohmann::json;
using Keys = std::set<std::string>;

Json parsed(const std::filesystem::path& file) { return Json::parse(std::ifstream(file)); }

Json schemaOf(const std::string& name) {
    return parsed(std::filesystem::path(SANDWALL_SOURCE_DIR) / "docs" / "schemas" / (name + ".schema.json"));
}

Keys keysOf(const Json& object) {
    Keys keys;
    for (const auto& [key, value] : object.items()) {
        keys.insert(key);
    }
    return keys;
}

/// Collects the keys that a list of fields visits, up to the first '/'.
struct KeyCollector {
    Keys keys{};
    void operator()(std::string_view name, const auto& /*member*/) {
        keys.insert(std::string(name.substr(0, name.find('/'))));
    }
};

/// Compares the keys of `value`, and of all objects in it, with those of the schema `part` of the file `whole`.
void compare(const Json& value, const Json& part, const Json& whole, const std::string& where) {
    if (part.contains("$ref")) {
        const std::string place = part["$ref"].get<std::string>().substr(1);  // "#/definitions/count"
        compare(value, whole.at(Json::json_pointer(place)), whole, where);
    } else if (value.is_array()) {
        for (const Json& element : value) {
            compare(element, part.at("items"), whole, where + "[]");
        }
    } else if (value.is_object()) {
        const bool named = part.contains("propertyNames");
        const Keys known = named ? part.at("/propertyNames/enum"_json_pointer).get<Keys>()
                                 : keysOf(part.value("properties", Json::object()));
        EXPECT_EQ(keysOf(value), known) << where;
        for (const auto& [key, inside] : value.items()) {
            if (!named && known.contains(key)) {
                compare(inside, part["properties"][key], whole, where + "/" + key);
            }
        }
    }
}

using SchemaFiles = test::FolderTest;

/// Returns a summary in which every optional value is there.
master::Summary wholeSummary() {
    master::Summary summary;
    summary.terrain = {{"valley.asc", "metres", "EPSG:32633", "feet", "vertical datum", "-9999", 0.25}};
    summary.haptic.emplace().hapticPeriodUsMax = 1;
    summary.tracking.emplace();
    summary.ranksReports.resize(1);
    summary.tileNames = {"r1c1"};
    summary.rankStatistics.resize(2);
    summary.rankNames = {"the master", "rank 1"};
    summary.drag = lockstep::Drag{1, 1, 2};
    summary.incidents.firstDifference = 3;
    summary.dark.resize(1);
    return summary;
}

TEST_F(SchemaFiles, OfTheSummaryHasTheKeysThatItsTypesList) {
    master::Summary summary = wholeSummary();
    master::reportRecovery({.failure = {.what = "rank 1 died", .rank = 1, .how = "SIGKILL"}}, folder_);
    for (const std::string& recovery : master::recoveriesOf(folder_)) {
        Json line = Json::parse(recovery);
        line["seconds_to_link"] = 1;  // only the launcher writes it
        summary.recoveries.push_back({line.dump()});
    }
    ASSERT_EQ(summary.recoveries.size(), 1U);
    master::writeSummary(summary, folder_ / "summary.json");
    const Json schema = schemaOf("summary");
    compare(parsed(folder_ / "summary.json"), schema, schema, "summary");
}

TEST_F(SchemaFiles, OfTheSummaryRequiresEveryKeyThatIsAlwaysThere) {
    Keys keys = keysOf(schemaOf("summary")["properties"]);
    keys.erase("head_tracking");
    EXPECT_EQ(schemaOf("summary")["required"].get<Keys>(), keys);
    master::Summary summary = wholeSummary();
    summary.tracking.reset();
    EXPECT_EQ(keysOf(host::jsonOf<Json>(summary)), keys);
    summary.haptic.reset();
    const Json haptic = host::jsonOf<Json>(summary)["haptic"];
    EXPECT_EQ(keysOf(haptic), schemaOf("summary")["properties"]["haptic"]["required"].get<Keys>());
    EXPECT_EQ(keysOf(haptic["refused"]), (Keys{"connections", "servers"}));
}

TEST_F(SchemaFiles, OfStatusAndSummaryHaveEveryCounterOfIncidents) {
    KeyCollector counters;
    const master::Incidents incidents;
    master::Incidents::counters(incidents, counters);
    const Json status = schemaOf("status");
    Keys known;
    for (const auto& [key, value] : status["properties"].items()) {
        // Session and OperatorDesk write the other keys one by one, and `edits` is a count of the sand.
        if (key != "edits" && value.value("description", "").starts_with("The same count as in summary.json")) {
            known.insert(key);
        }
    }
    EXPECT_EQ(counters.keys, known);
    EXPECT_EQ(status["required"].get<Keys>(), keysOf(status["properties"])) << "status has all keys in each session";
    for (const std::string& key : counters.keys) {
        EXPECT_TRUE(schemaOf("summary")["properties"].contains(key)) << key;
    }
}

TEST_F(SchemaFiles, OfStatusHasEveryNumberOfTheMaterial) {
    const Json numbers = host::jsonOf<Json>(scene::MaterialNumbers{scene::Material()});
    const Json material = schemaOf("status")["properties"]["material"];
    EXPECT_EQ(keysOf(numbers), keysOf(material["properties"]));
    EXPECT_EQ(keysOf(numbers), material["required"].get<Keys>());
}

TEST_F(SchemaFiles, OfAFailureHasTheKeysOfItsReport) {
    KeyCollector report;
    const master::FailureReport failure;
    master::FailureReport::fields(failure, report);
    EXPECT_EQ(report.keys, keysOf(schemaOf("failure")["properties"]));
    EXPECT_EQ(report.keys, schemaOf("failure")["required"].get<Keys>());
}

}  // namespace
