// SPDX-License-Identifier: Apache-2.0
// Who may come in: the real server against guests who should not, over plain TCP and TLS.
#include <sys/stat.h>

#include <algorithm>
#include <mutex>

#include "files/input_error.hpp"
#include "haptic_bridge/guest_limits.hpp"
#include "haptic_bridge/link_options.hpp"
#include "tests/haptic_bridge/raw_peer.hpp"
#include "tests/haptic_bridge/server_process.hpp"
#include "tests/impaired_link/impaired_link.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;
using impaired_link::ImpairedLink;

const std::string kMove = "the secret of those who move";
const std::string kWatch = "the secret of those who watch";

class LinkSecurityTest : public testing::Test {
protected:
    std::string secretFile(const std::string& name, const std::string& text) {
        const std::string file = folder_.write(name, text);
        chmod(file.c_str(), S_IRUSR | S_IWUSR);
        return file;
    }
    std::string quoted(std::string secret) {
        std::replace(secret.begin(), secret.end(), ' ', '-');
        return secret;
    }
    std::vector<std::string> arguments(const std::vector<std::string>& more, const std::string& pace = "fast") {
        std::vector<std::string> all = ServerProcess::usual(sceneFile_, folder_, 0, pace);
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    LinkSecurity client(const std::string& file, bool tls = false, Role role = Role::move) {
        LinkOptions options;
        options.secretFile = file;
        options.tls = tls;
        return options.forClient(role);
    }
    Hello hello(Role role = Role::move) {
        return {{kProtocolVersion, sand::kAlgorithmVersion, scene_.rules.digest(), "small"}, role, false, false, {}};
    }
    /// What the link says when it is refused.
    std::string refusalOf(const Address& address, const LinkSecurity& security) {
        Client client(address, offerOf(scene_), security);
        EXPECT_TRUE(eventually([&] { return client.link().link == Link::refused; })) << client.link().message;
        return client.link().message;
    }
    bool links(const Address& address, const LinkSecurity& security, std::uint64_t steps = 20) {
        Client client(address, offerOf(scene_), security);
        Wall wall(scene_);
        return wall.follow(client, steps) && wall.divergences == 0;
    }

    Folder folder_;
    std::string both_ = secretFile("both", "move " + quoted(kMove) + "\nwatch " + quoted(kWatch) + "\n");
    std::string sceneFile_ = folder_.write("small.toml", kSmallScene);
    sand::Scene scene_ = sand::loadScene(sceneFile_);
};

/// What passes between two ends.
struct Capture {
    std::mutex mutex;
    files::Bytes there, back;
    ImpairedLink::Tap tap() {
        return [this](std::span<const std::uint8_t> bytes, bool fromGuest) {
            const std::lock_guard lock(mutex);
            files::Bytes& all = fromGuest ? there : back;
            all.insert(all.end(), bytes.begin(), bytes.end());
        };
    }
    bool holds(std::span<const std::uint8_t> bytes) {
        const std::lock_guard lock(mutex);
        const auto in = [&](const files::Bytes& all) {
            return std::search(all.begin(), all.end(), bytes.begin(), bytes.end()) != all.end();
        };
        return in(there) || in(back);
    }
};

std::string complaintOf(const std::string& text) {
    try {
        (void)parseSecrets(text, "secrets");
    } catch (const files::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(SecretFile, NamesTheLineAndNeverTheSecret) {
    const Secrets secrets = parseSecrets("# ours\n\n move 0123456789abcdef\r\nwatch\t0123456789abcdeg", "secrets");
    EXPECT_EQ(secrets.move, "0123456789abcdef");
    EXPECT_EQ(secrets.watch, "0123456789abcdeg");
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"move 0123456789abcde", "secrets:1: a secret of 15 characters"},
        {"\nmove", "secrets:2: a secret of 0 characters"},
        {"0123456789abcdef", "secrets:1: begins with neither move nor watch"},
        {"move 0123456789abcdef 0123456789abcdef", "secrets:1: holds more"},
        {"move 0123456789abcdef\nmove 0123456789abcdeg", "secrets:2: a second secret of role move"},
        {"move 0123456789abcdef\nwatch 0123456789abcdef", "secrets: has one secret for both roles"},
        {"move 0123456789\001"
         "bcdef",
         "secrets:1: a secret with characters"},
        {"# nothing", "secrets: holds no secret"},
    };
    for (const auto& [text, complaint] : wrong) {
        EXPECT_EQ(complaintOf(text).find(complaint), 0U) << complaintOf(text);
        EXPECT_EQ(complaintOf(text).find("0123456789"), std::string::npos) << complaintOf(text);
    }
}

TEST_F(LinkSecurityTest, TakesASecretOnlyFromAFileOfItsOwnersAlone) {
    const std::string open = folder_.write("open", "move 0123456789abcdef\n");
    chmod(open.c_str(), 0640);
    const std::string pipe = folder_.file("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const std::string large = secretFile("large", std::string(kMaxSecretFile + 1, '#'));
    for (const auto& [file, word] : std::vector<std::pair<std::string, std::string>>{{open, "others may read"},
                                                                                     {pipe, "no regular file"},
                                                                                     {folder_.file("none"), "cannot"},
                                                                                     {large, "larger than"}}) {
        try {
            (void)readSecrets(file);
            ADD_FAILURE() << file;
        } catch (const files::InputError& error) {
            EXPECT_EQ(std::string(error.what()).find(file), 0U) << error.what();
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    }
}

/// Both halves of a greeting, without a socket.
class Greeting : public LinkSecurityTest {
protected:
    LinkSecurity master_ = client(both_), server_ = client(both_);
    Identity identity_{kProtocolVersion, sand::kAlgorithmVersion, 7, "dunes"};
};

TEST_F(Greeting, ProvesBothSidesAndNoneToTheOther) {
    MasterHandshake master(master_, identity_, Role::move, {});
    ServerHandshake server(server_);
    EXPECT_FALSE(server.refusalFor(master.hello(), false));
    const auto challenge = server.challenge(master.hello(), identity_, {});
    ASSERT_TRUE(challenge);
    const auto proof = master.answer(*challenge);
    ASSERT_TRUE(proof);
    EXPECT_TRUE(server.accepts(*proof));
    EXPECT_TRUE(master.accepts(Welcome{identity_, 60, Role::move, server.mac()}));
    // What one side has said, said back to it, proves nothing.
    EXPECT_FALSE(master.accepts(Welcome{identity_, 60, Role::move, proof->mac})) << "reflected";
    EXPECT_FALSE(server.accepts(Proof{server.mac()})) << "reflected";
    EXPECT_FALSE(master.accepts(Welcome{identity_, 60, Role::watch, server.mac()})) << "less than was asked for";
    Identity other = identity_;
    other.rulesDigest ^= 1;
    EXPECT_FALSE(master.accepts(Welcome{other, 60, Role::move, server.mac()})) << "not who was challenged";
    EXPECT_FALSE(master.answer(*challenge)) << "twice";
}

TEST_F(Greeting, EveryByteOfWhatWasSaidIsUnderTheProof) {
    MasterHandshake master(master_, identity_, Role::move, {1, 2});
    ServerHandshake server(server_);
    for (int which = 0; which < 6; ++which) {
        Hello hello = master.hello();
        hello.nonce[31] ^= which == 0 ? 1 : 0;
        hello.master.sceneName += which == 1 ? "s" : "";
        hello.tls = which == 2;
        hello.role = which == 3 ? Role::watch : Role::move;
        auto challenge = server.challenge(hello, identity_, which == 4 ? files::Bytes{1, 3} : files::Bytes{1, 2});
        challenge->nonce[0] ^= which == 5 ? 1 : 0;
        MasterHandshake answering = master;
        EXPECT_FALSE(server.accepts(*answering.answer(*challenge))) << which;
    }
}

TEST_F(Greeting, AServerThatMayOnlyWatchNumbersNoSteps) {
    MasterHandshake master(master_, identity_, Role::move, {});
    LinkSecurity watching = server_;
    watching.secrets.move = watching.secrets.watch;
    ServerHandshake server(watching);
    const auto challenge = server.challenge(master.hello(), identity_, {});
    ASSERT_TRUE(master.answer(*challenge));
    EXPECT_FALSE(master.accepts(Welcome{identity_, 60, Role::move, server.mac()}));
    EXPECT_EQ(master.because().code, RefusalCode::role) << master.because().text;
    MasterHandshake trusting(master_, identity_, Role::move, {});
    EXPECT_FALSE(trusting.accepts(Welcome{identity_, 60, Role::move, {}})) << "proves nothing";
    EXPECT_EQ(trusting.because().code, RefusalCode::secret);
}

// Somebody in between ends TLS on both sides with a certificate of his own, and hands on what is said inside.
TEST_F(Greeting, TlsIsBoundToTheProofSoThatNobodyStandsBetween) {
    const auto shake = [](TlsSession& guest, TlsSession& host) {
        files::Bytes there, back, plain;
        guest.begin(there);
        while (!there.empty() || !back.empty()) {
            const files::Bytes forth = std::exchange(there, {}), answers = std::exchange(back, {});
            host.receive(forth, plain, back);
            guest.receive(answers, plain, there);
        }
        EXPECT_TRUE(guest.established() && host.established());
    };
    const auto serverTls = server_.functions->tlsServer("", ""), middleTls = server_.functions->tlsServer("", "");
    const auto clientTls = server_.functions->tlsClient();
    const auto server = serverTls->open(), middleIn = middleTls->open();
    const auto master = clientTls->open(), middleOut = clientTls->open(), honest = clientTls->open();
    shake(*master, *middleIn);
    shake(*middleOut, *server);
    EXPECT_NE(master->binding(), server->binding());
    EXPECT_EQ(middleOut->binding(), server->binding());
    MasterHandshake asking(master_, identity_, Role::move, master->binding());
    ServerHandshake asked(server_);
    const auto challenge = asked.challenge(asking.hello(), identity_, server->binding());
    EXPECT_FALSE(asked.accepts(*asking.answer(*challenge)));
    EXPECT_FALSE(asking.accepts(Welcome{identity_, 60, Role::move, asked.mac()}));
}

TEST_F(LinkSecurityTest, ListensBeyondThisMachineOnlyWithASecret) {
    std::vector<std::string> wide = arguments({});
    *(std::find(wide.begin(), wide.end(), "--listen") + 1) = "0.0.0.0:0";
    {
        ServerProcess server(folder_, wide);
        EXPECT_EQ(server.wait(), files::kExitBadInput);
        EXPECT_NE(server.errors().find("--secret-file"), std::string::npos) << server.errors();
    }
    wide.insert(wide.end(), {"--secret-file", both_});
    ServerProcess server(folder_, wide);
    EXPECT_TRUE(links(server.address(), client(both_)));
    const LinkSecurity none;
    EXPECT_THROW(requireSecret({"192.0.2.1", 7750}, none, "--haptic"), files::InputError);
    EXPECT_NO_THROW(requireSecret({"127.8.0.1", 7750}, none, "--haptic"));
    EXPECT_NO_THROW(requireSecret({"192.0.2.1", 7750}, client(both_), "--haptic"));
    EXPECT_FALSE(isLoopback(boost::asio::ip::make_address("::ffff:10.0.0.1")));
    EXPECT_TRUE(isLoopback(boost::asio::ip::make_address("::ffff:127.0.0.1")));
}

TEST_F(LinkSecurityTest, RefusesWhoDoesNotKnowTheSecretAndSaysSo) {
    ServerProcess server(folder_, arguments({"--secret-file", both_}));
    const Address address = server.address();
    const std::string wrong = secretFile("wrong", "move another-secret-entirely\n");
    EXPECT_NE(refusalOf(address, client(wrong)).find("the secret of role move is another here"), std::string::npos);
    EXPECT_NE(refusalOf(address, {}).find("asks for a secret"), std::string::npos);
    {
        RawPeer skips(address.port);  // and says nothing of a secret
        skips.send(hello());
        EXPECT_NE(skips.refusal().find("asks for a secret"), std::string::npos);
    }
    {
        RawPeer pushes(address.port);
        Hello proving = hello();
        proving.proves = true;
        pushes.send(proving);
        EXPECT_TRUE(pushes.receive()) << "the challenge";
        pushes.send(Start{1, 0, 0});
        EXPECT_NE(pushes.refusal().find("out of turn"), std::string::npos);
    }
    {
        RawPeer large(address.port);  // nobody knows it yet: a kilobyte is enough
        large.send(Bye{std::string(2000, 'x')});
        EXPECT_NE(large.refusal().find("1024 is the most"), std::string::npos);
    }
    EXPECT_TRUE(links(address, client(both_))) << "after all that it serves as if nothing had happened";
    EXPECT_NE(server.errors().find("the secret of role move is another here"), std::string::npos) << server.errors();
    EXPECT_NE(server.errors().find("secret proved"), std::string::npos) << server.errors();
    const std::string errors = server.errors();
    EXPECT_EQ(errors.find(quoted(kMove)), std::string::npos) << "nobody prints a secret";
}

TEST_F(LinkSecurityTest, ASecretOnOneSideAloneIsRefusedEitherWay) {
    ServerProcess server(folder_, arguments({}));
    EXPECT_NE(refusalOf(server.address(), client(both_)).find("has no secret to prove"), std::string::npos);
    const std::string watchers = secretFile("watchers", "watch " + quoted(kWatch) + "\n");
    EXPECT_THROW((void)client(watchers), files::InputError) << "a master has to move";
    ServerProcess watched(folder_, arguments({"--secret-file", watchers}));
    EXPECT_NE(refusalOf(watched.address(), client(both_)).find("no secret of role move"), std::string::npos);
}

TEST_F(LinkSecurityTest, AWholeGreetingPlayedBackOpensNothing) {
    ServerProcess server(folder_, arguments({"--secret-file", both_}));
    Capture capture;
    {
        ImpairedLink recorder({}, "127.0.0.1", server.port(), 0, capture.tap());
        ASSERT_TRUE(links({"127.0.0.1", recorder.port()}, client(both_)));
    }
    RawPeer replayer(server.port());
    replayer.send(std::span(capture.there).first(std::min<std::size_t>(capture.there.size(), 1024)));
    const auto challenge = replayer.receive();
    ASSERT_TRUE(challenge && std::holds_alternative<Challenge>(*challenge));
    EXPECT_NE(replayer.refusal().find("the secret of role move is another here"), std::string::npos);
}

TEST_F(LinkSecurityTest, NeitherSideFallsBackFromTls) {
    ServerProcess sealed(folder_, arguments({"--secret-file", both_, "--tls"}));
    const Address address = sealed.address();
    EXPECT_NE(refusalOf(address, client(both_)).find("speaks TLS alone"), std::string::npos);
    EXPECT_TRUE(links(address, client(both_, true))) << sealed.errors();
    const std::string wrong = secretFile("wrong", "move another-secret-entirely\n");
    EXPECT_NE(refusalOf(address, client(wrong, true)).find("is another here"), std::string::npos);
    EXPECT_NE(sealed.errors().find("it does not speak TLS"), std::string::npos) << sealed.errors();
    EXPECT_NE(sealed.errors().find("TLS 1.3"), std::string::npos) << sealed.errors();
    const Folder other;
    std::vector<std::string> plainly = ServerProcess::usual(sceneFile_, other);
    plainly.insert(plainly.end(), {"--secret-file", both_});
    ServerProcess plain(other, plainly);
    EXPECT_NE(refusalOf(plain.address(), client(both_, true)).find("does not speak TLS"), std::string::npos);
    EXPECT_TRUE(eventually([&] { return plain.errors().find("it speaks TLS") != std::string::npos; }))
        << plain.errors();
    EXPECT_THROW((void)client("", true), files::InputError) << "TLS without a secret proves nothing";
}

TEST_F(LinkSecurityTest, UnderTlsACaptureShowsNoProbePosition) {
    for (const bool tls : {false, true}) {
        std::vector<std::string> more{"--secret-file", both_};
        if (tls) {
            more.emplace_back("--tls");
        }
        ServerProcess server(folder_, arguments(more));
        Capture capture;
        std::vector<sand::Step> steps;
        {
            ImpairedLink recorder({}, "127.0.0.1", server.port(), 0, capture.tap());
            Client link({"127.0.0.1", recorder.port()}, offerOf(scene_), client(both_, tls));
            Wall wall(scene_);
            ASSERT_TRUE(wall.follow(link, 30)) << link.link().message << server.errors();
            ASSERT_TRUE(eventually([&] {
                for (const auto& timed : link.drain(100)) {
                    wall.apply(timed);
                    steps.push_back(timed.step);
                }
                link.shown(wall.terrain.stepNumber(), 16'666'667);
                return steps.size() >= 100;
            }));
            EXPECT_EQ(wall.divergences, 0);
        }
        int positions = 0, found = 0;
        for (const sand::Step& step : steps) {
            files::ByteWriter writer;
            sand::encode(step, writer);
            if (!step.path.empty()) {
                ++positions;
                found += capture.holds(writer.bytes()) ? 1 : 0;
            }
        }
        EXPECT_GT(positions, 50);
        EXPECT_EQ(found, tls ? 0 : positions);
        const std::string_view name = "small";
        EXPECT_NE(capture.holds({reinterpret_cast<const std::uint8_t*>(name.data()), name.size()}), tls);
    }
}

TEST_F(LinkSecurityTest, AWatcherSeesTheStepsAndMovesNothing) {
    ServerProcess server(folder_, arguments({}));
    Client master(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10));
    RawPeer watcher(server.port());
    Hello asking = hello(Role::watch);
    asking.master.rulesDigest = 0;  // it has no sand
    watcher.send(asking);
    const auto welcome = watcher.receive();
    ASSERT_TRUE(welcome && std::holds_alternative<Welcome>(*welcome));
    EXPECT_EQ(std::get<Welcome>(*welcome).role, Role::watch);
    RawPeer pushy(server.port());
    pushy.send(asking);
    ASSERT_TRUE(pushy.receive());
    pushy.send(Start{9, 0, 0});
    ASSERT_TRUE(wall.follow(master, 60));
    std::uint64_t last = 0;
    while (last < 50) {
        const auto message = watcher.receive();
        ASSERT_TRUE(message) << server.errors();
        if (const auto* step = std::get_if<StepMessage>(&*message)) {
            EXPECT_TRUE(last == 0 || step->step.number == last + 1);
            last = step->step.number;
        }
    }
    EXPECT_TRUE(eventually([&] { return server.errors().find("who watches only listens") != std::string::npos; }))
        << server.errors();
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
    master.stop();
    ASSERT_TRUE(master.report());
    EXPECT_EQ(master.report()->refused[static_cast<std::size_t>(RefusalCode::role) - 1], 1U);
}

TEST_F(LinkSecurityTest, TheProgramThatWatchesPrintsWhereTheProbeIs) {
    const std::string watchers = secretFile("watchers", "watch " + quoted(kWatch) + "\n");
    ServerProcess server(folder_, arguments({"--secret-file", both_, "--tls"}, "realtime"));
    Client master(server.address(), offerOf(scene_), client(both_, true));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10)) << master.link().message;
    const auto watch = [&](const std::string& options) {
        const std::string command = "timeout 60 " SANDWALL_BIN_DIR "/sandwall-watch " + server.address().text() +
                                    " --lines 2 " + options + " >" + folder_.file("watch") + " 2>&1 &";
        std::filesystem::remove(folder_.file("watch"));
        EXPECT_EQ(std::system(command.c_str()), 0);
        EXPECT_TRUE(eventually([&] {
            for (const auto& timed : master.drain(100)) {
                wall.apply(timed);
            }
            master.shown(wall.terrain.stepNumber(), 16'666'667);
            const std::string told = folder_.read("watch");
            return told.find("steps/s", told.find("steps/s") + 1) != std::string::npos ||
                   (told.find("127.0.0.1") != std::string::npos && told.ends_with('\n'));
        }));
        return folder_.read("watch");
    };
    const std::string told = watch("--tls --secret-file " + watchers);
    EXPECT_EQ(told.find("scene 'small', 60 steps per second\nstep "), 0U) << told;
    EXPECT_NE(told.find("probe at "), std::string::npos) << told;
    const std::string plain = watch("");
    EXPECT_NE(plain.find("this server speaks TLS alone"), std::string::npos) << plain;
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
}

