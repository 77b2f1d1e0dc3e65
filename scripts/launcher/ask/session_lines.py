# SPDX-License-Identifier: Apache-2.0
"""Finds what the report says about a session: one function for each line.

scripts/launcher/ask/session_rules.py lists the lines. A function gets the summary (docs/summary.md) and the failed processes
that the launcher has seen (scripts/launcher/watch/failed_processes.py). It returns a mark and words, or None if the line is left
out.
"""

GOOD, NOTE, LAGGING, BAD, UNMEASURED = "ok", "note", "slow", "BAD", "--"
NOTES = NOTE, LAGGING  # LAGGING: the session is not called good, but has exit status 0
SESSION, START, SERVER_START = "in the session", "since the last start", "since the last start of the haptic server"

# All limits of the report. A figure above its limit is marked.
MOST_TIME_LOST = 0.01  # of the time since the last start [1]
MOST_LATENCY_PERIODS, MOST_LATENCY_MORE_MS = 2, 50  # of the median: periods of the wall, and what the hand may take more [ms]
MOST_LATENCY_P99_MS = 500  # of the 99th percentile [ms]
MOST_FRAMES_WITHOUT_HAND = 0.1  # of the frames since the last start [1]
LONGEST_WAIT_FOR_HAND = 5  # after a restart, the time without a hand from which it counts as one that never came [s]
MOST_TICKS_FAULTED, BAD_TICKS_FAULTED = 0.01, 0.5  # of the ticks with a hand [1]
LEAST_FORCE, BAD_FORCE = 0.5, 0.1  # of the ticks that ask for force, those in which the hand has at least half of it [1]
MOST_TICKS_RAMPED = 2000  # [ticks] without force that two faults explain: each is followed by 1000 below half, in its ramp of 2 s
BAD_SECONDS_FAULTED, LEAST_SECONDS_FAULTED = 0.1, 3  # of the seconds with a hand [1], and at least so many [s]
MOST_SLOW_MOTION = 1.1  # time of the hand that has passed, divided by that which is in steps [1]
LAGGING_SLOW_MOTION = 4  # the same, from which the session is called slow [1]
MOST_SKEW_PERIODS = 1  # of the 99th percentile [period of the wall]

# Causes for which the hand has less than half of the force (docs/forces.md), in the words of the line force. Nobody is to
# blame for CHOSEN; the arm, the link or this machine for FAULTY.
CHOSEN = {"off": "force is off", "share": "a share of the force", "clutch": "the clutch", "pause": "a pause",
          "start": "the start of a link"}
SLOW = {"slow_motion": "slow motion", "disk": "a full disk", "growth": "force that grows", "damped": "damping"}
FAULTY = {"steps": "no steps", "not_a_number": "fault not_a_number", "stale": "fault stale", "missed": "fault missed",
          "lost": "fault lost", "jumped": "fault jumped", "tripped": "force that three faults in ten seconds have switched off"}


def counted(number, one, many=None):
    return f"{number} {one if number == 1 else many or one + 's'}"


def percent(share):
    """Returns a share as text that rounds no small share to 0."""
    return f"{100 * share:.1f} %" if share == 0 or share >= 0.0005 else "below 0.1 %"


def shown_frames(summary):
    """Returns the number of frames since the last start."""
    return summary["frames"] - summary["frames_before"]


def named_counts(counts):
    """Returns the counts by name that are not 0, as in "secret 2, busy 1"."""
    return ", ".join(f"{name} {count}" for name, count in counts.items() if count)


def wall(summary, _):
    told = len(summary["per_rank"])
    words = f"{summary['wall']}, {counted(summary['ranks'], 'render rank')}"
    return (GOOD, words) if told == summary["ranks"] else (UNMEASURED, f"{words}; not measured: {told} reported at the end")


def views(summary, _):
    blank = [rank for rank in summary["per_rank"] if not rank["views"]["in_part"] + rank["views"]["whole"]]
    if not blank or shown_frames(summary) < 1:
        return None
    named = ", ".join(f"rank {rank['rank']} (tile {rank['tile']}) on {rank['host']}" for rank in blank)
    return NOTE, f"no view was drawn in {counted(shown_frames(summary), 'frame')} {START} by {named}"


