# SPDX-License-Identifier: Apache-2.0
"""The window of `sandwall try` on an X server in memory with a window manager. All tests of a process share one session."""

import atexit
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import picture_files
import pointer_fixture

SCREEN = (1024, 768)
CURSOR = 24  # [pixel], more than the cursor's part right of and below its place
CELLS, WIDTH = 96, 2.0  # of the field
RC = pathlib.Path("/etc/xdg/openbox/rc.xml")
FULL_SCREEN = "alt+F10"  # asks the window manager for full screen, and back

# A mountain whose summit is above the screen at the stage of walls/configs/desktop.toml. The sand in its south is level.
SCENE = """name = "mountain"
[field]
columns = 96
[terrain]
kind = "function"
z = "0.2 + 1.0*exp(-8*((x-1)^2 + (y-1.7)^2))"
x = [0.0, 2.0]
y = [0.0, 2.0]
[material]
talus_deg = 80  # the mountain does not slide
[tool]
radius = 0.05
"""


class WindowOfTry(pointer_fixture.WindowTest):
    session = None  # of all derived classes

    @classmethod
    def setUpClass(cls):
        if WindowOfTry.session is None:
            WindowOfTry.start()

    @staticmethod
    def start():
        base = WindowOfTry
        base.prepare("openbox")
        rules = base.folder / "rc.xml"
        rules.write_text(RC.read_text().replace("</keyboard>", '<keybind key="A-F10"><action name="ToggleFullscreen"/></keybind></keyboard>'))
        (base.folder / "mountain.toml").write_text(SCENE)
        base.desktop = base.display_of(*SCREEN, manager=["openbox", "--config-file", str(rules)])
        base.begin(base.desktop, "try", "--scene", base.folder / "mountain.toml")
        base.window = base.desktop.do("search", "--sync", "--onlyvisible", "--name", "Sandwall").split()[0]
        atexit.register(base.doClassCleanups)

    def place(self):
        """Returns x, y, width and height of the window on the screen, without its frame. Moves the pointer to its corner."""
        # The place of getwindowgeometry counts the frame twice.
        said = self.desktop.do("getwindowgeometry", "--shell", self.window, "mousemove", "--window", self.window, 0, 0, "getmouselocation", "--shell")
        words = dict(line.split("=") for line in said.split())
        return tuple(int(words[key]) for key in ("X", "Y", "WIDTH", "HEIGHT"))

    def comes_to(self, width, height):
        """Waits until the window has this size, and the wall has shown it."""
        self.session.until(lambda: self.place()[2:] == (width, height), f"the window does not become {width} x {height}")
        self.session.frames_pass()

    def resize(self, width, height):
        self.desktop.do("windowsize", self.window, width, height)
        self.comes_to(width, height)

    def shown(self):
        """Returns what the screen shows in the window."""
        x, y, width, height = self.place()
        self.desktop.do("mousemove", 1, 1)  # the server draws the cursor into its screen
        return self.desktop.screen().part(x, y, width, height)

    def edges(self):
        """Returns the edges of answers and help that the screen shows now. The pointer stays where it is."""
        return pointer_fixture.edges(self.desktop.screen())

    def answered(self, name=""):
        self.session.until(self.edges, "no answer")
        if name:
            self.desktop.keep(name)

    def gone(self):
        self.session.until(lambda: not self.edges(), "an answer stays")

    def expect_whole(self):
        """Captures the wall, and expects that the window shows every pixel of it, when hint and answers have gone and sand rests."""
        x, y, width, height = self.place()
        self.desktop.do("mousemove", 1, 1)
        self.gone()
        picture, shown, differing = None, None, "the sand moves"

        def is_whole():
            nonlocal picture, shown, differing
            before = self.session.status()["state_hash"]
            self.session.frames_pass()
            now = self.session.status()
            if now["state_hash"] != before or now["sweeps_owed"]:
                return False
            captured = self.session.ask("capture")
            picture = picture_files.read_png(self.session.out / captured["folder"] / "wall.png")
            self.assertEqual((picture.width, picture.height), (width, height), "the size of a capture")
            shown = self.desktop.screen().part(x, y, width, height)
            differing = [row for row in range(height) if self.beside_cursor(shown, x, y, row) != self.beside_cursor(picture, x, y, row)]
            return not differing

        self.session.until(is_whole, "the window differs from the capture")
        return picture

    @staticmethod
    def beside_cursor(picture, x, y, row):
        """Returns a row of a picture at x, y of the screen, without the pixels that the cursor at the screen's corner may cover."""
        return picture.rows[row][3 * max(0, CURSOR - x):] if y + row < CURSOR else picture.rows[row]

    def on_screen(self, *places):
        """Returns places of the window as places on the screen."""
        x, y = self.place()[:2]
        return [(x + place[0], y + place[1]) for place in places]

    def dig(self, *places):
        """Digs at places in the window, one after the other. Returns where the tool was in the sand [cell]."""
        last = self.session.status()["step"]
        for place in self.on_screen(*places):
            self.session.drag([place])
        begun, engaged = [], False
        for step in self.session.steps(last):
            if step["engaged"] == "1" and not engaged:
                begun.append(tuple(float(number) / WIDTH * CELLS for number in step["path"].split(";")[0].split()[:2]))
            engaged = step["engaged"] == "1"
        self.assertEqual(len(begun), len(places), "strokes in the journal")
        return begun

    def expect_near(self, got, want, cells=2.0):
        self.assertLess(max(abs(a - b) for a, b in zip(got, want)), cells, f"{got} instead of {want}")
