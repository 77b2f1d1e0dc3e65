// SPDX-License-Identifier: Apache-2.0
#include "lockstep/doorbell.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <climits>
#include <ctime>
#include <new>
#include <numeric>

namespace lockstep {
namespace {

using Rings = std::atomic<std::uint32_t>;
static_assert(Rings::is_always_lock_free && sizeof(Rings) == sizeof(std::uint32_t), "a futex is such a number");

constexpr MPI_Aint kApart = 64;  // [byte]: no two bells in one line of a cache

}  // namespace

// Not the private kind, which std::atomic's wait() is: that wakes nobody in another process.
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
    int ranks = 0, neighbours = 0, here = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    bells_.resize(static_cast<std::size_t>(ranks));
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host_);
    MPI_Comm_size(host_, &neighbours);
    MPI_Comm_rank(host_, &here);
    if (neighbours == 1) {
        return;
    }
    // A host without room for shared memory is no reason to end: its ranks ask, as those of several hosts do.
    MPI_Comm_set_errhandler(host_, MPI_ERRORS_RETURN);
    void* mine = nullptr;
    int gotNone =
        MPI_Win_allocate_shared(kApart, 1, MPI_INFO_NULL, host_, static_cast<void*>(&mine), &memory_) != MPI_SUCCESS;
    MPI_Allreduce(MPI_IN_PLACE, &gotNone, 1, MPI_INT, MPI_MAX, host_);
    if (gotNone != 0) {
        return;
    }
    new (mine) Rings(0);
    MPI_Barrier(host_);
    MPI_Group everyone = MPI_GROUP_NULL, onHost = MPI_GROUP_NULL;
    MPI_Comm_group(MPI_COMM_WORLD, &everyone);
    MPI_Comm_group(host_, &onHost);
    std::vector<int> numbers(static_cast<std::size_t>(neighbours)), names(numbers.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    MPI_Group_translate_ranks(onHost, neighbours, numbers.data(), everyone, names.data());
    for (const int number : numbers) {
        MPI_Aint size = 0;
        int unit = 0;
        void* theirs = nullptr;
        MPI_Win_shared_query(memory_, number, &size, &unit, static_cast<void*>(&theirs));
        const auto name = static_cast<std::size_t>(names[static_cast<std::size_t>(number)]);
        bells_.at(name).emplace(*std::launder(static_cast<Rings*>(theirs)));
    }
    MPI_Group_free(&everyone);
    MPI_Group_free(&onHost);
}

HostBells::~HostBells() {
    if (memory_ != MPI_WIN_NULL) {
        MPI_Win_free(&memory_);
    }
    MPI_Comm_free(&host_);
}

}  // namespace lockstep
