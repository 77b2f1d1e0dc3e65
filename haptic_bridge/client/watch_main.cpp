// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/input_error.hpp"
#include "haptic_bridge/link/connection.hpp"
#include "haptic_bridge/link/link_options.hpp"
#include "haptic_bridge/link/silence.hpp"
#include "host/clock.hpp"
#include "host/command_line.hpp"
#include "host/version.hpp"

namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using namespace haptic_bridge;

/// Watches one haptic server, and prints a line per second.
class Watcher {
public:
    Watcher(asio::io_context& io, const LinkSecurity& security, std::uint64_t lines)
        : timer_(io), security_(security), linesLeft_(lines) {}

    /// Connects to the server. Throws base::InputError if no server answers.
    void connect(asio::io_context& io, const Address& address) {
        asio::ip::tcp::socket socket(io);
        error_code error;
        asio::ip::tcp::resolver resolver(io);
        const auto found = resolver.resolve(address.host, std::to_string(address.port), error);
        if (!error) {
            asio::connect(socket, found, error);
        }
        if (error) {
            throw base::InputError(fmt::format("{}: {}", address.text(), error.message()));
        }
        connection_ = std::make_shared<Connection>(std::move(socket), security_.tls ? security_.tls->open() : nullptr);
        if (!security_.proves() && !isLoopback(connection_->address())) {
            throw base::InputError(address.text() + ": is another machine; --secret-file is needed");
        }
        connection_->start({[this](Message&& message) { receive(message); },
                            [this](const std::string& why, Connection::Fault) { end(why); }, false,
                            [this] { greet(); }});
        tick();
    }

    void stop() {
        ended_ = "";
        if (welcomed_) {
            connection_->send(Bye{"the watcher has ended"});
        }
        connection_->finish();
        timer_.cancel();
    }
    [[nodiscard]] const std::optional<std::string>& ended() const { return ended_; }
    /// Returns whether the server has said goodbye because its scene is read. It then takes another connection.
    [[nodiscard]] bool mayComeAgain() const { return readsScene_; }

private:
    void greet() {
        handshake_.emplace(security_, Identity{}, Role::watch, connection_->binding());
        connection_->send(handshake_->hello());
    }

    void receive(const Message& message) {
        silence_.heard(host::monotonicNs());
        if (const auto* loading = std::get_if<Loading>(&message); loading != nullptr && !welcomed_) {
            wait(*loading);
            return;
        }
        if (const auto* refusal = std::get_if<Refusal>(&message)) {
            end("refuses: " + refusal->text);
        } else if (const auto* bye = std::get_if<Bye>(&message)) {
            end("says goodbye: " + bye->reason);
            readsScene_ = !welcomed_;  // only a server that reads its scene leaves before the Welcome
        } else if (const auto* challenge = std::get_if<Challenge>(&message)) {
            if (const auto proof = handshake_->answer(*challenge)) {
                connection_->send(*proof);
            } else {
                end(handshake_->because().text);
            }
        } else if (const auto* welcome = std::get_if<Welcome>(&message)) {
            if (!handshake_->accepts(*welcome)) {
                end(handshake_->because().text);
                return;
            }
            fmt::print("scene '{}', {} steps per second\n", welcome->server.sceneName, welcome->stepsPerSecond);
            welcomed_ = true;
        } else if (const auto* step = std::get_if<StepMessage>(&message); step != nullptr && welcomed_) {
            ++steps_;
            last_ = step->step;
            hash_ = step->stateHash;
            if (!step->step.path.empty()) {
                probe_ = step->step.path.back();
            }
        }
    }

    /// Waits for a server that reads its scene.
    void wait(const Loading& loading) {
        if (!handshake_->accepts(loading)) {
            end(handshake_->because().text);
            return;
        }
        if (!std::exchange(loading_, true)) {
            fmt::print("the server reads its scene\n");
            std::fflush(stdout);
        }
        connection_->send(Ping{host::monotonicNs()});
    }

    void tick() {
        timer_.expires_after(std::chrono::seconds(1));
        timer_.async_wait([this](error_code error) {
            if (error) {
                return;
            }
            if (silence_.lengthNs(host::monotonicNs()) > kSilenceNs) {
                end(fmt::format("silent for {} s", kSilenceNs / 1'000'000'000));
                return;
            }
            if (welcomed_) {
                connection_->send(Ping{host::monotonicNs()});
                constexpr double kUnits = sand::kProbePerCell;
                fmt::print("step {} {:016x}, probe at {:.2f} {:.2f} {:.2f} cells{}, {} steps/s, {} bytes/s\n",
                           last_.number, hash_, probe_.x / kUnits, probe_.y / kUnits, probe_.z / kUnits,
                           last_.engaged ? " in the sand" : "", steps_, connection_->bytesIn() - bytes_);
                std::fflush(stdout);
                if (linesLeft_ > 0 && --linesLeft_ == 0) {
                    stop();
                    return;
                }
            }
            steps_ = 0;
            bytes_ = connection_->bytesIn();
            tick();
        });
    }

    void end(const std::string& why) {
        ended_ = why;
        timer_.cancel();
        connection_->finish();
    }

    asio::steady_timer timer_;
    const LinkSecurity& security_;
    std::shared_ptr<Connection> connection_;
    std::optional<MasterHandshake> handshake_;
    std::uint64_t linesLeft_, steps_ = 0, bytes_ = 0, hash_ = 0;
    sand::Step last_;
    sand::ProbePoint probe_;
    Silence silence_{host::monotonicNs()};
    bool welcomed_ = false, loading_ = false, readsScene_ = false;
    std::optional<std::string> ended_;
};

int run(const std::string& address, const LinkOptions& options, std::uint64_t lines) {
    const LinkSecurity security = options.forClient(Role::watch);
    asio::io_context io;
    std::vector<std::unique_ptr<Watcher>> watchers;  // earlier ones stay, because their connections still close
    bool stopped = false;
    asio::signal_set signals(io, SIGINT, SIGTERM);
    signals.async_wait([&](error_code error, int) {
        if (!error) {
            stopped = true;
            watchers.back()->stop();
        }
    });
    do {
        watchers.push_back(std::make_unique<Watcher>(io, security, lines));
        watchers.back()->connect(io, Address::parse(address, "server"));
        while (!watchers.back()->ended() && io.run_one() > 0) {
        }
    } while (!stopped && watchers.back()->mayComeAgain());
    if (const std::string& why = *watchers.back()->ended(); !stopped && !why.empty()) {
        throw std::runtime_error(address + ": " + why);
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (host::answersVersion(argc, argv, "sandwall-watch", {{"protocol", haptic_bridge::kProtocolVersion}})) {
        return 0;
    }
    host::CommandLine line("Prints once a second what the hand of a haptic server does. It cannot move the probe.",
                           "sandwall-watch");
    std::string address;
    LinkOptions options;
    std::uint64_t lines = 0;
    line.option("server", address, "HOST:PORT of the haptic server").required();
    line.option("--lines", lines, "end after this many lines (default: 0, end with the server)");
    options.addTo(line, false);
    return host::runMain(line, argc, argv, [&] { return run(address, options, lines); });
}
