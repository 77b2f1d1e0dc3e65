# SPDX-License-Identifier: Apache-2.0
"""Makes a film of the pictures that a replay has written."""

import pathlib
import shutil
import subprocess

from rank_hosts import BadInput

PATTERN = "frame_%06d.png"  # as the master names them
FRAMES = "frame_[0-9]*.png"


def encode(folder, frames_per_second):
    """Puts FOLDER/film.mp4 beside the pictures where ffmpeg is installed, and says what there is."""
    folder = pathlib.Path(folder)
    frames = sum(1 for _ in folder.glob(FRAMES))
    if shutil.which("ffmpeg") is None:
        print(f"{frames} pictures in {folder}; for a film.mp4 of them: apt-get install ffmpeg, then film it again")
        return
    # H.264 as every player takes it: half the colours, hence even sizes. In the folder itself, because a per cent sign
    # in its path would be taken for a number.
    command = ["ffmpeg", "-y", "-loglevel", "error", "-framerate", str(frames_per_second), "-i", PATTERN,
               "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "18", "-pix_fmt", "yuv420p", "film.mp4"]
    made = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    if made.returncode != 0:
        (folder / "film.mp4").unlink(missing_ok=True)
        said = (made.stderr.strip().split("\n")[-1]) or f"exit status {made.returncode}"
        raise BadInput(f"{folder}/film.mp4: ffmpeg failed: {said}; the {frames} pictures are whole")
    print(f"{folder}/film.mp4: {frames} frames")
