# SPDX-License-Identifier: Apache-2.0
"""A made-up X server, at which the launcher finds a display."""

import socket

from launcher_fixture import LauncherTest


class DisplayTest(LauncherTest):
    def display(self):
        """Returns the name of a display at which a made-up X server of this test accepts connections."""
        server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self.addCleanup(server.close)
        for number in range(20000, 30000):
            try:
                server.bind(f"\0/tmp/.X11-unix/X{number}")
                break
            except OSError:
                continue
        server.listen(64)
        return f":{number}"
