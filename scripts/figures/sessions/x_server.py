# SPDX-License-Identifier: Apache-2.0
"""An X server in memory (Xvfb), for measurements and tests."""

import os
import subprocess

from sessions.measured_session import die_with_parent

END_SECONDS = 30


class XServer:
    """An X server on a free display with one screen of `size`, such as "640x480". It ends with its `with` block, or by end().

    `words` are more words for its command line.
    """

    def __init__(self, size, *words):
        self.process = subprocess.Popen(["Xvfb", "-displayfd", "1", "-nolisten", "tcp", "-noreset", "-screen", "0", f"{size}x24", *map(str, words)],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, preexec_fn=die_with_parent)
        self.display = ":" + self.process.stdout.readline().strip()
        self.environment = {**os.environ, "DISPLAY": self.display}

    def end(self):
        # An Xvfb that had just started on a busy machine once ignored the signal, and ended at the second one.
        for _ in range(END_SECONDS):
            self.process.terminate()
            try:
                self.process.wait(1)
                break
            except subprocess.TimeoutExpired:
                pass
        else:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()
