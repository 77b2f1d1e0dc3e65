// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/server/loading_answers.hpp"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <exception>
#include <optional>
#include <utility>

namespace haptic_bridge {

namespace asio = boost::asio;

namespace {

constexpr std::chrono::milliseconds kQuiet{1000};  // the peers of a shorter load wait without an answer

Service serviceWhileLoading(asio::io_context& io, const LinkSecurity& security,
                            std::function<void(const std::string&)> log, const std::atomic<std::uint32_t>& done) {
    Service service{.io = io};
    service.log = std::move(log);
    service.security = security;
    service.loading = [&done] { return done.load(); };
    return service;
}

}  // namespace

LoadingAnswers::LoadingAnswers(asio::io_context& io, asio::ip::tcp::acceptor acceptor, const LinkSecurity& security,
                               std::function<void(const std::string&)> log)
    : io_(io), listener_(serviceWhileLoading(io, security, log, done_), std::move(acceptor)) {
    listener_.answerLoading(kQuiet);
    thread_ = std::thread([this, log = std::move(log)] {
        const auto work = asio::make_work_guard(io_);
        while (!io_.stopped()) {
            try {
                io_.run();
            } catch (const std::exception& error) {  // of one link, which ends after a time of silence
                log(std::string("a link failed: ") + error.what());
            }
        }
    });
}

LoadingAnswers::~LoadingAnswers() {
    if (thread_.joinable()) {
        io_.stop();
        thread_.join();
    }
}

void LoadingAnswers::setDone(double share) {
    const auto done = static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * Loading::kAll);
    done_ = std::max(done_.load(), done);
}

asio::ip::tcp::acceptor LoadingAnswers::end() {
    done_ = Loading::kAll;
    std::optional<asio::ip::tcp::acceptor> acceptor;
    std::exception_ptr failed;
    asio::post(io_, [&] {
        try {
            acceptor.emplace(listener_.endLoading());
        } catch (...) {
            failed = std::current_exception();
        }
        io_.stop();
    });
    thread_.join();
    io_.restart();
    while (!acceptor && !failed) {  // something else has stopped the thread before
        io_.run_one();
        io_.restart();
    }
    if (failed) {
        std::rethrow_exception(failed);
    }
    return std::move(*acceptor);
}

}  // namespace haptic_bridge
