// SPDX-License-Identifier: Apache-2.0
#include "tracking/source.hpp"

#include "tests/support/refusal.hpp"
#include "tests/tracking/tracking_samples.hpp"

namespace {

using namespace tracking;

Source parseSource(const std::string& text) { return Source::parse(text, "--track"); }

/// Checks the error about a text. It must be one line, begin with the option and quote the text.
std::string complaint(const std::string& text) {
    std::string line = test::refusalOf([&] { (void)parseSource(text); });
    EXPECT_EQ(line.find("--track: '" + text), 0U) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
}

void expectComplaint(const std::string& text, const std::string& about) {
    EXPECT_NE(complaint(text).find(about), std::string::npos) << complaint(text);
}

TEST(TrackingSource, ListensOnLoopbackUnlessAnAddressIsGiven) {
    EXPECT_EQ(parseSource("opentrack:4242").host, "127.0.0.1");
    EXPECT_EQ(parseSource("opentrack:4242").port, 4242);
    EXPECT_EQ(parseSource("opentrack:localhost:4242").host, "127.0.0.1");
    EXPECT_EQ(parseSource("opentrack:0.0.0.0:65535").host, "0.0.0.0");
    EXPECT_EQ(parseSource("opentrack:0.0.0.0:65535").port, 65535);
    EXPECT_EQ(parseSource("dtrack:[::1]:5000").host, "::1");
    EXPECT_EQ(parseSource("dtrack:[::1]:5000").port, 5000);
}

TEST(TrackingSource, TakesTheTrackersOwnAddress) {
    EXPECT_EQ(parseSource("opentrack:4242").from, "");
    EXPECT_EQ(parseSource("dtrack:0.0.0.0:5000 from=192.168.1.20").from, "192.168.1.20");
    expectComplaint("opentrack:4242 from=cave", "is not an IP address");
}

TEST(TrackingSource, TakesABodyBehindThePort) {
    EXPECT_EQ(parseSource("dtrack:5000").body, 0);
    EXPECT_EQ(parseSource("dtrack:5000:3").body, 3);
    EXPECT_EQ(parseSource("dtrack:5000:3").port, 5000);
    EXPECT_EQ(parseSource("dtrack:10.0.0.2:5001:2").host, "10.0.0.2");
    EXPECT_EQ(parseSource("dtrack:10.0.0.2:5001:2").port, 5001);
    EXPECT_EQ(parseSource("dtrack:10.0.0.2:5001:2").body, 2);
}

TEST(TrackingSource, KnowsEveryKind) {
    EXPECT_EQ(parseSource("none").kind, Source::Kind::none);
    EXPECT_EQ(parseSource("opentrack:1").kind, Source::Kind::opentrack);
    EXPECT_EQ(parseSource("dtrack:1").kind, Source::Kind::dtrack);
    EXPECT_EQ(parseSource("trace:my head.csv").file, "my head.csv");
    EXPECT_EQ(Source::parse("trace:head.csv", "wall.toml", "walls/lab").file, "walls/lab/head.csv");
    EXPECT_EQ(Source::parse("trace:/tmp/head.csv", "wall.toml", "walls/lab").file, "/tmp/head.csv");
}

TEST(TrackingSource, TakesPlaceAndAxesBehindIt) {
    const Source source = parseSource("dtrack:5000 origin=0,1.5,-2  axes=x,z,-y eyes=0,-0.1,0");
    EXPECT_EQ(source.port, 5000);
    EXPECT_EQ(source.text, "dtrack:5000");
    EXPECT_EQ(source.origin, glm::dvec3(0, 1.5, -2));
    EXPECT_EQ(source.axes, axesOf("x,z,-y"));
    EXPECT_EQ(source.eyes, glm::dvec3(0, -0.1, 0));
    EXPECT_EQ(parseSource("trace:my head.csv origin=1,2,3").file, "my head.csv");
}

TEST(TrackingSource, CountsOpentrackFromTheRestingEyeAndOthersFromTheRoom) {
    const glm::dvec3 eye(0, 1.6, 2.5);
    EXPECT_EQ(parseSource("opentrack:4242").mapping(eye).origin, eye);
    EXPECT_EQ(parseSource("opentrack:4242 origin=0,1,0").mapping(eye).origin, glm::dvec3(0, 1, 0));
    EXPECT_EQ(parseSource("dtrack:5000").mapping(eye).origin, glm::dvec3(0));
    EXPECT_EQ(parseSource("trace:head.csv").mapping(eye).origin, glm::dvec3(0));
}

TEST(TrackingSource, SaysWhatIsWrongWithAPort) {
    expectComplaint("opentrack:65536", "port 65536 is beyond 65535");
    expectComplaint("opentrack:99999999999999999999999", "is beyond 65535");
    for (const char* text : {"opentrack:", "opentrack", "opentrack:-1", "opentrack:42x", "opentrack:x",
                             "opentrack:127.0.0.1:", "dtrack:4242 4243"}) {
        expectComplaint(text, "is not a port");
    }
    expectComplaint("opentrack:4242:1", "write nothing after the port");
    expectComplaint("dtrack:127.0.0.1:5000:1:2", "write only a body's number after the port");
}

TEST(TrackingSource, SaysWhatIsWrongWithEverythingElse) {
    expectComplaint("opentrack:nowhere:4242", "'nowhere' is not an IP address");
    expectComplaint("dtrack:224.0.1.1:5000", "is a multicast address");
    expectComplaint("dtrack:[::1:5000", "[ADDRESS]:PORT");
    expectComplaint("dtrack:5000:x", "'x' is not a body");
    expectComplaint("dtrack:5000:-1", "'-1' is not a body");
    expectComplaint("dtrack:5000:1000", "'1000' is not a body");
    expectComplaint("dtrack:5000:", "'' is not a body");
    for (const char* text : {"", "webcam", "trace", "trace:", "none:1", "Opentrack:4242", "vrpn:Head@host"}) {
        expectComplaint(text, "is not a source; write none, trace:FILE.csv");
    }
    expectComplaint("opentrack:1 origin=1,2", "origin=1,2 is not three numbers");
    expectComplaint("opentrack:1 origin=1,2,nan", "is not three numbers");
    expectComplaint("opentrack:1 origin=0,1200,0", "at most 1000, got 1200");
    expectComplaint("opentrack:1 eyes=0,-10,0", "at most 1, got -10");
    expectComplaint("opentrack:1 axes=x,y,y", "x, y and z once each");
    expectComplaint("opentrack:1 orgin=0,0,0", "orgin=0,0,0");
}

}  // namespace