TEST_F(LinkSecurityTest, WhoWatchesAndDoesNotReadIsCutOff) {
    ServerProcess server(folder_, arguments({}));
    Client master(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10));
    RawPeer watcher(server.port());
    watcher.send(hello(Role::watch));
    ASSERT_TRUE(watcher.receive());
    // Loopback takes some megabytes before the server sees that nobody reads: steps of loads that fit a message.
    const auto cutOff = [&] { return server.errors().find("does not read what is sent") != std::string::npos; };
    for (int round = 0; round < 400 && !cutOff(); ++round) {
        master.request(sand::Edit::loaded(files::Bytes(50'000, 7)));
        ASSERT_TRUE(wall.follow(master, wall.terrain.stepNumber() + 10)) << master.link().message;
    }
    EXPECT_TRUE(cutOff()) << server.errors();
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
    EXPECT_EQ(master.counters().reconnects, 0U);
}

TEST_F(LinkSecurityTest, ManyGuestsAtOnceDoNotTouchWhoIsLinked) {
    ServerProcess server(folder_, arguments({}));
    Client master(server.address(), offerOf(scene_));
    Wall wall(scene_);
    ASSERT_TRUE(wall.follow(master, 10));
    std::vector<std::unique_ptr<RawPeer>> guests;
    for (int i = 0; i < 60; ++i) {
        guests.push_back(std::make_unique<RawPeer>(server.port()));
    }
    ASSERT_TRUE(wall.follow(master, 100)) << master.link().message;
    guests.clear();
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
    EXPECT_EQ(master.counters().reconnects, 0U);
    master.stop();
    ASSERT_TRUE(master.report());
    EXPECT_GT(master.report()->refused[static_cast<std::size_t>(RefusalCode::limit) - 1], 20U);
    Client next(server.address(), offerOf(scene_));
    EXPECT_TRUE(wall.follow(next, 120)) << next.link().message;
}

TEST(GuestLimits, HoldsBackWhoComesOftenAndNobodyElse) {
    GuestLimits limits;
    const auto often = boost::asio::ip::make_address("192.0.2.1"), other = boost::asio::ip::make_address("192.0.2.2");
    std::int64_t now = 1'000'000'000;
    int came = 0;
    for (int i = 0; i < 100; ++i) {
        came += limits.mayCome(often, now) ? 1 : 0;
    }
    EXPECT_EQ(came, 16);
    EXPECT_TRUE(limits.mayCome(other, now));
    now += 1'000'000'000;
    EXPECT_TRUE(limits.mayCome(often, now));
    for (int i = 0; i < 100; ++i) {
        limits.refused(often, now);
    }
    now += 1'900'000'000;
    EXPECT_FALSE(limits.mayCome(often, now)) << "who was refused comes later still";
    now += 300'000'000;
    EXPECT_TRUE(limits.mayCome(often, now)) << "but not never";
    for (unsigned i = 0; i < 5000; ++i) {  // more addresses than are kept apart
        (void)limits.mayCome(boost::asio::ip::address_v4(0x0a000000U + i), now);
    }
    EXPECT_TRUE(limits.mayCome(often, now + 10'000'000'000));
}

TEST(GuestLimits, TakeANetworkOfIpv6ForOneGuest) {
    const auto of = [](const char* text) { return guestOf(boost::asio::ip::make_address(text)).to_string(); };
    EXPECT_EQ(of("192.0.2.1"), "192.0.2.1");
    EXPECT_EQ(of("::ffff:192.0.2.1"), "192.0.2.1");
    EXPECT_EQ(of("2001:db8:1:2:3:4:5:6"), "2001:db8:1:2::");
    GuestLimits limits;
    int came = 0;
    for (int i = 0; i < 100; ++i) {
        came += limits.mayCome(boost::asio::ip::make_address("2001:db8::" + std::to_string(i)), 1) ? 1 : 0;
    }
    EXPECT_EQ(came, 16);
}

TEST(RefusalLog, SaysItOnceAndCountsTheRest) {
    RefusalLog log;
    EXPECT_EQ(log.add(RefusalCode::secret, "a", "line", 0), "line");
    EXPECT_FALSE(log.add(RefusalCode::secret, "a", "line", 1));
    EXPECT_TRUE(log.add(RefusalCode::garbage, "a", "line", 1)) << "another kind";
    EXPECT_TRUE(log.add(RefusalCode::secret, "b", "line", 1)) << "another peer";
    EXPECT_NE(log.add(RefusalCode::secret, "a", "line", RefusalLog::kQuietNs)->find("1 more"), std::string::npos);
    EXPECT_EQ(log.counts()[static_cast<std::size_t>(RefusalCode::secret) - 1], 4U);
    std::size_t lines = 0;
    for (int i = 0; i < 5000; ++i) {
        lines += log.add(RefusalCode::garbage, "c" + std::to_string(i), "line", 2) ? 1 : 0;
    }
    EXPECT_LE(lines, RefusalLog::kRemembered + 1);
}

// A server that is a few steps behind gets those, by number; one whose sand has another history all of it.
TEST_F(LinkSecurityTest, CatchesUpByStepsOnTheSameHistoryAndByTheSandElse) {
    ServerProcess server(folder_, arguments({}));
    Wall wall(scene_);
    StepRing ring;
    const auto own = [&](int steps) {  // as a master numbers on by itself
        ++wall.epoch;
        for (int i = 0; i < steps; ++i) {
            sand::Step step{wall.epoch, wall.terrain.stepNumber() + 1, false, {}};
            step.edit = i == 0 ? sand::Edit(sand::Edit::settle) : sand::Edit();
            wall.terrain.apply(step);
            ring.add(step);
            ring.reached(step.number, wall.terrain.stateHash());
        }
    };
    const auto follow = [&](const StepRing& recent) {
        Client client(server.address(), offerOf(scene_));
        EXPECT_TRUE(eventually([&] { return client.link().link == Link::offered; })) << client.link().message;
        client.grant(++wall.epoch, wall.terrain.stepNumber(), wall.terrain.stateHash(), wall.terrain.encodeState(),
                     recent);
        const std::uint64_t until = wall.terrain.stepNumber() + 60;
        EXPECT_TRUE(eventually([&] {
            for (const auto& timed : client.drain(until - wall.terrain.stepNumber())) {
                wall.apply(timed);
                ring.add(timed.step);
                ring.reached(timed.step.number, timed.serverHash);
            }
            client.shown(wall.terrain.stepNumber(), 16'666'667);
            return wall.terrain.stepNumber() >= until;
        })) << client.link().message
            << server.errors();
        return std::pair{client.counters().catchUps, client.counters().snapshots};
    };
    using Counts = std::pair<std::uint64_t, std::uint64_t>;
    ring.reached(0, wall.terrain.stateHash());
    own(40);
    EXPECT_EQ(follow(ring), Counts(1, 0)) << "from the first step on";
    // The server is ahead now, by the steps of its window: it has another history.
    own(30);
    EXPECT_EQ(follow(ring), Counts(0, 1));
    own(10);
    StepRing forgetful;
    forgetful.reached(wall.terrain.stepNumber(), wall.terrain.stateHash());
    EXPECT_EQ(follow(forgetful), Counts(0, 1));
    EXPECT_EQ(wall.divergences + wall.outOfOrder, 0);
}

TEST_F(LinkSecurityTest, TakesSoManyCatchUpsAndNoneAfterTheLast) {
    ServerProcess server(folder_, arguments({}));
    const auto hear = [](RawPeer& peer) {  // whatever is no report
        auto message = peer.receive();
        while (message && std::holds_alternative<Report>(*message)) {
            message = peer.receive();
        }
        return message;
    };
    for (const bool last : {false, true}) {
        RawPeer master(server.port());
        master.send(hello());
        ASSERT_TRUE(master.receive()) << "the welcome";
        master.send(Start{1, 5, 1});
        const auto need = hear(master);
        ASSERT_TRUE(need && std::holds_alternative<NeedState>(*need));
        const std::size_t most = last ? 1 : StepRing::kSteps / kMaxCatchUp;
        for (std::size_t i = 0; i < most; ++i) {
            master.send(CatchUp{last, {}});
        }
        if (last) {
            ASSERT_TRUE(hear(master)) << "they do not lead there: all of the sand";
        }
        master.send(CatchUp{true, {}});
        const auto answer = hear(master);
        ASSERT_TRUE(answer && std::holds_alternative<Refusal>(*answer)) << last;
        EXPECT_NE(std::get<Refusal>(*answer).text.find("out of turn"), std::string::npos);
    }
}

TEST_F(LinkSecurityTest, WithoutASecretNoOpenSslIsMapped) {
    const auto maps = [](const ServerProcess& server) {
        std::ifstream stream("/proc/" + std::to_string(server.pid()) + "/maps");
        return std::string{std::istreambuf_iterator<char>(stream), {}};
    };
    {
        ServerProcess plain(folder_, arguments({}));
        ASSERT_NE(plain.port(), 0);
        EXPECT_EQ(maps(plain).find("libcrypto"), std::string::npos);
        EXPECT_EQ(maps(plain).find("libssl"), std::string::npos);
    }
    ServerProcess secret(folder_, arguments({"--secret-file", both_}));
    ASSERT_NE(secret.port(), 0);
    EXPECT_NE(maps(secret).find("libcrypto"), std::string::npos) << "so that this test can fail";
}

TEST_F(LinkSecurityTest, TheExampleOfAPositionServerProvesItsSecret) {
    const std::string script = SANDWALL_SOURCE_DIR "/haptic_bridge/examples/position_sender.py";
    const std::string run = "exec python3 " + script + " --listen 127.0.0.1:0 ";
    const auto port = [](FILE* output) {
        std::array<char, 200> line{};
        const std::string text = fgets(line.data(), line.size(), output) != nullptr ? line.data() : "";
        return static_cast<std::uint16_t>(std::atoi(text.substr(text.rfind(':') + 1).c_str()));
    };
    const std::string wrong = secretFile("wrong", "move another-secret-entirely\n");
    for (const auto& [option, file, fits] :
         std::vector<std::tuple<std::string, std::string, bool>>{{"--secret-file " + both_, both_, true},
                                                                 {"--secret-file " + both_, wrong, false},
                                                                 {"--secret-file " + both_, "", false},
                                                                 {"", both_, false},
                                                                 {"", "", true}}) {
        // Ends with the shell's timeout whatever happens to this test.
        FILE* sender =
            popen(("timeout 60 " + run.substr(5) + option + " 2>/dev/null & echo $! >" + folder_.file("pid") + "; wait")
                      .c_str(),
                  "r");
        ASSERT_NE(sender, nullptr);
        const Address address{"127.0.0.1", port(sender)};
        {
            Client link(address, offerOf(scene_), file.empty() ? LinkSecurity{} : client(file));
            EXPECT_TRUE(eventually([&] {
                const Link now = link.link().link;
                return now == Link::streaming || now == Link::refused || now == Link::lost ||
                       link.link().message.find("does not answer") != std::string::npos;
            }));
            EXPECT_EQ(link.link().link == Link::streaming, fits) << option << file << ": " << link.link().message;
        }
        kill(std::atoi(folder_.read("pid").c_str()), SIGTERM);
        pclose(sender);
    }
}

}  // namespace
