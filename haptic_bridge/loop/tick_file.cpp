// SPDX-License-Identifier: Apache-2.0
#include "haptic_bridge/loop/tick_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/input_error.hpp"
#include "haptic_bridge/loop/tick_track.hpp"
#include "host/regular_file.hpp"

namespace haptic_bridge {

TickFile::TickFile(std::string file, std::function<void(const std::string&)> log)
    : file_(std::move(file)), log_(std::move(log)), rows_(tickTitles()) {
    if (const std::string special = host::whyNotReplaceable(file_); !special.empty()) {
        throw base::InputError(fmt::format("--record {}: {}; give the name of a new file", file_, special));
    }
    // A new file, because the previous one of this name could have a second name, or another user could write to it.
    descriptor_ = host::makeFile(file_);
    if (descriptor_ < 0) {
        throw base::InputError(fmt::format("--record {}: cannot be created ({}); give a file in a folder that exists",
                                           file_, std::strerror(errno)));
    }
}

TickFile::~TickFile() {
    if (descriptor_ >= 0) {
        close(descriptor_);
    }
}

void TickFile::add(const Tick& tick) { appendRow(tick, rows_); }

void TickFile::write() {
    if (descriptor_ >= 0 &&
        !host::writeAll(descriptor_, {reinterpret_cast<const std::uint8_t*>(rows_.data()), rows_.size()})) {
        giveUp(errno);
    }
    size_ += static_cast<std::int64_t>(rows_.size());
    rows_.clear();
}

void TickFile::giveUp(int error) {
    // The disk may have written half a row. The file is cut so that it ends with a whole row.
    [[maybe_unused]] const int cut = ftruncate(descriptor_, size_);
    close(descriptor_);
    descriptor_ = -1;
    log_(fmt::format("--record {}: cannot be written ({}); the file ends here, and the session continues", file_,
                     std::strerror(error)));
}

}  // namespace haptic_bridge
