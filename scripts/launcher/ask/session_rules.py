#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The lines of the report at the end of a session: what each reads, its rule for each mark, and what to do next.

Prints the table of docs/summary.md. A test compares the table on that page with this list, and the fields with
docs/schemas/summary.schema.json. The limits are in scripts/launcher/ask/session_lines.py.
"""

import dataclasses
import pathlib
import sys
import typing

sys.dont_write_bytecode = True
if __name__ == "__main__":
    sys.path[0] = str(pathlib.Path(__file__).resolve().parents[1])
from ask import session_lines as lines
from base import checked_json


@dataclasses.dataclass(frozen=True)
class Rule:
    """A line of the report. `fields` are paths in summary.json; a path stands for all below it, and [] for each item."""

    name: str
    measures: str
    good: str
    note: str
    bad: str
    page: str  # what to do next, a page of docs/
    fields: tuple
    find: typing.Callable  # a function of session_lines

    def line(self, summary, failures):
        """Returns (mark, name, words), or None if the line is left out."""
        found = self.find(summary, failures)
        if found is None:
            return None
        mark, words = found
        advice = f"; docs/{self.page}" if mark in (*lines.NOTES, lines.BAD) else ""
        return mark, self.name, checked_json.one_line(words) + advice


def percent(share):
    return f"{100 * share:g} %"


RULES = (
    Rule("wall", "name of the wall, and its render ranks", "each rank has reported at the end", "", "", "cluster.md",
         ("wall", "ranks", "per_rank"), lines.wall),
    Rule("views", "render ranks that drew no view of the sand; left out if each has drawn one", "", "any, as while a test pattern is shown", "",
         "cluster.md", ("per_rank[].rank", "per_rank[].tile", "per_rank[].host", "per_rank[].views.in_part", "per_rank[].views.whole",
                        "frames", "frames_before"), lines.views),
    Rule("frames", "frames, rate, and time lost: seconds without frames × period of the refresh that was asked for",
         f"at most {percent(lines.MOST_TIME_LOST)} of the time lost", "more time lost", "", "latency.md",
         ("frames", "frames_before", "seconds", "fps", "refresh_hz", "pace", "late_frames", "frame_ms.count", "frame_ms.max"), lines.frames),
    Rule("latency", "time from the hand to the picture, at any pace",
         f"median up to {lines.MOST_LATENCY_PERIODS} periods and {lines.MOST_LATENCY_MORE_MS} ms, "
         f"and 99 % up to {lines.MOST_LATENCY_P99_MS / 1000:g} s",
         "more", "", "latency.md", ("latency_ms.mean", "latency_ms.p50", "latency_ms.p99", "refresh_hz", "hand.asked", "haptic.hand_ticks", "haptic.faulted_ticks",
          "haptic.guarded_ticks.lost"), lines.latency),
    Rule("hand", "the hand that was asked for, its links, and the frames in which it was there",
         f"linked in all but {percent(lines.MOST_FRAMES_WITHOUT_HAND)} of the frames and at the end, by the first link",
         "a link made again, a device that stopped answering, not linked at the end, or more frames without a hand",
         f"never linked; not linked in a last start of {lines.LONGEST_WAIT_FOR_HAND} s or more; a server of the launcher ended for good",
         "devices.md", ("hand.asked", "hand.links", "hand.frames_with_hand", "hand.linked_at_end", "hand.last_refusal", "frames", "frames_before", "haptic.reconnects",
                       "haptic.device_losses", "haptic.device_away", "seconds"), lines.hand),
    Rule("force", "ticks in which the law asks for force, those in which the hand had at least half of it, and the causes of the others; faults, and guards that acted",
         f"half in at least {percent(lines.LEAST_FORCE)} of the ticks that neither a person nor the start explains; a fault in at most {percent(lines.MOST_TICKS_FAULTED)} of all ticks",
         "half in fewer ticks, more faults, a place or force that is not a number, or `--guards literal`",
         f"half in less than {percent(lines.BAD_FORCE)} of the ticks that have half or lack it because of the arm or the link, if more than {lines.MOST_TICKS_RAMPED} lack it; "
         f"a fault of an arm in more than {percent(lines.BAD_SECONDS_FAULTED)} of the seconds, and in at least {lines.LEAST_SECONDS_FAULTED}; "
         f"a fault in more than {percent(lines.BAD_TICKS_FAULTED)} of the ticks, without those in which a device that is no arm is away; or a device that answered in no tick",
         "forces.md", ("hand.asked", "haptic.hand_ticks", "haptic.faulted_ticks", "haptic.hand_seconds", "haptic.faulted_seconds", "haptic.asked_ticks",
                       "haptic.guarded_ticks", "haptic.literal", "haptic.arm"), lines.force),
    Rule("strokes", "steps that the haptic server did not make, and samples of the hand that are in no step", "none because of wall or disk",
         "steps withheld because of the wall or the disk, or samples left out. Steps withheld at the start or in a pause have no mark", "",
         "latency.md", ("hand.asked", "haptic.steps_withheld", "haptic.steps_withheld_by", "haptic.samples_dropped"), lines.strokes),
    Rule("motion", "time while the tool is in the sand, divided by the time of the hand that is in steps; sweeps that the tool waits for at the end. "
         "Not measured with `--pace fast`, whose hand waits", f"up to {lines.MOST_SLOW_MOTION}", f"more; `slow` above {lines.LAGGING_SLOW_MOTION}", "", "how_it_works.md",
         ("hand.asked", "hand.slow_motion", "sweeps_owed", "pace"), lines.motion),
    Rule("refusals", "connections of the haptic link that either side refused", "none", "any", "", "security.md",
         ("hand.asked", "haptic.refused_by_server", "haptic.refused"), lines.refusals),
    Rule("steps", "steps of the sand, edits of an operator, pauses and rests", "none left out", "steps that all ranks left out", "", "journal.md",
         ("steps", "steps_before", "edits", "steps_left_out", "held_seconds.pause", "held_seconds.rest"), lines.steps),
    Rule("press", "steps whose sand no cell could take, so that the tool passed through it, and the largest radius with which the first "
         "of these presses fits; only if there was such a step", "", "any", "", "limits.md", ("steps_unplaced", "refused_press"), lines.press),
    Rule("sand", "whether all replicas had the same sand, and until which frame that was compared", "no difference, and all compared in the last frame",
         "a difference that was healed, or a majority that the journal outvoted", "a difference that was not healed, in a rank or in the haptic server",
         "healing.md", ("divergences", "server_divergences", "healed", "master_healed", "outvoted", "unhealed", "compared", "state_hash",
                        "hand.asked", "hand.links", "recoveries", "frames_before"), lines.sand),
    Rule("volume", "volume and outflow at the end, less the volume at the start", "exact", "", "not exact", "healing.md",
         ("volume_initial", "volume_final", "volume_outflow"), lines.volume),
    Rule("recoveries", "restarts after a failure or with `--resume`, the time that the wall stood still, and failed processes that the launcher did not start again",
         "none", "any", "", "recovery.md", ("recoveries[].failed_how", "recoveries[].seconds_to_next_frame", "recoveries[].seconds_to_link"), lines.recoveries),
    Rule("journal", "whether every step that was shown is in the journal, and the journal has its end", "whole",
         "not whole, with `--journal best-effort`", "not whole, with `--journal required`", "journal.md",
         ("pace", "journal.policy", "journal.state", "journal.whole"), lines.journal),
    Rule("disk", "time that the sand waited for room on the disk", "none", "any", "", "journal.md",
         ("journal.policy", "journal.full_disk", "held_seconds.disk"), lines.disk),
    Rule("checkpoints", "checkpoints of the journal", "all written", "some not written, or after the end of a journal that lost steps", "",
         "journal.md", ("pace", "journal.policy", "journal.checkpoints", "journal.checkpoints_failed", "journal.checkpoints_beyond"),
         lines.checkpoints),
    Rule("head", "packets of the head tracker", "poses never stopped", "poses stopped, or packets were refused", "", "head_tracking.md",
         ("head_tracking",), lines.head),
    Rule("skew", "time from the first swap of a frame to its last, on a wall of several ranks", "99 % up to a period", "more", "",
         "cluster.md", ("ranks", "frames", "frames_before", "pace", "refresh_hz", "skew_us.p99"), lines.skew),
    Rule("monitors", "outputs whose monitor was off or had another size, and for how long; only if there was such an output", "", "any", "",
         "backends.md", ("dark[].output", "dark[].tile", "dark[].monitor", "dark[].times", "dark[].seconds", "dark[].at_end"), lines.monitors),
    Rule("slowest", "the rank for which the wall waited; left out if none stands out", "", "a rank stands out", "",
         "summary.md", ("slowest.name", "slowest.share"), lines.slowest),
)

# Fields of summary.json that no line reads, each with the reason. A path stands for all below it.
UNREAD = {
    "version": "the reader of the file compares it",
    "scene": "the first line of the report has it",
    "terrain[]": "the session prints it when it reads the scene",
    "frame_ms.p50": "the line frames has the mean rate and the time lost",
    "frame_ms.p99": "the line frames has the time lost, which counts each slow frame",
    "frame_ms.mean": "the line frames has the mean rate",
    "skew_us.p50": "the line skew judges the slow frames",
    "skew_us.max": "the line skew ignores a single late swap",
    "latency_ms.stddev": "the line latency has two percentiles",
    "latency_legs_ms": "says where latency comes from, which is a question after the line latency",
    "haptic_period_us": "a tick that comes too late counts as the fault missed in the line force",
    "slowest.rank": "the line slowest has the rank's name",
    "slowest.wall_waited_ms": "the line frames has the time lost",
    "broadcast_bytes": "a size of the network's messages, which has no good or bad",
    "haptic.hand_overs": "a server that was linked again catches up; the line hand has the links made again",
    "haptic.force_us": "a force that takes too long counts as the fault missed in the line force",
    "haptic.half_round_trip_ms": "tests of docs/latency.md, which only its scripts ask for",
    "haptic.half_round_trip_to_master_ms": "tests of docs/latency.md, which only its scripts ask for",
    "haptic.step_message_bytes": "a size of the network's messages, which has no good or bad",
    "haptic.ticks": "the line force counts the ticks with a hand",
    "haptic.ticks_missed": "a tick that comes too late counts as the fault missed in the line force",
    "haptic.felt_ticks": "the line force compares the force with what the law asks for",
    **dict.fromkeys([f"per_rank[].{field}" for field in
                     ("renderer", "swap_lock", "draw_ms", "barrier_wait_ms", "slowest", "swap_us", "frames_agreed", "frames_differed", "healed",
                      "views.skipped", "views.pixel_share", "memory_bytes", "frame_buffer_bytes")],
                    "a figure of one rank, which helps to find the cause of a note (docs/summary.md)"),
    "dark[].rank": "the line monitors has the output and its tile",
    "master_memory_bytes": "a figure for long tests, which has no good or bad in one session",
    "journal.parts": "the line journal says whether the parts are whole",
    "journal.checkpoint_copy_ms": "the line frames has the time lost",
    "recoveries[].failure": "the launcher has printed it, and failures.jsonl has it",
    "recoveries[].failed_rank": "the launcher has printed it, and failures.jsonl has it",
    "recoveries[].step": "the place of one recovery; the line recoveries adds them up",
    "recoveries[].frame": "the place of one recovery; the line recoveries adds them up",
    "recoveries[].state_hash": "the master has compared it when it continued",
    "recoveries[].checkpoint_step": "how one recovery was done; the line recoveries has its time",
    "recoveries[].replayed_steps": "how one recovery was done; the line recoveries has its time",
    "recoveries[].cut_bytes": "bytes of steps that were never shown",
}


def lines_of(summary, failures=()):
    """Returns (mark, name, words) of each line of the report, in order."""
    return [line for rule in RULES if (line := rule.line(summary, failures)) is not None]


def table():
    """Returns the table of docs/summary.md."""
    rows = [f"| `{rule.name}` | {rule.measures} | {rule.good} | {rule.note} | {rule.bad} | [{rule.page}]({rule.page}) |" for rule in RULES]
    return "\n".join(["| line | measures | `ok` | `note` | `BAD` | what to do |", "|---|---|---|---|---|---|", *rows])


if __name__ == "__main__":
    print(table())