def frames(summary, _):
    words = f"{summary['frames']} {SESSION}"
    intervals, seconds = shown_frames(summary) - 1, summary["seconds"]
    if summary["pace"] == "replay":
        return UNMEASURED, f"{words}; rate not measured: a film keeps none"
    if intervals < 1 or seconds <= 0:
        return UNMEASURED, f"{words}; rate not measured: one frame has none"
    lost = max(0, seconds - intervals / summary["refresh_hz"])
    words += (f"; {summary['fps']:.1f} of {summary['refresh_hz']:g} frames/s for {seconds:.1f} s {START}, "
              f"{percent(lost / seconds)} of the time lost")
    if measured := summary["frame_ms"]["count"]:
        late = f", {summary['late_frames']} of {measured} measured frames late" if summary["pace"] == "realtime" else ""
        words += f"{late}, longest {summary['frame_ms']['max']:.0f} ms"
    return NOTE if lost > MOST_TIME_LOST * seconds else GOOD, words


def never_answered(haptic):
    """Returns whether the device of the haptic server was lost in every tick with a hand."""
    ticks = haptic.get("hand_ticks", 0)
    return ticks > 0 and haptic["faulted_ticks"] >= ticks and haptic["guarded_ticks"].get("lost", 0) >= ticks


def latency(summary, _):
    if summary["hand"]["asked"] == "none":
        return None
    found = summary["latency_ms"]
    if not found["mean"]:
        return UNMEASURED, f"not measured: no hand moved the sand {START}"
    if summary["hand"]["asked"] == "server" and never_answered(summary["haptic"]):
        return UNMEASURED, f"not measured: the device answered in no tick {SERVER_START}"
    slow = found["p50"] > MOST_LATENCY_PERIODS * 1000 / summary["refresh_hz"] + MOST_LATENCY_MORE_MS or found["p99"] > MOST_LATENCY_P99_MS
    return NOTE if slow else GOOD, f"{found['p50']:.1f} ms from hand to picture (median), {found['p99']:.1f} ms (99 %) {START}"


def hand(summary, failures):
    told = summary["hand"]
    shown = shown_frames(summary)
    where = f"in {told['frames_with_hand']} of {counted(shown, 'frame')} {START}"
    if told["asked"] == "none":
        return None
    if told["asked"] == "pointer":
        return (GOOD, f"the pointer, {where}") if told["frames_with_hand"] else (UNMEASURED, f"not measured: the pointer was not used {START}")
    if told["links"] == 0:
        return BAD, f"the haptic server that was asked for was never linked {SESSION}: {told['last_refusal'] or 'no answer'}"
    words = f"linked {counted(told['links'], 'time')} {SESSION}, {where}"
    if again := summary["haptic"]["reconnects"]:
        words = f"links made again: {again} {SESSION}; {words}"
    lost, away = (summary["haptic"].get(key, 0) for key in ("device_losses", "device_away"))
    if lost:
        at_end = ", and did not answer at the end" if away else ""
        words = f"the device stopped answering {counted(lost, 'time')} {SERVER_START}{at_end}; {words}"
    if died := [failure for failure in failures if failure["server"] and failure["now"] and not failure["restarted"]]:
        return BAD, f"{died[-1]['what']} and was not started again; {words}"
    if told["frames_with_hand"] == 0 and summary["seconds"] >= LONGEST_WAIT_FOR_HAND:
        return BAD, f"never linked {START}: {told['last_refusal'] or 'no answer'}; {words}"
    if not told["linked_at_end"]:
        return NOTE, f"not linked at the end; {words}"
    return NOTE if again or lost or shown - told["frames_with_hand"] > MOST_FRAMES_WITHOUT_HAND * shown else GOOD, words


