// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "master/operator/operator_desk.hpp"
#include "tests/support/files/folder_test.hpp"
#include "tests/support/processes/control_client.hpp"
#include "tests/support/sand/no_steps.hpp"
#include "tests/support/sand/sand_samples.hpp"

namespace test {

using master::ArrivedStep;
using nlohmann::json;

/// Records the shares of the force that the desk sets.
class Force : public master::ForceControl {
public:
    void shareForce(double share) override { shares.push_back(share); }
    [[nodiscard]] std::optional<double> forceCeiling() const override { return ceiling; }

    std::vector<double> shares;
    std::optional<double> ceiling;  // of the linked server
};

/// A desk without a wall. Clients talk to it through its control socket.
class OperatorDeskTest : public FolderTest {
protected:
    OperatorDeskTest() : OperatorDeskTest(samples::flatScene(32, 24)) {}
    explicit OperatorDeskTest(scene::Scene scene) : scene_(std::move(scene)) { sand_.keepHistory(scene_.material); }
    void SetUp() override { open(&force_); }
    void open(master::ForceControl* force, const master::DeskOptions& options = {}) {
        desk_.reset();
        desk_.emplace(scene_, scene_.material, wall_, folder_, options,
                      master::OperatorDesk::SessionParts{sand_, edits_, force,
                                                         [this](std::int64_t bytes) {
                                                             bytes_ = bytes;
                                                             return room_ && bytes <= most_;
                                                         },
                                                         [this](double share) { kept_.push_back(share); },
                                                         [] {
                                                             return json{{"frame", 42}};
                                                         }});
    }
    /// Sends a line from another thread. The future has the answer.
    std::future<json> send(const std::string& line) {
        return std::async(std::launch::async, [this, line] { return support::askSession(folder_, line); });
    }
    json await(std::future<json>& answer) {
        obeyUntil([&] { return answer.wait_for(std::chrono::milliseconds(1)) == std::future_status::ready; });
        return answer.get();
    }
    json ask(const std::string& line) {
        std::future<json> answer = send(line);
        return await(answer);
    }
    /// Calls obey() until `done`. After a minute it closes the desk, so that waiting clients return, and throws.
    void obeyUntil(const std::function<bool()>& done) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (!done()) {
            if (std::chrono::steady_clock::now() > end) {
                desk_.reset();
                throw std::runtime_error("the desk did not do within a minute what this test waits for");
            }
            desk_->obey({});
        }
    }
    /// Returns all edits that were asked for, also those that were shown.
    const std::vector<sand::Edit>& edits() {
        for (const master::Edits::Asked& asked : edits_.waiting()) {
            if (asked_.empty() || asked.edit.number > asked_.back().number) {
                asked_.push_back(asked.edit);
            }
        }
        return asked_;
    }
    /// Shows a step with the edit `edit`.
    void show(const sand::Edit& edit) {
        std::vector<ArrivedStep> steps(1);
        steps[0].step.number = sand_.replica().stepNumber() + 1;
        steps[0].step.edit = edit;
        edits_.moveInto(steps);
        sand_.apply(1, steps, 0, source_);
        desk_->answer(steps);
    }

    scene::Scene scene_;
    walls::Wall wall_ = walls::loadWall(SANDWALL_SOURCE_DIR "/walls/configs/anaglyph_half.toml");
    master::MasterSand sand_{sand::Replica(scene_)};
    NoSteps source_;
    master::Edits edits_;
    std::vector<sand::Edit> asked_;
    Force force_;
    bool room_ = true;
    std::vector<double> kept_;                   // shares of the force that the journal got
    std::int64_t most_ = std::int64_t{1} << 62;  // room on the disk [byte]
    std::int64_t bytes_ = -1;
    std::optional<master::OperatorDesk> desk_;
};

}  // namespace test
