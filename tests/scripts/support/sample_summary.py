# SPDX-License-Identifier: Apache-2.0
"""The summary of a good session with a haptic server, as a master writes it, and ways to change it."""

import copy

REFUSALS = dict.fromkeys(("garbage", "protocol", "algorithm", "scene", "busy", "state", "secret", "role", "tls", "limit"), 0)
GUARDS = dict.fromkeys(("not_a_number", "stiffness", "damping", "friction", "slew", "passivity", "clamp", "ramp", "stale", "missed", "lost",
                        "jumped", "frozen", "contact", "gate", "unread", "edit", "tripped"), 0)
SPREAD = {"p50": 1.0, "p99": 2.0, "max": 3.0}
DISTRIBUTION = {"mean": 30.0, "stddev": 2.0, "p50": 29.5, "p99": 44.0}
OUTCOMES = dict.fromkeys(("half", "off", "share", "clutch", "pause", "start", "slow_motion", "disk", "growth", "damped", "steps", "not_a_number",
                          "stale", "missed", "lost", "jumped", "tripped"), 0)
TRIP = {**DISTRIBUTION, "count": 0}


def rank(number):
    return {"rank": number, "tile": f"r1c{number}", "host": "node01", "renderer": "llvmpipe", "swap_lock": "none", "draw_ms": SPREAD,
            "barrier_wait_ms": {"p50": 1.0, "p99": 2.0}, "slowest": {"frames": 10, "share": 0.0167, "wall_waited_ms": SPREAD},
            "swap_us": SPREAD, "frames_agreed": 600, "frames_differed": 0, "healed": 0,
            "views": {"skipped": 10, "in_part": 500, "whole": 90, "pixel_share": 0.2}, "memory_bytes": 1 << 26,
            "frame_buffer_bytes": 1 << 22}


# 600 frames at 60 frames/s: 599 periods take 9.983 s.
SUMMARY = {
    "version": 1, "scene": "dunes", "terrain": [], "wall": "small", "frames": 600, "steps": 590, "frames_before": 0, "steps_before": 0, "pace": "realtime",
    "refresh_hz": 60.0, "ranks": 2, "state_hash": "0123456789abcdef", "sweeps_owed": 0, "refused_press": None, "divergences": 0, "healed": 0, "outvoted": 0, "master_healed": 0,
    "server_divergences": 0, "unhealed": 0, "steps_left_out": 0, "steps_unplaced": 0, "volume_initial": 900, "volume_final": 890, "edits": 0, "volume_outflow": 10,
    "compared": {"at_end": True, "server_at_end": True, "last_whole": 600, "frames_since": 0, "first_difference": None},
    "seconds": 9.99, "fps": 59.96, "frame_ms": {**SPREAD, "count": 590, "mean": 16.7}, "late_frames": 3,
    "held_seconds": {"pause": 0.0, "disk": 0.0, "rest": 0.0}, "skew_us": {"p50": 200.0, "p99": 900.0, "max": 2000.0},
    "latency_ms": DISTRIBUTION, "latency_legs_ms": {leg: DISTRIBUTION for leg in ("to_master", "queued", "drawn", "swapped")},
    "haptic_period_us": {"p50": 1000.0, "p99": 1010.0, "max": 1100.0}, "slowest": None, "broadcast_bytes": SPREAD,
    "hand": {"asked": "server", "links": 1, "frames_with_hand": 598, "linked_at_end": True, "slow_motion": 1.02, "last_refusal": None},
    "haptic": {"reconnects": 0, "hand_overs": {"by_steps": 0, "by_state": 0}, "refused_by_server": REFUSALS,
               "refused": {"servers": REFUSALS, "connections": REFUSALS}, "force_us": {"p50": 2.0, "p99": 3.0}, "half_round_trip_ms": TRIP,
               "half_round_trip_to_master_ms": TRIP, "step_message_bytes": 140.0, "steps_withheld": 0,
               "steps_withheld_by": {"wall": 0, "disk": 0, "pause": 0, "start": 0}, "samples_dropped": 0, "ticks": 10400, "ticks_missed": 0,
               "literal": False, "device_losses": 0, "device_away": False, "arm": True, "hand_ticks": 10000, "felt_ticks": 4000, "faulted_ticks": 0, "hand_seconds": 10, "faulted_seconds": 0,
               "asked_ticks": {**OUTCOMES, "half": 3600, "start": 400}, "guarded_ticks": {**GUARDS, "ramp": 500}},
    "master_memory_bytes": 1 << 26,
    "journal": {"policy": "required", "state": "written", "whole": True, "parts": 1, "checkpoints": 1, "checkpoints_failed": 0,
                "checkpoints_beyond": 0, "checkpoint_copy_ms": SPREAD, "full_disk": {"times": 0, "seconds": 0.0}},
    "dark": [], "recoveries": [], "per_rank": [rank(1), rank(2)]}
