#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Waits until the launcher has ended for any reason, and then ends its job (docs/recovery.md).

    job_guard.py LIFE MPIRUN MARK [OUTPUT...]

LIFE is a pipe that ends with the launcher. If the launcher has written to it, the job has shown a frame. It then ends in order
by itself, because its input ends. This process empties the pipes of its output meanwhile, and kills it if it does not end. A
job without a frame has nothing to keep, so this process ends it at once.
"""

import contextlib
import os
import pathlib
import signal
import sys
import time

sys.dont_write_bytecode = True
if __name__ == "__main__":
    sys.path[0] = str(pathlib.Path(__file__).resolve().parents[1])
from base.process_marks import has_mark
from job import open_mpi, processes
from job.mpirun_end import EndWatch

PIECE = 1 << 18


def discard(outputs):
    for output in outputs:
        with contextlib.suppress(BlockingIOError):
            while os.read(output, PIECE):
                pass


def signal_job(mpirun, number):
    with contextlib.suppress(ProcessLookupError):
        os.killpg(mpirun, number)


def end(mpirun, mark, outputs, in_order=True):
    """Waits until the mpirun with this id and mark has ended, and kills it if it hangs or takes too long. Then kills the rest of its job."""
    watch = EndWatch(mpirun)
    asked = time.monotonic() + (processes.ORDERLY_END_SECONDS if in_order else 0)
    killed = asked + (processes.KILL_SECONDS if in_order else processes.GUARD_SECONDS)
    terminated, job_id = False, None
    while has_mark(mpirun, mark):
        discard(outputs)
        now = time.monotonic()
        stuck = watch.stuck(now)
        job_id = job_id or (watch.child and open_mpi.job_id_of(watch.child))
        if now > killed or stuck:
            signal_job(mpirun, signal.SIGKILL)
        elif now >= asked and not terminated:  # once, because mpirun gives up its orderly end after a second signal
            terminated = True
            signal_job(mpirun, signal.SIGTERM)
        time.sleep(processes.LOOK_SECONDS)
    processes.clear(mark, lambda: discard(outputs), None if in_order else 0)
    open_mpi.tidy_after(mpirun, job_id)


def main():
    life, mpirun, mark, *outputs = sys.argv[1:]
    in_order = False
    while os.read(int(life), 1):
        in_order = True
    end(int(mpirun), mark.encode(), [int(output) for output in outputs], in_order)


if __name__ == "__main__":
    main()
