# SPDX-License-Identifier: Apache-2.0
"""Makes a film from the pictures that a replay has written."""

import pathlib
import shutil
import subprocess

from base import console, layout, marked_answer
from base.bad_input import BadInput

PATTERN = "frame_%06d.png"  # the names that the master gives to the pictures
FRAMES = "frame_[0-9]*.png"
INSTALL = "apt-get install ffmpeg" if layout.INSTALLED else "scripts/install_dependencies.sh --with-film"


def encode(folder, frames_per_second):
    """Writes FOLDER/film.mp4 from the pictures in FOLDER if ffmpeg is installed, and prints what FOLDER holds.

    Raises BadInput if ffmpeg fails; the pictures then stay unchanged.
    """
    folder = pathlib.Path(folder)
    frames = sum(1 for _ in folder.glob(FRAMES))
    if shutil.which("ffmpeg") is None:
        console.OUT.line(f"{frames} pictures in {folder}; for film.mp4 ffmpeg is missing: run {INSTALL}, then this command again")
        return
    film = folder / "film.mp4"
    if film.is_symlink() or (film.exists() and not film.is_file()):
        raise BadInput(f"{film}: is not a regular file; remove it; the {frames} pictures are whole")
    film.unlink(missing_ok=True)  # ffmpeg would keep the previous file's access, with which others could write to it
    # Every player reads H.264 with colours at half the resolution, which needs even sizes. ffmpeg runs in the folder,
    # because a per cent sign in its path would be read as a number.
    command = ["ffmpeg", "-y", "-loglevel", "error", "-framerate", str(frames_per_second), "-i", PATTERN,
               "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "film.mp4"]
    made = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    if made.returncode != 0:
        film.unlink(missing_ok=True)
        said = marked_answer.last_line(made.stderr) or f"exit status {made.returncode}"
        raise BadInput(f"{folder}/film.mp4: ffmpeg failed: {said}; the {frames} pictures are whole")
    console.OUT.line(f"{folder}/film.mp4: {frames} frames")
