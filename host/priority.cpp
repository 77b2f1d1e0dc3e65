// SPDX-License-Identifier: Apache-2.0
#include "host/priority.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace host {

void lowerPriority() {
    // A tenth of the weight of a normal thread: on a busy machine the work still ends. On Linux a nice value belongs to
    // one thread. If the value cannot be set, the thread keeps its priority.
    constexpr int kNice = 10;
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice);
}

}  // namespace host
