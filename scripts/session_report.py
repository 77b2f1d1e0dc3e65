# SPDX-License-Identifier: Apache-2.0
"""The report at the end of `sandwall run`: the main figures of summary.json, with marks at those that are not good (docs/summary.md)."""

import json
import os
import pathlib
import shlex
import sys

import checked_json
import console
import layout
import session_results
from rank_hosts import BadInput

VERSION = 1  # of the JSON that --json prints, as in docs/schemas/report.schema.json
MOST_LATE_SHARE = 0.01  # of the frames; more is noted
GOOD, NOTE, BAD = "ok", "note", "BAD"
COLOURS = {GOOD: 32, NOTE: 33, BAD: 31}


def counted(number, one, many=None):
    return f"{number} {one if number == 1 else many or one + 's'}"


def refusals(haptic):
    """Returns how often master or haptic server refused a connection."""
    kinds = (haptic["refused_by_server"], haptic["refused"]["servers"], haptic["refused"]["guests"])
    return sum(sum(kind.values()) for kind in kinds)


def frames_line(summary):
    shown = summary["frame_ms"]["count"]
    late = summary["late_frames"]
    share = late / shown if shown else 0
    words = f"{late} of {shown} measured, {100 * share:.1f} %"
    return (NOTE if share > MOST_LATE_SHARE else GOOD, "late", words)


def latency_line(summary):
    latency = summary["latency_ms"]
    if not latency["mean"]:
        return (GOOD, "latency", "no hand moved the sand")
    return (GOOD, "latency", f"{latency['p50']:.1f} ms from hand to picture (median), {latency['p99']:.1f} ms (99 %)")


def hand_lines(haptic):
    """Yields lines about a hand with gaps or without a link. A session without troubles has none."""
    gaps = [f"{counted(haptic[key], what)} {how}" for key, what, how in
            (("steps_withheld", "step", "not made"), ("samples_dropped", "sample", "left out")) if haptic.get(key)]
    if gaps:
        yield (NOTE, "hand", f"{', '.join(gaps)}, because the wall was behind; strokes may have gaps")
    if refused := refusals(haptic):
        yield (NOTE, "refused", counted(refused, "connection") + " of the haptic link; docs/security.md")


def sand_line(summary):
    differed = summary["divergences"] + summary["server_divergences"]
    healed = summary["healed"] + summary["master_healed"]
    if differed == 0:
        return (GOOD, "sand", f"equal on all ranks in every frame, hash {summary['state_hash']}")
    return (NOTE if healed else BAD, "sand", f"differed in {counted(differed, 'frame')}, healed {counted(healed, 'time')}, "
            f"hash {summary['state_hash']}; docs/healing.md")


def volume_line(summary):
    left = summary["volume_final"] + summary["volume_outflow"] - summary["volume_initial"]
    return (GOOD, "volume", "exact") if left == 0 else (BAD, "volume", f"{left:+d} units since the start")


def journal_line(journal):
    words = f"{journal['state'].replace('_', ' ')} ({journal['policy']})"
    return (GOOD if journal["state"] in ("written", "off") else BAD, "journal", words)


def lines_of(summary, out):
    """Returns (mark, name, words) of each line of the report."""
    found = [(GOOD, "wall", f"{summary['wall']}, {counted(summary['ranks'], 'render rank')}"),
             (GOOD, "frames", f"{summary['frames']} with {counted(summary['steps'], 'step')}, {summary['fps']:.1f} frames/s for {summary['seconds']:.1f} s"),
             frames_line(summary), latency_line(summary), *hand_lines(summary["haptic"]), sand_line(summary), volume_line(summary)]
    if slowest := summary["slowest"]:
        found.append((NOTE, "slowest", f"{slowest['name']}, last in {100 * slowest['share']:.0f} % of frames"))
    recoveries = len(summary["recoveries"])
    found.append((NOTE if recoveries else GOOD, "recoveries", str(recoveries) + ("; docs/recovery.md" if recoveries else "")))
    found.append(journal_line(summary["journal"]))
    return found