def force(summary, _):
    if summary["hand"]["asked"] != "server":
        return None
    haptic = summary["haptic"]
    if not haptic.get("hand_ticks"):
        return UNMEASURED, f"not measured: {'no tick had a hand' if 'hand_ticks' in haptic else 'no report of a haptic server'} {START}"
    ticks, faulted, guards = haptic["hand_ticks"], haptic["faulted_ticks"], haptic["guarded_ticks"]
    outcomes, seconds, faulty = dict(haptic["asked_ticks"].items()), haptic["hand_seconds"], haptic["faulted_seconds"]
    asked, had = sum(outcomes.values()), outcomes["half"]
    not_chosen = asked - sum(outcomes[cause] for cause in CHOSEN)
    # Force that three faults have switched off does not count as another fault. A recording has no hand that lacks it.
    off = guards.get("tripped", 0)
    by_fault = sum(outcomes[cause] for cause in FAULTY if haptic["arm"] or cause != "tripped")
    words = f"at least half of it in {had} of {counted(asked, 'tick')} that ask for force, of {counted(ticks, 'tick')} {SERVER_START}"
    if less := named_counts({what: outcomes[cause] for cause, what in (CHOSEN | SLOW | FAULTY).items()}):
        words += f"; less because of: {less}"
    if faulted or faulty:
        words += f"; a fault in {faulted}, {percent(faulted / ticks)}, and in {faulty} of {counted(seconds, 'second')}"
    if outcomes["tripped"]:
        words += "; force stays off after three faults in ten seconds until `sandwall ctl SESSION force on`"
    if acted := named_counts(dict(guards.items())):
        words += f"; guards that acted: {acted}"
    if never_answered(haptic):
        return BAD, f"the device answered in no tick; {words}"
    if haptic["literal"]:
        words = f"guards literal, without force limits; {words}"
    often = faulty >= LEAST_SECONDS_FAULTED and faulty > BAD_SECONDS_FAULTED * seconds
    # Only an arm lacks force while it is away. A mouse has a line of its own for that (hand).
    away = 0 if haptic["arm"] else guards.get("lost", 0)
    if (faulted - off - away > BAD_TICKS_FAULTED * ticks or haptic["arm"] and often  # nobody feels the faults of a recording
            or by_fault > MOST_TICKS_RAMPED and had < BAD_FORCE * (had + by_fault)):
        return BAD, words
    noted = (often or haptic["literal"] or guards.get("not_a_number") or faulted > MOST_TICKS_FAULTED * ticks or had < LEAST_FORCE * not_chosen)
    return NOTE if noted else GOOD, words


def strokes(summary, _):
    if summary["hand"]["asked"] != "server":
        return None
    haptic = summary["haptic"]
    if "steps_withheld" not in haptic:
        return UNMEASURED, f"not measured: no report of a haptic server {START}"
    by = dict(haptic["steps_withheld_by"].items())
    by["unknown"] = max(0, haptic["steps_withheld"] - sum(by.values()))
    found = [f"{counted(by[key], 'step')} withheld {why}" for key, why in
             (("wall", "because the wall was behind"), ("disk", "because the disk had no room"), ("start", "at the start of the wall"),
              ("pause", "in a pause"), ("unknown", "for an unknown cause")) if by[key]]
    if dropped := haptic["samples_dropped"]:
        found.append(f"{counted(dropped, 'sample')} of the hand left out")
    gaps = by["wall"] or by["disk"] or by["unknown"] or dropped
    return NOTE if gaps else GOOD, f"{', '.join(found) or 'no step withheld'} {SERVER_START}{'; strokes may have gaps' if gaps else ''}"


def motion(summary, _):
    found, owed = summary["hand"]["slow_motion"], summary["sweeps_owed"]
    if summary["hand"]["asked"] == "none":
        return None
    more = f"; the tool waits for {counted(owed, 'sweep')} at the end" if owed else ""
    if summary["pace"] == "fast":
        return UNMEASURED, f"not measured: with --pace fast a recorded hand waits for the sand{more}"
    if found is None:
        return UNMEASURED, f"not measured: the tool was hardly in the sand {START}{more}"
    words = f"the tool was {found:.1f} times as slow as the hand {START}" if found > MOST_SLOW_MOTION else f"the tool was as fast as the hand {START}"
    return LAGGING if found > LAGGING_SLOW_MOTION else NOTE if found > MOST_SLOW_MOTION else GOOD, words + more


