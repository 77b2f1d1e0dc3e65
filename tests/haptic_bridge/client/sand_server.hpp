// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "sand/replica.hpp"
#include "scene/model/scene.hpp"
#include "tests/haptic_bridge/client/fake_server.hpp"

namespace test {

/// A haptic server for tests. It holds sand, takes the numbering of steps over from a master, and numbers them inside
/// the wall's window as the real server does. The test chooses the hash that it sends with each step.
class SandServer {
public:
    /// Returns the hash to send with a step of link number `link`, from 1 on; `hash` is the right one.
    using HashToSend = std::function<std::uint64_t(int link, std::uint64_t step, std::uint64_t hash)>;
    static std::uint64_t truth(int /*link*/, std::uint64_t /*step*/, std::uint64_t hash) { return hash; }

    explicit SandServer(const scene::Scene& scene, HashToSend hashToSend = truth)
        : identity_{haptic_bridge::kProtocolVersion, sand::kAlgorithmVersion, scene.rules.digest(), scene.name},
          stepsPerSecond_(static_cast<std::uint32_t>(scene.rules.stepsPerSecond)),
          hashToSend_(std::move(hashToSend)),
          sand_(scene),
          server_([this](FakeServer::Connection& connection) { talk(connection); }) {}

    [[nodiscard]] haptic_bridge::Address address() const { return server_.address(); }
    [[nodiscard]] int links() const { return links_; }            // links on which it was granted the steps
    [[nodiscard]] int states() const { return states_; }          // times that it got the whole sand
    [[nodiscard]] int catchUps() const { return catchUps_; }      // times that it got the steps that it lacked
    [[nodiscard]] std::uint64_t shown() const { return shown_; }  // latest step that the wall shows
    [[nodiscard]] int requests() const { return requests_; }      // edits that were requested
    /// Returns the shares of the force that it received, in Starts and by themselves.
    [[nodiscard]] std::vector<haptic_bridge::ForceShare> shares() const {
        const std::lock_guard lock(mutex_);
        return shares_;
    }
    /// Returns whether an edit was ever requested while another one was not in a step yet.
    [[nodiscard]] bool crowded() const { return crowded_; }
    /// Makes the server claim this step from its second link on, with the hash that it sent for this step.
    void claimStep(std::uint64_t step) { claimed_ = step; }
    /// Makes the server send a step that runs more sweeps than are owed. All replicas leave it out.
    void payTooMuchIn(std::uint64_t step) { wrong_ = step; }
    /// Makes the server answer a goodbye with a last report that says `audited`. Without this call it does not answer.
    void answerByeWith(haptic_bridge::Audited audited) { answer_ = audited; }
    /// Makes the server say goodbye, with such a report, when the next frame is shown. Its sand counts as wrong then.
    void leave(haptic_bridge::Audited audited) { leaving_ = audited; }

private:
    static constexpr std::uint64_t kWindow = 8;  // [step], as docs/protocol.md has it

    void talk(FakeServer::Connection& connection) {
        if (!connection.await<haptic_bridge::Hello>()) {
            return;
        }
        connection.send(haptic_bridge::Welcome{identity_, stepsPerSecond_});
        const auto start = connection.await<haptic_bridge::StartMessage>();
        if (!start || !reach(connection, *start)) {
            return;
        }
        keepShare(start->force);
        const int link = ++links_;
        std::uint64_t shown = start->stepNumber;
        edit_.reset();
        connection.send(haptic_bridge::Ready{});
        while (true) {
            while (sand_.stepNumber() < shown + kWindow) {
                makeStep(connection, start->epoch, link);
            }
            const auto message = connection.next();
            if (!message) {
                return;
            }
            if (const auto* frame = std::get_if<haptic_bridge::Shown>(&*message)) {
                shown = std::max(shown, frame->stepNumber);
                shown_ = shown;
            }
            obey(connection, *message);
            if (const auto leaving = leaving_.exchange(haptic_bridge::Audited::no);
                leaving != haptic_bridge::Audited::no) {
                sendGoodbye(connection, leaving);
                lied_ = true;
                return;
            }
        }
    }