def replay_command(summary, out):
    """Returns the words of the command that replays the session, or None if it wrote no journal."""
    return None if summary["journal"]["state"] == "off" else [launcher(), "replay", str(out), "--hash"]


def launcher():
    """Returns how the user calls this launcher."""
    return "sandwall" if layout.INSTALLED else os.path.relpath(layout.HERE / "sandwall")


def text_of(summary, out, status, colours):
    """Returns the report as text."""
    lines = lines_of(summary, out)
    notes = sum(mark == NOTE for mark, _, _ in lines)
    verdict = f"NOT GOOD, exit status {status}" if not is_good(lines, status) else f"good, {counted(notes, 'note')}" if notes else "good"
    text = [f"{checked_json.one_line(summary['scene'])}: {verdict}"]
    for mark, name, words in lines:
        shown = f"\033[{COLOURS[mark]}m{mark:<4}\033[0m" if colours else f"{mark:<4}"
        text.append(f"  {shown}  {name:<10}  {checked_json.one_line(words)}")
    text.append(f"        {'folder':<10}  {out}")
    if command := replay_command(summary, out):
        text.append(f"        {'replay':<10}  {shlex.join(command)}")
    return "\n".join(text)


def is_good(lines, status):
    return status == 0 and all(mark != BAD for mark, _, _ in lines)


def json_of(summary, out, status):
    """Returns the report for programs. `summary` is None if the session did not end in order."""
    report = {"version": VERSION, "status": status, "good": False, "out": str(out), "notes": [], "session": None}
    if summary is None:
        return report
    lines = lines_of(summary, out)
    report["good"] = is_good(lines, status)
    report["notes"] = [{"mark": mark, "name": name, "message": words} for mark, name, words in lines if mark != GOOD]
    hand = summary["latency_ms"] if summary["latency_ms"]["mean"] else None
    report["session"] = {
        **{key: summary[key] for key in ("scene", "wall", "ranks", "frames", "steps", "seconds", "fps", "late_frames", "state_hash")},
        "measured_frames": summary["frame_ms"]["count"],
        "latency_ms": hand and {key: hand[key] for key in ("p50", "p99")},
        "differing_frames": summary["divergences"] + summary["server_divergences"],
        "healed": summary["healed"] + summary["master_healed"],
        "recoveries": len(summary["recoveries"]),
        "volume_exact": volume_line(summary)[0] == GOOD,
        "journal": summary["journal"]["state"],
        "replay": replay_command(summary, out)}
    return report


class Report:
    """Prints the report at the end of a session, if the session has written summary.json.

    With `as_json`, standard output gets one JSON object, and all that would go there meanwhile goes to standard error.
    """

    def __init__(self, out, as_json):
        self.out, self.as_json = pathlib.Path(out), as_json
        self.before = self.identity()
        self.output = None

    def __enter__(self):
        if self.as_json and console.OUT.descriptor is not None:
            self.output = os.dup(1)
            os.dup2(2, 1)
        return self

    def __exit__(self, *_):
        if self.output is not None:
            os.dup2(self.output, 1)
            os.close(self.output)
            self.output = None

    def identity(self):
        try:
            stat = (self.out / "summary.json").stat()
            return stat.st_ino, stat.st_mtime_ns
        except OSError:
            return None

    def after(self, status):
        """Prints the report of a session that has ended with this exit status. Returns the status."""
        self.__exit__()
        if self.identity() not in (None, self.before):
            try:
                summary = session_results.summary_of(self.out)
                text = text_of(summary, self.out, status, sys.stdout.isatty() and "NO_COLOR" not in os.environ)
                report = json.dumps(json_of(summary, self.out, status), indent=1)
                console.OUT.line(report if self.as_json else text)
                return status
            except BadInput as complaint:
                console.say(complaint)
            except (LookupError, TypeError, AttributeError, ValueError, ArithmeticError):
                console.say(f"{self.out}/summary.json: is not as docs/schemas/summary.schema.json says")
        if self.as_json:
            console.OUT.line(json.dumps(json_of(None, self.out, status), indent=1))
        return status