HEAD = {"packets": 1000, "refused": 0, "old": 0, "absent": 0, "lost": 0, "outside": 0, "strangers": 0}
DARK = {"output": "r1c2", "tile": "r1c2", "rank": 2, "monitor": "DP-2", "times": 1, "seconds": 12.4, "at_end": False}
RECOVERY = {"failure": "rank 2 on node01 was killed by SIGKILL", "failed_rank": 2, "failed_how": "SIGKILL", "seconds_to_next_frame": 2.5,
            "step": 300, "frame": 310, "state_hash": "0123456789abcdef", "checkpoint_step": 240, "replayed_steps": 60, "cut_bytes": 0}


def changed(**fields):
    """Returns SUMMARY with other values. Two underscores lead into an object: journal__policy="off"."""
    summary = copy.deepcopy(SUMMARY)
    for path, value in fields.items():
        *outer, last = path.split("__")
        part = summary
        for key in outer:
            part = part[key]
        part[last] = value
    return summary


def outcomes(**counts):
    """Returns `asked_ticks` with these counts. The others are 0."""
    return {**OUTCOMES, **counts}


def without_hand(**fields):
    """Returns the summary of a session without a haptic server, with other values."""
    summary = changed(hand={"asked": "none", "links": 0, "frames_with_hand": 0, "linked_at_end": False, "slow_motion": None, "last_refusal": None},
                      latency_ms={"mean": 0.0, "stddev": 0.0, "p50": 0.0, "p99": 0.0}, compared__server_at_end=None,
                      haptic={key: SUMMARY["haptic"][key] for key in ("reconnects", "hand_overs", "refused_by_server", "refused")},
                      haptic_period_us={"p50": None, "p99": None, "max": None})
    summary.update(fields)
    return summary


def film(**fields):
    """Returns the summary of a film, with other values."""
    return without_hand(**{"pace": "replay", "journal": {**SUMMARY["journal"], "policy": "off", "state": "off", "whole": False, "checkpoints": 0},
                           **fields})


SERVER_DIED = {"what": "the haptic server was killed by SIGKILL", "restarted": False, "server": True, "now": True}
# Summaries that give each line of the report.
SAMPLES = (SUMMARY, without_hand(), film(), changed(per_rank=[{**rank(1), "views": {"skipped": 0, "in_part": 0, "whole": 0, "pixel_share": 0.0}}]),
           changed(head_tracking={**HEAD, "lost": 2}, slowest={"rank": 2, "name": "rank 2", "share": 0.9, "wall_waited_ms": 20.0}),
           changed(recoveries=[RECOVERY, {**RECOVERY, "seconds_to_next_frame": None, "seconds_to_link": 1.5}], held_seconds__pause=2.0, edits=2),
           changed(divergences=3, healed=1, unhealed=2, master_healed=1, outvoted=1, compared__at_end=False, compared__first_difference=9),
           changed(hand={**SUMMARY["hand"], "links": 0, "frames_with_hand": 0, "linked_at_end": False, "slow_motion": None, "last_refusal": "no answer"},
                   compared__server_at_end=None),
           changed(haptic__felt_ticks=0, haptic__faulted_ticks=10000, haptic__guarded_ticks__lost=10000),
           changed(hand__frames_with_hand=0, hand__linked_at_end=False, haptic__refused_by_server={**REFUSALS, "secret": 2}),
           changed(steps_unplaced=3, refused_press={"tool_shape": "sphere", "tool_radius": 0.6, "largest_radius": 0.5}),
           changed(hand={**SUMMARY["hand"], "asked": "pointer"}), changed(dark=[DARK]),
           changed(journal__state="no_room", journal__whole=False, journal__full_disk={"times": 1, "seconds": 2.0}))