def refusals(summary, _):
    haptic = summary["haptic"]
    parts = ((haptic["refused_by_server"], "by the server", SESSION), (haptic["refused"]["servers"], "of a server", SESSION),
             (haptic["refused"]["connections"], "of other connections by the server", SERVER_START))
    found = [f"{sum(kinds.values())} {what} {span} ({named_counts(kinds)})" for kinds, what, span in parts if any(kinds.values())]
    if not found:
        return None if summary["hand"]["asked"] != "server" else (GOOD, f"0 of the haptic link {SESSION}")
    return NOTE, ", ".join(found)


def steps(summary, _):
    left_out, edits = summary["steps_left_out"], summary["edits"]
    words = f"{summary['steps']} {SESSION}, {summary['steps'] - summary['steps_before']} {START}"
    words += f"; {counted(edits, 'edit')} of an operator {SESSION}" if edits else ""
    words += f"; paused for {summary['held_seconds']['pause']:.1f} s {START}" if summary["held_seconds"]["pause"] else ""
    words += f"; at rest for {summary['held_seconds']['rest']:.1f} s {START}" if summary["held_seconds"]["rest"] else ""
    return (NOTE, f"{left_out} of {words} left out") if left_out else (GOOD, words)


def press(summary, _):
    found, first = summary["steps_unplaced"], summary["refused_press"]
    if not found:
        return None
    words = f"no cell could take the sand of the tool in {counted(found, 'step')} {SESSION}"
    if first:
        words += f"; first of a {first['tool_shape']} of radius {first['tool_radius']:.4g}"
        if first["largest_radius"] is not None:
            words += f"; the largest one that fits there has radius {first['largest_radius']:.4g}" if first["largest_radius"] else "; none fits there"
    return NOTE, words


def sand(summary, _):
    compared = summary["compared"]
    differed, at_server = summary["divergences"], summary["server_divergences"]
    # The ranks that differ in a frame are healed in that frame, or end the job. So at least one is healed for each frame,
    # except for one frame of each earlier start.
    earlier = len(summary["recoveries"]) + (summary["frames_before"] > 0)
    unhealed = max(summary["unhealed"], differed - summary["healed"] - earlier)
    since = f"whole until frame {compared['last_whole']}, {counted(compared['frames_since'], 'frame')} since then"
    end = "compared whole in the last frame" if compared["at_end"] else f"not compared at the end: {since}"
    if compared["server_at_end"] is None and summary["hand"]["asked"] == "server":
        end += "; the haptic server was not compared at the end"
    end += f"; hash {summary['state_hash']}"
    found = []
    if differed or at_server or unhealed or compared["first_difference"] is not None:
        found.append(f"a difference was found in {counted(differed, 'frame')} on ranks, in {at_server} on the haptic server {SESSION}")
        found.append(f"first in frame {compared['first_difference']}" if compared["first_difference"] is not None else "first frame unknown")
        master = f", {summary['master_healed']} of the master {START}" if summary["master_healed"] else ""
        found.append(f"healed {counted(summary['healed'], 'time')}{master}")
    if summary["outvoted"]:
        found.append(f"the journal outvoted a majority {counted(summary['outvoted'], 'time')} {SESSION}")
    if compared["server_at_end"] is False:
        return BAD, f"the haptic server's sand was wrong at the end; {'; '.join([*found, end])}"
    if unhealed > 0:
        return BAD, f"{unhealed} not healed; {'; '.join([*found, end])}"
    if found:
        return NOTE, "; ".join([*found, end])
    whole = compared["at_end"] and (compared["server_at_end"] or summary["hand"]["asked"] != "server" or summary["hand"]["links"] == 0)
    return GOOD if whole else UNMEASURED, f"no difference found {SESSION}; {end}"


