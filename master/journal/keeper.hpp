// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "master/journal/resume.hpp"
#include "master/journal/writer.hpp"
#include "sand/replica.hpp"
#include "scene/scene.hpp"

namespace master {

/// What happens when the disk refuses.
enum class JournalPolicy : std::uint8_t {
    required,    // no step is shown that is not on disk
    bestEffort,  // the session goes on without a journal
    off          // there is none
};
/// Throws base::InputError for other words than required, best-effort and off.
[[nodiscard]] JournalPolicy parseJournalPolicy(const std::string& word);
[[nodiscard]] std::string_view journalPolicyName(JournalPolicy policy);

struct JournalOptions {
    JournalPolicy policy = JournalPolicy::required;
    double checkpointSeconds = 30;  // 0: no checkpoints
    std::int64_t partBytes = kPartBytes;
};

/// The disk has refused steps of a session that may not go on without.
class DiskFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Keeps a session on disk: journal and checkpoints, under a policy. Says on standard error what the disk refuses.
/// Main thread; checkpoints are compressed and written on another.
class JournalKeeper {
public:
    /// Begins OUT/session.journal, or goes on with that of `resumed`. Throws base::InputError when it cannot be made,
    /// std::runtime_error while another session writes it, and when it is not what was read any more.
    JournalKeeper(const std::filesystem::path& out, const JournalOptions& options, const scene::Scene& scene,
                  const ResumedSession* resumed, const std::string& failure, std::string buildId);
    ~JournalKeeper();
    JournalKeeper(const JournalKeeper&) = delete;
    JournalKeeper& operator=(const JournalKeeper&) = delete;

    /// Whether steps of at most so many bytes may be taken: where the policy is required and the disk has no room for
    /// them, they may not. Asked before every frame; the disk is asked again about once a second. `now` is the sand
    /// that the wall shows.
    [[nodiscard]] bool mayTake(std::int64_t bytes, const JournalEnd& now);
    /// Returns when the steps are on disk. Throws DiskFailure when the disk refuses them and the policy is required.
    void keep(const JournalFrame& frame, const std::vector<scene::Material>& materials);
    /// Pieces of the tick track: on disk with later steps. Throws as keep() does.
    void keepTicks(const std::vector<base::Bytes>& pieces);
    /// After every frame: begins a checkpoint when it is time to. All steps of the sand are in the journal.
    void shown(const sand::Replica& terrain, std::uint64_t frame, std::uint32_t epoch, std::uint64_t hash);
    void finish(const JournalEnd& end);

    [[nodiscard]] JournalPolicy policy() const { return options_.policy; }
    /// written, no_room, failed or off.
    [[nodiscard]] std::string_view state() const;
    [[nodiscard]] bool written() const { return writer_.has_value(); }
    [[nodiscard]] std::uint32_t parts() const { return writer_ ? writer_->part() : 0; }
    /// What checkpoints cost the frame loop [ms], each.
    [[nodiscard]] const std::vector<double>& copyMs() const { return copyMs_; }
    [[nodiscard]] std::uint64_t checkpointsFailed() const { return checkpointsFailed_; }
    /// How often, and how long altogether, the sand stood because the disk was full.
    [[nodiscard]] std::uint64_t stands() const { return stands_; }
    [[nodiscard]] double stoodSeconds() const;
    /// That a session before has left behind the end of its journal, which has lost steps; set aside.
    [[nodiscard]] std::uint64_t checkpointsBeyond() const { return checkpointsBeyond_; }

private:
    [[nodiscard]] bool hasRoom(std::int64_t bytes, const JournalEnd& now);
    void giveUp(const std::string& why);
    void refused(const std::string& why);
    void requireNoWriter() const;
    void setAside(std::uint64_t step);
    void endCheckpoint(bool wait);

    JournalOptions options_;
    std::filesystem::path journal_;
    std::string buildId_;
    std::uint64_t sceneDigest_;
    std::optional<JournalWriter> writer_;  // none: off, or failed
    bool standing_ = false;                // for want of room
    double stoodSince_ = 0, lastTry_ = 0;  // [s]
    std::uint64_t stands_ = 0;
    double stoodSeconds_ = 0;
    double lastCheckpoint_ = 0;  // [s]
    std::uint64_t checkpointStep_ = 0;
    std::future<std::string> checkpoint_;  // that is being written; its complaint
    std::string complaint_;                // of the last one
    std::uint64_t checkpointsFailed_ = 0, checkpointsBeyond_ = 0;
    bool ticksLeftOut_ = false;
    std::vector<double> copyMs_;
};

}  // namespace master
