// SPDX-License-Identifier: Apache-2.0
#include "base/fields.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "base/field_forms.hpp"
#include "tests/support/refusal.hpp"

namespace described {

enum class Colour : std::uint8_t { red = 1, green = 4 };
constexpr auto valuesOf(Colour) {
    return std::array{base::Named{Colour::red, "red"}, base::Named{Colour::green, "green"}};
}

struct Point {
    std::int32_t x = 0;
    double y = 0;
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("x", it.x);
        visit("y", it.y);
    }
    friend bool operator==(const Point&, const Point&) = default;
};

struct All {
    Point place;
    Colour colour = Colour::red;
    bool shown = false, small = false, round = false;
    std::array<std::uint8_t, 2> key{};
    std::array<std::uint16_t, 2> sides{};
    std::optional<Point> other;
    std::optional<double> width;
    std::uint32_t count = 0;
    double share = 0, any = 0;
    std::vector<Point> path;
    std::string name;
    std::vector<std::string> lines;
    base::Bytes block, rest;
    [[nodiscard]] std::string refusal() const { return small && round ? "small and round at once" : ""; }
    template <class Self, class Visit>
    static void fields(Self& it, Visit& visit) {
        visit("magic", base::constant(std::uint16_t{0x0102}, "the magic number"));
        visit("place", it.place);
        visit("colour", it.colour);
        visit("shown", it.shown);
        visit("form", base::flags(it.small, it.round));
        visit("key", it.key);
        visit("sides", it.sides);
        visit("other", it.other);
        visit("width", base::spacedOptional(it.width));
        visit("count", base::varint(it.count));
        visit("share", base::limited(it.share, 0, 1));
        visit("any", base::anyFloat(it.any));
        visit("path", base::upTo<std::uint8_t>(it.path, 3));
        visit("name", base::text(it.name, 4));
        visit("lines", base::texts(it.lines, 4));
        visit("block", base::block(it.block));
        visit("rest", base::rest(it.rest));
    }
    friend bool operator==(const All&, const All&) = default;
};

All full() {
    All all;
    all.place = {1, 0.5};
    all.colour = Colour::green;
    all.shown = all.round = true;
    all.key = {7, 8};
    all.sides = {0x0a0b, 12};
    all.other = Point{-2, 4};
    all.width = 0.25;
    all.count = 300;
    all.share = 1;
    all.any = std::numeric_limits<double>::infinity();
    all.path = {{3, 0}, {4, 0}};
    all.name = "tool";
    all.lines = {"a", ""};
    all.block = {1};
    all.rest = {9, 9};
    return all;
}

struct Counted {
    std::array<std::uint16_t, 2> counts{};
    static void fields(auto& it, auto& visit) { visit("counts", base::byName<Colour>(it.counts)); }
};

struct Small {
    std::uint8_t number = 0;
    static void fields(auto& it, auto& visit) { visit("number", base::varint(it.number)); }
};

struct Long {
    std::vector<std::uint8_t> numbers;
    static void fields(auto& it, auto& visit) { visit("numbers", base::upTo(it.numbers, std::size_t{1} << 60)); }
};

struct Noted {
    std::optional<std::string> note;
    static void fields(auto& it, auto& visit) { visit("note", base::optionalText(it.note, 4)); }
};

/// A vector as those of GLM are.
struct Direction {
    using value_type = float;
    std::array<float, 2> numbers{};
    static constexpr int length() { return 2; }
    float& operator[](int i) { return numbers.at(static_cast<std::size_t>(i)); }
    const float& operator[](int i) const { return numbers.at(static_cast<std::size_t>(i)); }
    friend bool operator==(const Direction&, const Direction&) = default;
};

struct Further {
    bool first = false, second = false;
    Direction direction;
    std::optional<Direction> window;
    std::pair<std::int8_t, std::int16_t> edge;
    std::vector<std::uint8_t> colour{0, 0};
    std::optional<Point> material;
    std::vector<std::int8_t> tiles;
    static void fields(auto& it, auto& visit) {
        visit("keeps", base::flags<std::int32_t>(it.first, it.second));
        visit("direction", it.direction);
        visit("window", base::spacedOptional(it.window));
        visit("edge", it.edge);
        visit("colour", base::exactly(it.colour, 2));
        visit("material", base::optionalBlock(it.material));
        visit("tiles", base::toEnd(it.tiles));
    }
    friend bool operator==(const Further&, const Further&) = default;
};

struct Versioned {
    std::uint8_t version = 1, value = 7;
    static void fields(auto& it, auto& visit) {
        visit("version", it.version);
        if (visit.knows(it.version == 1)) {
            visit("value", it.value);
        }
    }
};

void put(base::Bytes& bytes, double number) {
    const std::size_t end = bytes.size();
    bytes.resize(end + sizeof number);
    std::memcpy(&bytes[end], &number, sizeof number);
}

void put(base::Bytes& bytes, std::initializer_list<std::uint8_t> more) { bytes.insert(bytes.end(), more); }

}  // namespace described

