// SPDX-License-Identifier: Apache-2.0
// One end of a connection against a peer that may send anything.
#include "haptic_bridge/link/connection.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/write.hpp>

#include "haptic_bridge/link/link_options.hpp"
#include "tests/support/processes/server_process.hpp"

namespace {

using namespace haptic_bridge;
using namespace test;
namespace asio = boost::asio;

/// A TLS session whose behaviour the test chooses.
struct FalseTls : TlsSession {
    bool agreed = false, broken = false, swallows = false;
    void receive(ByteSpan bytes, base::Bytes& plain, base::Bytes&) override {
        // 'e' ends the handshake. 'b' begins a handshake message that never ends. Other bytes are data.
        agreed = bytes[0] == 22 || bytes[0] == 'e';
        broken = bytes[0] == 'b';
        plain.assign(bytes.begin() + 1, swallows ? bytes.begin() + 1 : bytes.end());
    }
    void begin(base::Bytes&) override {}
    void seal(ByteSpan plain, base::Bytes& sealed) override {
        if (broken) {
            throw std::runtime_error("cannot be sealed");
        }
        sealed.assign(plain.begin(), plain.end());
    }
    [[nodiscard]] bool established() const override { return agreed; }
    [[nodiscard]] base::Bytes binding() const override { return {1, 2, 3}; }
};

class ConnectionTest : public testing::Test {
protected:
    /// The server's end of a connection within this process.
    std::shared_ptr<Connection> serve(std::unique_ptr<TlsSession> tls = nullptr) {
        asio::ip::tcp::acceptor acceptor(io_, {asio::ip::address_v4::loopback(), 0});
        other_.connect(acceptor.local_endpoint());
        connection_ = std::make_shared<Connection>(acceptor.accept(), std::move(tls));
        return connection_;
    }
    void start(std::function<void(Message&&)> message = [](Message&&) {}) {
        connection_->start({std::move(message),
                            [this](const std::string& why, Connection::Fault fault) {
                                ++closed_;
                                why_ = why;
                                fault_ = fault;
                            },
                            true, [this] { ++ready_; }});
    }
    void sendBytes(const base::Bytes& bytes) { asio::write(other_, asio::buffer(bytes)); }
    template <class Done>
    bool runUntil(const Done& done) {
        return eventually([&] {
            io_.restart();
            io_.poll();
            return done();
        });
    }

    asio::io_context io_;
    asio::ip::tcp::socket other_{io_};
    std::shared_ptr<Connection> connection_;
    int closed_ = 0, ready_ = 0;
    std::string why_;
    Connection::Fault fault_;
};

TEST_F(ConnectionTest, ASealThatFailsClosesAndIsReadyOnce) {
    serve(std::make_unique<FalseTls>());
    int messages = 0;
    start([&](Message&&) { ++messages; });
    sendBytes({22});
    ASSERT_TRUE(runUntil([&] { return ready_ == 1; }));
    EXPECT_EQ(connection_->binding(), (base::Bytes{1, 2, 3}));
    sendBytes({'b'});
    ASSERT_TRUE(runUntil([&] { return connection_->bytesIn() == 2; }));
    sendBytes({'e'});
    ASSERT_TRUE(runUntil([&] { return connection_->bytesIn() == 3; }));
    EXPECT_EQ(ready_, 1) << "not at every message of the handshake";
    sendBytes({'b'});
    ASSERT_TRUE(runUntil([&] { return connection_->bytesIn() == 4; }));
    EXPECT_NO_THROW(connection_->send(Ready{}));
    EXPECT_EQ(why_, "TLS failed: cannot be sealed");
    EXPECT_EQ(fault_, RefusalCode::tls);
    EXPECT_NO_THROW(connection_->send(Ready{}));
    EXPECT_EQ(closed_, 1);
}

TEST_F(ConnectionTest, SendsNothingOverTlsThatIsNotAgreedOn) {
    serve(loadSecurity("test").tlsServer("", "")->open());
    start();
    EXPECT_NO_THROW(connection_->send(Bye{"too early"}));
    EXPECT_EQ(fault_, RefusalCode::tls) << why_;
    EXPECT_EQ(closed_, 1);
}

TEST_F(ConnectionTest, RefusesWhoDoesNotReadOnce) {
    serve()->setMaxUnsent(10);
    start();
    sendBytes({255, 255, 255, 255, 1});
    ASSERT_TRUE(runUntil([&] { return closed_ > 0; }));
    EXPECT_EQ(closed_, 1);
    EXPECT_EQ(fault_, RefusalCode::limit) << why_;
}

TEST_F(ConnectionTest, CutsOffWhoSendsMoreThanItMay) {
    serve()->setMaxIn(5000);
    start();
    base::Bytes pings;
    for (int i = 0; i < 200; ++i) {
        const base::Bytes ping = encode(Ping{7});
        pings.insert(pings.end(), ping.begin(), ping.end());
    }
    sendBytes(pings);
    ASSERT_TRUE(runUntil([&] { return connection_->bytesIn() == pings.size(); }));
    EXPECT_EQ(closed_, 0);
    sendBytes(pings);
    ASSERT_TRUE(runUntil([&] { return closed_ > 0; }));
    EXPECT_EQ(why_, "its greeting is too long");
    EXPECT_EQ(fault_, RefusalCode::limit);
}

TEST_F(ConnectionTest, ReadsMoreSlowlyFromWhoSendsRecordsAndNoMessages) {
    auto tls = std::make_unique<FalseTls>();
    tls->swallows = true;
    serve(std::move(tls))->setRate(50);
    start();
    base::Bytes records(64 * 1024, 3);
    records[0] = 22;
    sendBytes(records);
    EXPECT_TRUE(runUntil([&] { return connection_->throttled() > 0; }));
    EXPECT_EQ(closed_, 0) << why_;
}

/// Both ends of real TLS, in memory.
class TlsEnds : public testing::Test {
protected:
    void SetUp() override {
        base::Bytes there, back, plain;
        clientEnd_->begin(there);
        while (!there.empty() || !back.empty()) {
            const base::Bytes forth = std::exchange(there, {}), answers = std::exchange(back, {});
            serverEnd_->receive(forth, plain, back);
            clientEnd_->receive(answers, plain, there);
        }
        ASSERT_TRUE(serverEnd_->established() && clientEnd_->established());
    }
    const Security& security_ = loadSecurity("test");
    std::unique_ptr<TlsContext> server_ = security_.tlsServer("", ""), client_ = security_.tlsClient();
    std::unique_ptr<TlsSession> serverEnd_ = server_->open(), clientEnd_ = client_->open();
};

TEST_F(TlsEnds, CarryMuchInRecordsOfSixteenKibibytes) {
    base::Bytes much(1'000'000), sealed, plain, reply;
    for (std::size_t i = 0; i < much.size(); ++i) {
        much[i] = static_cast<std::uint8_t>(i * 7 + i / 1000);
    }
    serverEnd_->seal(much, sealed);
    clientEnd_->receive(sealed, plain, reply);
    EXPECT_EQ(plain, much);
}

}  // namespace
