# SPDX-License-Identifier: Apache-2.0
"""A temporary folder that is also removed after the launcher was killed."""

import shutil
import subprocess
import tempfile

# Reads until its input ends, which happens when this process ends for any reason.
REMOVE_AFTER = 'while read -r _; do :; done; rm -rf -- "$1"'


class TemporaryFolder:
    """Scope in which a folder exists. A shell that waits for the end of this process removes it if the scope does not end."""

    def __enter__(self):
        self.folder = tempfile.mkdtemp(prefix="sandwall-")
        try:
            # In a session of its own, because Ctrl-C in a terminal ends all processes of the terminal's session.
            self.remover = subprocess.Popen(["sh", "-c", REMOVE_AFTER, "sh", self.folder], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL, start_new_session=True)
        except BaseException:
            self.remove()
            raise
        return self.folder

    def __exit__(self, *_):
        # The shell ends first. Another process could make a folder of the same name after the removal.
        self.remover.kill()
        self.remover.stdin.close()
        self.remover.wait()
        self.remove()

    def remove(self):
        shutil.rmtree(self.folder, ignore_errors=True)
