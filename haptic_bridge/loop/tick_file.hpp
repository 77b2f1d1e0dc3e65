// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "haptic_bridge/loop/tick.hpp"

namespace haptic_bridge {

/// The CSV file of --record. A disk that refuses is told in one line; the file then ends with a whole row. One thread.
class TickFile {
public:
    /// `log` gets one line for a person. Throws base::InputError when the file cannot be made.
    TickFile(std::string file, std::function<void(const std::string&)> log);
    ~TickFile();
    TickFile(const TickFile&) = delete;
    TickFile& operator=(const TickFile&) = delete;

    void add(const Tick& tick);
    /// Writes the rows that were added since.
    void write();

private:
    void giveUp(int error);

    std::string file_;
    std::function<void(const std::string&)> log_;
    int descriptor_ = -1;    // < 0: the disk has refused
    std::int64_t size_ = 0;  // [byte], whole rows on disk
    std::string rows_;
};

}  // namespace haptic_bridge
