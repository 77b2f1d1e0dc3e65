// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "haptic_bridge/loop/tick.hpp"

namespace haptic_bridge {

/// CSV file of --record. If the disk refuses a write, the file prints one line to the log and ends with a whole row.
/// Used by one thread.
class TickFile {
public:
    /// `log` gets one line for the user. Replaces a regular file of this name. Throws base::InputError if
    /// the file cannot be created, or if the name is that of a symbolic link or of no regular file.
    TickFile(std::string file, std::function<void(const std::string&)> log);
    ~TickFile();
    TickFile(const TickFile&) = delete;
    TickFile& operator=(const TickFile&) = delete;

    /// Adds a row for `tick`. write() writes it.
    void add(const Tick& tick);
    /// Writes the rows that were added since the last call.
    void write();

private:
    void giveUp(int error);

    std::string file_;
    std::function<void(const std::string&)> log_;
    int descriptor_ = -1;    // < 0: the disk has refused a write
    std::int64_t size_ = 0;  // [byte], length of the whole rows on disk
    std::string rows_;
};

}  // namespace haptic_bridge