namespace {

using described::All;
using described::full;
using described::Long;
using described::Noted;
using described::Point;
using described::Small;
using described::Versioned;

TEST(Fields, ComeBackAsTheyWent) {
    EXPECT_EQ(base::decoded<All>(base::encoded(full())), full());
    EXPECT_EQ(base::decoded<All>(base::encoded(All{})), All{});
}

TEST(Fields, HaveTheBytesOfTheirForms) {
    base::Bytes expected{2, 1, 1, 0, 0, 0};
    described::put(expected, 0.5);
    described::put(expected,
                   std::initializer_list<std::uint8_t>{4, 1, 2, 7, 8, 0x0b, 0x0a, 12, 0, 1, 0xfe, 0xff, 0xff, 0xff});
    described::put(expected, 4);
    expected.push_back(1);
    described::put(expected, 0.25);
    described::put(expected, std::initializer_list<std::uint8_t>{0xac, 0x02});
    described::put(expected, 1);
    described::put(expected, std::numeric_limits<double>::infinity());
    described::put(expected, std::initializer_list<std::uint8_t>{2, 3, 0, 0, 0});
    described::put(expected, 0);
    described::put(expected, std::initializer_list<std::uint8_t>{4, 0, 0, 0});
    described::put(expected, 0);
    described::put(expected, std::initializer_list<std::uint8_t>{4,   0, 0, 0, 't', 'o', 'o', 'l', 2, 1, 0, 0, 0,
                                                                 'a', 0, 0, 0, 0,   1,   0,   0,   0, 1, 9, 9});
    EXPECT_EQ(base::encoded(full()), expected);
}

TEST(Fields, AreRefusedWhereverTheyAreCutShort) {
    const base::Bytes whole = base::encoded(full());
    for (std::size_t length = 0; length + full().rest.size() < whole.size(); ++length) {
        EXPECT_THROW((void)base::decoded<All>(std::span(whole).first(length)), base::FormatError) << length;
    }
}

std::string refusalOf(const All& all) {
    return test::refusalOf<base::FormatError>([&] { (void)base::decoded<All>(base::encoded(all)); });
}

/// Returns why the bytes of full() are refused after one of them has changed.
std::string refusalWith(std::size_t at, std::uint8_t byte) {
    base::Bytes bytes = base::encoded(full());
    bytes.at(at) = byte;
    return test::refusalOf<base::FormatError>([&] { (void)base::decoded<All>(bytes); });
}

TEST(Fields, NameWhatIsWrong) {
    EXPECT_EQ(refusalWith(0, 3), "magic: is 259, not the magic number");
    EXPECT_EQ(refusalWith(14, 2), "colour: is 2, which is unknown");
    EXPECT_EQ(refusalWith(15, 2), "shown: is 2, neither 0 nor 1");
    EXPECT_EQ(refusalWith(16, 4), "form: is 4, with unknown bits");
    EXPECT_EQ(refusalWith(16, 3), "small and round at once");
    EXPECT_EQ(refusalWith(23, 7), "other: is 7, neither 0 nor 1");
    EXPECT_EQ(refusalWith(63, 4), "path: has 4 elements; at most 3 are allowed");
    EXPECT_EQ(refusalWith(88, 5), "name: has 5 bytes; at most 4 are allowed");
}

TEST(Fields, RefuseNumbersThatAreNotFiniteOrOutOfRange) {
    All all = full();
    for (const double number : {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
        all.place.y = number;
        EXPECT_EQ(refusalOf(all), "place: y: is not finite");
    }
    all = full();
    for (const double share : {-0.5, 2.0}) {
        all.share = share;
        EXPECT_EQ(refusalOf(all), fmt::format("share: is {}, not from 0 to 1", share));
    }
    all.share = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusalOf(all), "nothing");
}

TEST(Fields, RefuseANumberThatDoesNotFitItsMember) {
    EXPECT_EQ(base::decoded<Small>(base::Bytes{0xff, 0x01}).number, 255);
    EXPECT_EQ(test::refusalOf<base::FormatError>([] {
                  (void)base::decoded<Small>(base::Bytes{0x80, 0x02});
              }),
              "number: is 256, which is too large");
}

TEST(Fields, RefuseBytesBehindTheEnd) {
    base::Bytes bytes = base::encoded(Point{1, 2});
    EXPECT_EQ(base::decoded<Point>(bytes), (Point{1, 2}));
    bytes.push_back(0);
    EXPECT_EQ(test::refusalOf<base::FormatError>([&] { (void)base::decoded<Point>(bytes); }),
              "bytes behind its end: 1");
}

// A list of a hostile peer takes no memory for elements that are not there.
TEST(Fields, AListTakesMemoryOnlyForItsBytes) {
    base::ByteWriter writer;
    writer.putVarint(std::uint64_t{1} << 60);
    writer.putBytes(base::Bytes(10, 1));
    EXPECT_NE(test::refusalOf<base::FormatError>([&] {
                  (void)base::decoded<Long>(writer.bytes());
              }).find("numbers: cut short"),
              std::string::npos);
}

TEST(Fields, ATextThatIsMissingHasOneByte) {
    const base::Bytes missing{0}, empty{1, 0, 0, 0, 0}, whole{1, 4, 0, 0, 0, 't', 'o', 'o', 'l'};
    EXPECT_EQ(base::encoded(Noted{}), missing);
    EXPECT_EQ(base::encoded(Noted{""}), empty);
    EXPECT_EQ(base::encoded(Noted{"tool"}), whole);
    EXPECT_EQ(base::decoded<Noted>(missing).note, std::nullopt);
    EXPECT_EQ(base::decoded<Noted>(empty).note, "");
    EXPECT_EQ(base::decoded<Noted>(whole).note, "tool");
    const auto refusal = [](const base::Bytes& bytes) {
        return test::refusalOf<base::FormatError>([&] { (void)base::decoded<Noted>(bytes); });
    };
    EXPECT_EQ(refusal({2}), "note: is 2, neither 0 nor 1");
    EXPECT_EQ(refusal({1, 5, 0, 0, 0, 't', 'o', 'o', 'l', 's'}), "note: has 5 bytes; at most 4 are allowed");
}

TEST(Fields, ByNameHaveTheBytesOfTheirArray) {
    const base::Bytes bytes{1, 2, 3, 4};
    EXPECT_EQ(base::encoded(described::Counted{{0x0201, 0x0403}}), bytes);
    EXPECT_EQ(base::decoded<described::Counted>(bytes).counts, (std::array<std::uint16_t, 2>{0x0201, 0x0403}));
}

TEST(Fields, HaveTheBytesOfTheirFurtherForms) {
    described::Further further;
    further.second = true;
    further.direction.numbers = {1, -2};
    further.edge = {-1, 258};
    further.colour = {9, 8};
    further.material = Point{5, 0};
    further.tiles = {4, -4};
    const base::Bytes expected{2, 0, 0, 0, 0,  0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff,
                               2, 1, 9, 8, 12, 0, 0,    0,    5, 0, 0, 0,    0, 0, 0, 0, 0, 0, 0, 0, 4, 0xfc};
    EXPECT_EQ(base::encoded(further), expected);
    EXPECT_EQ(base::decoded<described::Further>(expected), further);
    further.window = described::Direction{{3, 4}};
    further.material.reset();
    further.tiles.clear();
    EXPECT_EQ(base::encoded(further).size(), expected.size() - 12 - 2);
    EXPECT_EQ(base::decoded<described::Further>(base::encoded(further)), further);
}

TEST(Fields, NameWhatIsWrongInTheirFurtherForms) {
    described::Further further;
    further.material = Point{5, 0};
    const base::Bytes whole = base::encoded(further);
    const auto refusalWith = [&](std::size_t at, std::uint8_t byte) {
        base::Bytes bytes = whole;
        bytes.at(at) = byte;
        return test::refusalOf<base::FormatError>([&] { (void)base::decoded<described::Further>(bytes); });
    };
    EXPECT_EQ(refusalWith(3, 0x80), "keeps: is 2147483648, with unknown bits");
    EXPECT_EQ(refusalWith(0, 4), "keeps: is 4, with unknown bits");
    EXPECT_EQ(refusalWith(26, 13).find("material: cut short"), 0U) << "the block is longer than the rest";
    EXPECT_EQ(refusalWith(26, 11).find("material: y: cut short"), 0U);
    base::Bytes longer = whole;
    longer[26] = 13;
    longer.push_back(0);
    EXPECT_EQ(test::refusalOf<base::FormatError>([&] { (void)base::decoded<described::Further>(longer); }),
              "material: bytes behind its end: 1");
    base::Bytes infinite = whole;
    infinite[6] = 0x80;
    infinite[7] = 0x7f;
    EXPECT_EQ(test::refusalOf<base::FormatError>([&] { (void)base::decoded<described::Further>(infinite); }),
              "direction: is not finite");
}

// A newer version of a message begins as the others do, and may be any bytes after that.
TEST(Fields, OfAnUnknownLayoutAreSkippedByTheReaderAlone) {
    EXPECT_EQ(base::encoded(Versioned{2, 5}), (base::Bytes{2, 5}));
    const auto other = base::decoded<Versioned>(base::Bytes{2, 5, 6, 7});
    EXPECT_EQ(other.version, 2);
    EXPECT_EQ(other.value, 7);
    EXPECT_THROW((void)base::decoded<Versioned>(base::Bytes{1, 5, 6}), base::FormatError);
}

TEST(Names, AreFoundBothWays) {
    EXPECT_EQ(base::nameOf(described::Colour::green), "green");
    EXPECT_EQ(base::nameOf(static_cast<described::Colour>(2)), "");
    EXPECT_EQ(base::valueNamed<described::Colour>("red"), described::Colour::red);
    EXPECT_EQ(base::valueNamed<described::Colour>("Red"), std::nullopt);
    EXPECT_EQ(base::namesOf<described::Colour>(), (std::array<std::string_view, 2>{"red", "green"}));
}

}  // namespace