    static void sendGoodbye(const FakeServer::Connection& connection, haptic_bridge::Audited audited) {
        haptic_bridge::Report last;
        last.audited = audited;
        connection.send(last);
        connection.send(haptic_bridge::Bye{"enough"});
    }

    void obey(const FakeServer::Connection& connection, const haptic_bridge::Message& message) {
        if (const auto* ping = std::get_if<haptic_bridge::Ping>(&message)) {
            connection.send(haptic_bridge::Pong{ping->masterNs, 1});
        } else if (const auto* request = std::get_if<haptic_bridge::EditRequest>(&message)) {
            ++requests_;
            crowded_ = crowded_ || edit_;
            edit_ = request->edit;
        } else if (const auto* share = std::get_if<haptic_bridge::ForceShare>(&message)) {
            keepShare(*share);
        } else if (std::holds_alternative<haptic_bridge::Bye>(message) && answer_) {
            sendGoodbye(connection, *answer_);
        }
    }

    void keepShare(const haptic_bridge::ForceShare& share) {
        const std::lock_guard lock(mutex_);
        shares_.push_back(share);
    }

    [[nodiscard]] bool isAt(const haptic_bridge::StartMessage& start) {
        return sand_.stepNumber() == start.stepNumber && sand_.stateHash() == start.stateHash;
    }

    /// Gets the sand that the master begins with.
    bool reach(FakeServer::Connection& connection, const haptic_bridge::StartMessage& start) {
        if (!lied_ && isAt(start)) {
            return true;
        }
        const std::uint64_t step = links_ > 0 ? claimed_.value_or(sand_.stepNumber()) : sand_.stepNumber();
        connection.reader.expectState(true);
        connection.send(haptic_bridge::NeedState{step, sent_.contains(step) ? sent_[step] : sand_.stateHash()});
        while (const auto message = connection.next()) {
            if (const auto* state = std::get_if<haptic_bridge::State>(&*message)) {
                ++states_;
                sand_.decodeState(state->bytes);
                lied_ = false;
                return isAt(start);
            }
            if (const auto* steps = std::get_if<haptic_bridge::CatchUp>(&*message); steps != nullptr && steps->last) {
                ++catchUps_;
                connection.send(haptic_bridge::NeedState{});  // asks for the whole sand
            }
        }
        return false;
    }

    void makeStep(const FakeServer::Connection& connection, std::uint32_t epoch, int link) {
        haptic_bridge::StepMessage message;
        message.serverTimeNs = 1;
        message.step.epoch = epoch;
        message.step.number = sand_.stepNumber() + 1;
        if (edit_) {
            message.step.edit = *std::exchange(edit_, std::nullopt);
        }
        message.step.sweeps = sand_.wholeSweeps(message.step) + (message.step.number == wrong_ ? 1 : 0);
        sand_.apply(message.step);
        const std::uint64_t hash = sand_.stateHash();
        message.stateHash = sent_[message.step.number] = hashToSend_(link, message.step.number, hash);
        lied_ = lied_ || message.stateHash != hash;
        connection.send(message);
    }

    const haptic_bridge::Identity identity_;
    const std::uint32_t stepsPerSecond_;
    const HashToSend hashToSend_;
    // For the server thread only.
    sand::Replica sand_;
    std::map<std::uint64_t, std::uint64_t> sent_;  // hashes that were sent, by step
    std::optional<sand::Edit> edit_;               // edit for the next step
    bool lied_ = false;                            // sent a wrong hash; its sand counts as wrong until it gets a state

    std::atomic<int> links_{0}, states_{0}, catchUps_{0}, requests_{0};
    std::atomic<std::uint64_t> shown_{0};
    std::atomic<bool> crowded_{false};
    std::atomic<std::uint64_t> wrong_{0};
    std::optional<haptic_bridge::Audited> answer_;
    std::atomic<haptic_bridge::Audited> leaving_{haptic_bridge::Audited::no};
    mutable std::mutex mutex_;
    std::vector<haptic_bridge::ForceShare> shares_;  // guarded by mutex_
    std::optional<std::uint64_t> claimed_;
    FakeServer server_;  // the last member: its thread uses all others
};

}  // namespace test
