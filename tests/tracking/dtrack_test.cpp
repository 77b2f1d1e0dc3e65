// SPDX-License-Identifier: Apache-2.0
#include "tracking/dtrack.hpp"

#include <fmt/format.h>

#include <random>

#include "tests/tracking/tracking_samples.hpp"
#include "tracking/room_mapping.hpp"

namespace {

using namespace tracking;
using test::near;
using Kind = Reading::Kind;

const std::string kStraight = "[1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0]";

/// Returns a body at x [mm].
std::string body(int number, double x, const std::string& rotation = kStraight, double quality = 1) {
    return fmt::format("[{} {:.3f}][{:.3f} 1700.000 2500.000 0.0000 0.0000 0.0000]{}", number, quality, x, rotation);
}

std::string frame(unsigned number, const std::string& bodies, int count = 1) {
    return fmt::format("fr {}\n6d {} {}\n", number, count, bodies);
}

Reading read(const std::string& text, int wanted = 0) { return DtrackReader(wanted).read(test::bytesOf(text), false); }

TEST(Dtrack, TellsMillimetres) {
    const Reading reading = read(frame(1, body(0, -120.5)));
    ASSERT_EQ(reading.kind, Kind::pose);
    EXPECT_TRUE(near(reading.measured.position, {-0.1205, 1.7, 2.5}));
}

TEST(Dtrack, TellsTheRotationColumnByColumn) {
    // A turn by 30 degrees about the tracker's z, counter-clockwise: its x axis turns towards y.
    const Reading reading = read(frame(1, body(0, 0, "[0.866025 0.5 0 -0.5 0.866025 0 0 0 1]")));
    ASSERT_EQ(reading.kind, Kind::pose);
    EXPECT_TRUE(near(reading.measured.rotation[0], {std::sqrt(0.75), 0.5, 0}, 1e-6));
    // If z is up and y points into the wall, this is a turn to the left: the right eye comes nearer to the wall.
    RoomMapping mapping;
    mapping.axes = axesOf("x,z,-y").value();
    EXPECT_TRUE(near(mapping.pose(reading.measured).right, {std::sqrt(0.75), 0, -0.5}, 1e-6));
}

TEST(Dtrack, AgreesWithTheAnglesBesideTheMatrix) {
    // The angles are about x, then y, then z of the turned body. The numbers are rounded as the tracker rounds them.
    const double x = glm::radians(20.0), y = glm::radians(-35.0), z = glm::radians(50.0);
    const glm::dmat3 aboutX(1, 0, 0, 0, std::cos(x), std::sin(x), 0, -std::sin(x), std::cos(x));
    const glm::dmat3 aboutY(std::cos(y), 0, -std::sin(y), 0, 1, 0, std::sin(y), 0, std::cos(y));
    const glm::dmat3 aboutZ(std::cos(z), std::sin(z), 0, -std::sin(z), std::cos(z), 0, 0, 0, 1);
    const glm::dmat3 r = aboutX * aboutY * aboutZ;
    const std::string matrix = fmt::format("[{:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}]", r[0][0],
                                           r[0][1], r[0][2], r[1][0], r[1][1], r[1][2], r[2][0], r[2][1], r[2][2]);
    const Reading reading = read("fr 7\n6d 1 [0 1.000][1.0 2.0 3.0 20.0 -35.0 50.0]" + matrix + "\n");
    ASSERT_EQ(reading.kind, Kind::pose);
    for (int column = 0; column < 3; ++column) {
        EXPECT_TRUE(near(reading.measured.rotation[column], r[column], 2e-6)) << column;
    }
}

TEST(Dtrack, FindsItsBodyAmongOthersAndSkipsOtherLines) {
    const std::string text =
        "fr 12\r\nts 44597.741924\r\n6dcal 3\r\n" + std::string("6d 2 ") + body(1, 100) + " " + body(4, 400) +
        "\r\n6df2 1 1 [0 1.000 6 2][0.000 0.000 0.000][0 0 0 0 0 0 0 0 0][0 0.00 0.00]\r\n3d 0\r\n";
    EXPECT_TRUE(near(read(text, 4).measured.position, {0.4, 1.7, 2.5}));
    EXPECT_TRUE(near(read(text, 1).measured.position, {0.1, 1.7, 2.5}));
    EXPECT_EQ(read(text, 0).kind, Kind::absent);
    EXPECT_EQ(read(text + std::string(1, '\0'), 4).kind, Kind::pose) << "ended like a string of C";
}

TEST(Dtrack, KnowsABodyThatIsNotSeen) {
    EXPECT_EQ(read("fr 3\n6d 0\n").kind, Kind::absent);
    EXPECT_EQ(read(frame(3, body(0, 0, "[0 0 0 0 0 0 0 0 0]", -1))).kind, Kind::absent);
    EXPECT_EQ(read(frame(3, body(0, 0, "[0 0 0 0 0 0 0 0 0]"))).kind, Kind::refused) << "claims to be seen";
}

TEST(Dtrack, DropsFramesThatAreNotNewer) {
    DtrackReader reader(0);
    const auto kind = [&](unsigned number, bool gone = false) {
        return reader.read(test::bytesOf(frame(number, body(0, 0))), gone).kind;
    };
    EXPECT_EQ(kind(100), Kind::pose);
    EXPECT_EQ(kind(100), Kind::old) << "doubled";
    EXPECT_EQ(kind(99), Kind::old) << "overtaken";
    EXPECT_EQ(kind(103), Kind::pose) << "one was lost";
    EXPECT_EQ(kind(101), Kind::old);
    EXPECT_EQ(kind(104), Kind::pose);
}

TEST(Dtrack, TakesAFreshStartForOne) {
    DtrackReader reader(0);
    const auto kind = [&](unsigned number, bool gone = false) {
        return reader.read(test::bytesOf(frame(number, body(0, 0))), gone).kind;
    };
    EXPECT_EQ(kind(50'000), Kind::pose);
    EXPECT_EQ(kind(1), Kind::pose) << "far behind";
    EXPECT_EQ(kind(200), Kind::pose);
    EXPECT_EQ(kind(2), Kind::old);
    EXPECT_EQ(kind(2, true), Kind::pose) << "after a silence";
    EXPECT_EQ(kind(4'294'967'295U), Kind::old) << "just before 2, had the counter run over";
}

TEST(Dtrack, LetsTheCounterRunOver) {
    DtrackReader reader(0);
    EXPECT_EQ(reader.read(test::bytesOf(frame(4'294'967'295U, body(0, 0))), false).kind, Kind::pose);
    EXPECT_EQ(reader.read(test::bytesOf(frame(0, body(0, 0))), false).kind, Kind::pose);
    EXPECT_EQ(reader.read(test::bytesOf(frame(4'294'967'295U, body(0, 0))), false).kind, Kind::old);
}

TEST(Dtrack, ARefusedPacketDoesNotCountAsTheNewest) {
    DtrackReader reader(0);
    EXPECT_EQ(reader.read(test::bytesOf("fr 500\n6d 1 [0 1.000][broken\n"), false).kind, Kind::refused);
    EXPECT_EQ(reader.read(test::bytesOf(frame(10, body(0, 0))), false).kind, Kind::pose);
}

TEST(Dtrack, RefusesWhatIsMalformed) {
    const std::string good = body(0, 0);
    ASSERT_EQ(read("fr 1\n6d 1 " + good + "\n").kind, Kind::pose);
    const std::vector<std::string> broken{
        "",
        "\n",
        "hello",
        "fr 1\n",
        "fr x\n6d 1 " + good,
        "fr -1\n6d 1 " + good,
        "fr 1 2\n6d 1 " + good,
        "fr 1\nfr 2\n6d 1 " + good,
        "fr 1\n6d\n",
        "fr 1\n6d 2 " + good,
        "fr 1\n6d 1 " + good + good,
        "fr 1\n6d 1 " + good + "\n6d 1 " + good,
        "fr 1\n6d -1 " + good,
        "fr 1\n6d 999999999999 " + good,
        "fr 1\n6d 1 [0 1.0][1 2 3 0 0]" + kStraight,
        "fr 1\n6d 1 [0 1.0][1 2 3 0 0 0 0]" + kStraight,
        "fr 1\n6d 1 [0 1.0][1 2 nan 0 0 0]" + kStraight,
        "fr 1\n6d 1 [0 1.0][1 2 inf 0 0 0]" + kStraight,
        "fr 1\n6d 1 [0 1.0][1 2 1e999 0 0 0]" + kStraight,
        "fr 1\n6d 1 [0 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0]",
        "fr 1\n6d 1 [0 1.0][1 2 3 0 0 0][1 0 0 0 1 0 0 0 1",
        "fr 1\n6d 1 [0 1.0][1 2 3 0 0 0][nan 0 0 0 1 0 0 0 1]",
        "fr 1\n6d 1 [0 1.0][1 2 3 0 0 0][2 0 0 0 1 0 0 0 1]",
        "fr 1\n6d 1 [0 1.0][100001 2 3 0 0 0]" + kStraight,
    };
    for (const std::string& text : broken) {
        EXPECT_EQ(read(text).kind, Kind::refused) << text;
    }
}

TEST(Dtrack, SurvivesAnyBytes) {
    // The random numbers are seeded, so that a failure can be repeated. The sanitizer build checks the reads.
    std::mt19937 random(4);
    const std::string good = "fr 12\n6d 2 " + body(0, 1) + " " + body(1, 2) + "\n";
    int poses = 0;
    for (unsigned i = 0; i < 20'000; ++i) {
        base::Bytes bytes = test::bytesOf(good);
        for (unsigned change = 0; change < 1 + i % 5; ++change) {
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        }
        bytes.resize(random() % 8 == 0 ? random() % bytes.size() : bytes.size());
        const Reading reading = DtrackReader(0).read(bytes, false);
        poses += reading.kind == Kind::pose ? 1 : 0;
        ASSERT_TRUE(reading.kind != Kind::pose || plausible(reading.measured));
    }
    EXPECT_GT(poses, 0) << "some changes do no harm";
}

TEST(Dtrack, IsSentAsItIsRead) {
    const Pose pose{{0.2, 1.65, 2.2}, glm::normalize(glm::dvec3(0.9, 0.2, -0.3))};
    const base::Bytes packet = dtrackPacket(pose, 5, 2);
    const Reading reading = DtrackReader(2).read(packet, false);
    ASSERT_EQ(reading.kind, Kind::pose);
    const Pose back = RoomMapping{}.pose(reading.measured);
    EXPECT_TRUE(near(back.position, pose.position, 1e-6)) << "three digits of a millimetre";
    EXPECT_TRUE(near(back.right, pose.right, 2e-6));
}

}  // namespace