def volume(summary, _):
    left = summary["volume_final"] + summary["volume_outflow"] - summary["volume_initial"]
    return (GOOD, f"exact {SESSION}") if left == 0 else (BAD, f"{left:+d} units {SESSION}")


def recoveries(summary, failures):
    found = summary["recoveries"]
    dark = sum(recovery["seconds_to_next_frame"] or 0 for recovery in found)
    alone = sum(recovery.get("seconds_to_link", 0) for recovery in found)
    words = f"{len(found)} {SESSION}"
    if resumed := sum(not recovery["failed_how"] for recovery in found):
        words += f", {resumed} of them by --resume"
    words += f", the wall stood still for {dark:.1f} s" if dark else ""
    words += f", it had no hand for {alone:.1f} s" if alone else ""
    if ended := sum(not failure["restarted"] for failure in failures):
        words += f"; {counted(ended, 'failure')} without a restart"
    return NOTE if found or ended else GOOD, words


def journal(summary, _):
    told = summary["journal"]
    if summary["pace"] == "replay":
        return None
    if told["policy"] == "off":
        return UNMEASURED, "none (off): the session cannot be replayed or resumed"
    words = f"{told['state'].replace('_', ' ')} ({told['policy']})"
    if told["state"] == "written" and told["whole"]:
        return GOOD, f"{words}, every step {SESSION}"
    return BAD if told["policy"] == "required" else NOTE, f"{words}, not whole"


def disk(summary, _):
    told = summary["journal"]
    if told["policy"] == "off":
        return None
    held = summary["held_seconds"]["disk"]
    full = told["full_disk"]
    if held or full["times"] or full["seconds"]:
        return NOTE, f"the sand waited {counted(full['times'], 'time')} for room {SESSION}, {max(held, full['seconds']):.1f} s {START}"
    return GOOD, f"the sand never waited for room {SESSION}"


def checkpoints(summary, _):
    told = summary["journal"]
    failed, beyond = told["checkpoints_failed"], told["checkpoints_beyond"]
    if told["policy"] == "off" or summary["pace"] == "replay":
        return None
    if not told["checkpoints"] and not failed and not beyond:
        return UNMEASURED, f"not measured: none was begun {START}"
    words = f"{told['checkpoints']} begun {START}"
    if failed or beyond:
        return NOTE, f"{failed} not written, {beyond} after the end of a journal that lost steps; {words}"
    return GOOD, f"{words}, all written"


def head(summary, _):
    told = summary.get("head_tracking")
    if told is None:
        return None
    counts = {"refused": told["refused"], "of strangers": told["strangers"], "old": told["old"], "without a head": told["absent"],
              "outside": told["outside"]}
    words = f"{counted(told['packets'], 'packet')} {START}" + (f": {named_counts(counts)}" if any(counts.values()) else "")
    if told["lost"]:
        return NOTE, f"lost {counted(told['lost'], 'time')} {START}; {words}"
    if told["packets"] == 0:
        return UNMEASURED, f"not measured: no packet of a tracker {START}; a trace sends no packets"
    return NOTE if told["refused"] or told["strangers"] else GOOD, words


def skew(summary, _):
    if summary["ranks"] < 2 or summary["pace"] == "replay":
        return None
    if shown_frames(summary) < 1:
        return UNMEASURED, f"not measured: no frame {START}"
    wide = summary["skew_us"]["p99"] > MOST_SKEW_PERIODS * 1e6 / summary["refresh_hz"]
    return NOTE if wide else GOOD, f"{summary['skew_us']['p99'] / 1000:.1f} ms between the ranks' swaps (99 %) {START}"


def slowest(summary, _):
    found = summary["slowest"]
    return None if found is None else (NOTE, f"{found['name']}, last in {100 * found['share']:.0f} % of frames {START}")


def monitors(summary, _):
    if not summary["dark"]:
        return None
    words = [f"output {one['output']} of tile {one['tile']} ({one['monitor']}) was dark {counted(one['times'], 'time')}, {one['seconds']:.1f} s"
             + (" and at the end" if one["at_end"] else "") for one in summary["dark"]]
    return NOTE, f"{'; '.join(words)} {START}"
