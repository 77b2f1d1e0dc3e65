// SPDX-License-Identifier: Apache-2.0
#include "lockstep/doorbell.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <ctime>
#include <new>
#include <random>
#include <string>

namespace lockstep {
namespace {

using Number = std::atomic<std::uint32_t>;
static_assert(Number::is_always_lock_free && sizeof(Number) == sizeof(std::uint32_t),
              "a futex is a lock-free number of 32 bits");

/// Returns a random name, the same on all ranks. Other users cannot guess it.
std::string agreeOnName() {
    std::random_device random;
    std::uint64_t number = std::uint64_t{random()} << 32 | random();
    MPI_Bcast(&number, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
    return fmt::format("/sandwall-{:016x}", number);
}

/// Opens shared memory with the name `name`. It is all zero if no process has opened it before. Returns null if there
/// is no room.
void* openMemory(const std::string& name, std::size_t bytes) {
    const int file = shm_open(name.c_str(), O_CREAT | O_RDWR, S_IRUSR | S_IWUSR);
    if (file < 0) {
        return nullptr;
    }
    // Reserves the memory now. Without this, a process that writes to it is killed when the memory of the host is used
    // up.
    const bool hasRoom = posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0;
    void* const memory = hasRoom ? mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
    close(file);
    return memory == MAP_FAILED ? nullptr : memory;
}

}  // namespace

/// The numbers of one rank, in a cache line of their own.
struct alignas(64) HostBells::Slot {
    Number rings, here;  // here: 1 after its rank has opened this memory
};

// Uses the shared kind of futex. The private kind, which std::atomic's wait() uses, wakes no thread of another process.
void Doorbell::ring() const {
    rings_->fetch_add(1, std::memory_order_release);
    syscall(SYS_futex, rings_, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

bool Doorbell::sleep(std::uint32_t heard, std::int64_t limit) const {
    constexpr std::int64_t kSecond = 1'000'000'000;
    const timespec most{.tv_sec = limit / kSecond, .tv_nsec = limit % kSecond};
    syscall(SYS_futex, rings_, FUTEX_WAIT, heard, &most, nullptr, 0);
    return rings() != heard;
}

HostBells::HostBells() {
    int ranks = 0, self = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Comm_rank(MPI_COMM_WORLD, &self);
    bells_.resize(static_cast<std::size_t>(ranks));
    const std::string name = agreeOnName();
    slots_ = static_cast<Slot*>(openMemory(name, bells_.size() * sizeof(Slot)));
    if (slots_ != nullptr) {
        new (slots_ + self) Slot{0, 1};  // a slot of zeros belongs to a rank that is not here
    }
    MPI_Barrier(MPI_COMM_WORLD);
    shm_unlink(name.c_str());  // all ranks of this host have opened it; the last one to close it frees it
    if (slots_ == nullptr) {
        return;
    }
    for (std::size_t rank = 0; rank < bells_.size(); ++rank) {
        if (slots_[rank].here.load() != 0) {
            bells_[rank].emplace(slots_[rank].rings);
        }
    }
    if (std::count_if(bells_.begin(), bells_.end(), [](const auto& bell) { return bell.has_value(); }) == 1) {
        release();
    }
}

void HostBells::release() {
    std::fill(bells_.begin(), bells_.end(), std::nullopt);
    munmap(slots_, bells_.size() * sizeof(Slot));
    slots_ = nullptr;
}

HostBells::~HostBells() {
    if (slots_ != nullptr) {
        release();
    }
}

}  // namespace lockstep
