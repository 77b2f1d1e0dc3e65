// SPDX-License-Identifier: Apache-2.0
#include "host/core_dump.hpp"

#include <sys/prctl.h>
#include <sys/resource.h>

namespace host {

void forbidCoreDumps() {
    // A core file of at most one byte is not written. The kernel ignores any other limit, also 0, if a program collects
    // cores (|PROGRAM in core_pattern). It takes the limit 1 for that program's own crash, and writes no core.
    const rlimit none{1, 1};
    if (setrlimit(RLIMIT_CORE, &none) != 0) {
        // The administrator allows no core file, and only root may raise that limit to 1. This call is the second
        // choice, because Open MPI can then no longer copy between the memories of two ranks of an ordinary user.
        prctl(PR_SET_DUMPABLE, 0);
    }
}

}  // namespace host
