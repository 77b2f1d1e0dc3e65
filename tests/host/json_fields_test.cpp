// SPDX-License-Identifier: Apache-2.0
#include "host/json_fields.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/refusal.hpp"

namespace printed {

enum class Colour : std::uint8_t { red = 3, green };
constexpr auto valuesOf(Colour) {
    return std::array{base::Named{Colour::red, "red"}, base::Named{Colour::green, "green"}};
}

struct Point {
    int x = 0;
    double y = 0;
    static void fields(auto& it, auto& visit) {
        visit("x", base::limited(it.x, -9, 9));
        visit("y", it.y);
    }
};

struct All {
    bool shown = true;
    Colour colour = Colour::green;
    std::string name = "tool";
    std::optional<double> width, height = 0.5;
    std::optional<Point> other;
    std::optional<std::uint64_t> later;
    std::vector<Point> path{{1, 2}, {3, 4}};
    std::vector<std::string> lines{"a"};
    std::array<std::uint64_t, 2> counts{5, 6};
    std::uint32_t steps = 7;
    Point place{8, 9};
    host::Json raw{R"({"b":1,"a":[null]})"};
    static void fields(auto& it, auto& visit) {
        visit("shown", it.shown);
        visit("colour", it.colour);
        visit("size/name", base::text(it.name, 2));
        visit("size/width", it.width);
        visit("size/height", it.height);
        visit("other", it.other);
        visit("later", host::ifThere(it.later));
        visit("path", base::upTo(it.path, 9));
        visit("lines", base::texts(it.lines, 9));
        visit("counts", base::byName<Colour>(it.counts));
        visit("steps", base::varint(it.steps));
        visit("place", it.place);
        visit("place/sum", it.place.x + it.place.y);
        visit("raw", it.raw);
    }
};

struct Counts {
    std::uint64_t all = 0;
    std::array<std::uint64_t, 2> byColour{};
    std::optional<std::uint64_t> rank;
    std::optional<double> seconds;
    std::optional<std::uint64_t> later;
    std::string text;
    static void fields(auto& it, auto& visit) {
        visit("all", it.all);
        visit("by/colour", base::byName<Colour>(it.byColour));
        visit("rank", it.rank);
        visit("seconds", it.seconds);
        visit("later", host::ifThere(it.later));
        visit("text", it.text);
    }
    friend bool operator==(const Counts&, const Counts&) = default;
};

}  // namespace printed

namespace {

using nlohmann::ordered_json;
using printed::All;
using printed::Counts;

TEST(JsonFields, AreWrittenInTheirOrderUnderTheirNames) {
    EXPECT_EQ(host::jsonOf(All{}).dump(),
              R"({"shown":true,"colour":"green","size":{"name":"tool","width":null,"height":0.5},"other":null,)"
              R"("path":[{"x":1,"y":2.0},{"x":3,"y":4.0}],"lines":["a"],"counts":{"red":5,"green":6},"steps":7,)"
              R"("place":{"x":8,"y":9.0,"sum":17.0},"raw":{"b":1,"a":[null]}})");
    All all;
    all.other = printed::Point{-1, 0};
    all.later = 4;
    const ordered_json written = host::jsonOf(all);
    EXPECT_EQ(written.at("other"), (ordered_json{{"x", -1}, {"y", 0.0}}));
    EXPECT_EQ(written.at("later"), 4);
}

TEST(JsonFields, JoinTheFieldsOfAnObject) {
    nlohmann::json written{{"place", {{"z", 1}}}, {"frame", 2}};
    host::JsonWriter writer(written);
    All::fields(*std::make_unique<const All>(), writer);
    EXPECT_EQ(written["place"], (nlohmann::json{{"x", 8}, {"y", 9.0}, {"sum", 17.0}, {"z", 1}}));
    EXPECT_EQ(written["frame"], 2);
}

TEST(JsonFields, ComeBackAsTheyWent) {
    for (const Counts& counts : {Counts{}, Counts{1, {2, 3}, 4, 0.5, 6, "seven"}}) {
        EXPECT_EQ(host::fromJson<Counts>(host::jsonOf(counts)), counts);
    }
}

TEST(JsonFields, NameTheKeyAndTheValueThatIsNotAllowed) {
    const ordered_json good = host::jsonOf(Counts{1, {2, 3}, 4, 0.5, 6, "seven"});
    const auto refusal = [&good](const char* key, const ordered_json& value) {
        ordered_json written = good;
        written[ordered_json::json_pointer(key)] = value;
        return test::refusalOf([&] { (void)host::fromJson<Counts>(written); });
    };
    const std::string count = " must be a whole number from 0 to 1000000000000";
    EXPECT_EQ(refusal("/all", 1'000'000'000'000U), "nothing");
    EXPECT_EQ(refusal("/all", 1'000'000'000'001U), "all" + count + ", got 1000000000001");
    EXPECT_EQ(refusal("/all", -1), "all" + count + ", got -1");
    EXPECT_EQ(refusal("/all", 0.5), "all" + count + ", got 0.5");
    EXPECT_EQ(refusal("/all", nullptr), "all" + count + ", got null");
    EXPECT_EQ(refusal("/all", std::string(99, 'x')), "all" + count + ", got \"" + std::string(39, 'x'));
    EXPECT_EQ(refusal("/by/colour/green", "2"), "by/colour/green" + count + ", got \"2\"");
    EXPECT_EQ(refusal("/by", 2), "by/colour/red" + count + ", got null");
    EXPECT_EQ(refusal("/rank", nullptr), "nothing");
    EXPECT_EQ(refusal("/rank", -1), "rank" + count + " or null, got -1");
    EXPECT_EQ(refusal("/seconds", 3), "nothing");
    EXPECT_EQ(refusal("/seconds", -0.5), "seconds must be a number from 0 to 1000000000000 or null, got -0.5");
    EXPECT_EQ(refusal("/later", nullptr), "later" + count + ", got null");
    EXPECT_EQ(refusal("/text", 1), "text must be a text, got 1");
}

TEST(JsonFields, RefuseAKeyThatIsMissing) {
    const ordered_json good = host::jsonOf(Counts{1, {2, 3}, 4, 0.5, 6, "seven"});
    for (const char* key : {"all", "by", "rank", "seconds", "later", "text"}) {
        ordered_json written = good;
        written.erase(key);
        EXPECT_EQ(test::refusalOf([&] { (void)host::fromJson<Counts>(written); }) == "nothing",
                  key == std::string("later"))
            << key;
    }
}

}  // namespace
