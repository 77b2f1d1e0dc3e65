#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Waits until the launcher has ended for any reason, and then ends its job (docs/recovery.md).

    job_guard.py LIFE MPIRUN MARK [OUTPUT...]

LIFE is a pipe that ends with the launcher. The job ends in order by itself, because its input ends. This
process empties the pipes of its output meanwhile, and kills it if it does not end.
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
from job import processes
from job.mpirun_end import EndWatch

PIECE = 1 << 18


def discard(outputs):
    for output in outputs:
        with contextlib.suppress(BlockingIOError):
            while os.read(output, PIECE):
                pass


def end(mpirun, mark, outputs):
    """Waits until the mpirun with this id and mark has ended, and kills it if it hangs or takes too long. Then kills the rest of its job."""
    watch = EndWatch(mpirun)
    asked = time.monotonic() + processes.ORDERLY_END_SECONDS
    killed = asked + processes.KILL_SECONDS
    while has_mark(mpirun, mark):
        discard(outputs)
        now = time.monotonic()
        if now > asked or watch.stuck(now):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(mpirun, signal.SIGKILL if now > killed or watch.stuck(now) else signal.SIGTERM)
        time.sleep(processes.LOOK_SECONDS)
    processes.clear(mark, lambda: discard(outputs))


def main():
    life, mpirun, mark, *outputs = sys.argv[1:]
    os.read(int(life), 1)
    end(int(mpirun), mark.encode(), [int(output) for output in outputs])


if __name__ == "__main__":
    main()
