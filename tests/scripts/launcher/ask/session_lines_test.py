#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests which figures of the report are ok, a note or BAD."""

import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import launcher_fixture  # finds the modules of the launcher
from sample_summary import (DARK, HEAD, OUTCOMES, RECOVERY, REFUSALS, SAMPLES, SERVER_DIED, SUMMARY, changed, film, outcomes, rank,
                            without_hand)

from ask import session_lines, session_rules
from ask.session_lines import BAD, GOOD, LAGGING, NOTE, UNMEASURED


class Lines(unittest.TestCase):
    def line(self, name, summary=SUMMARY, failures=()):
        """Returns mark and words of a line; (None, "") if it is left out."""
        return next(((mark, words) for mark, found, words in session_rules.lines_of(summary, failures) if found == name), (None, ""))

    def check(self, name, mark, *words, failures=(), summary=None, **fields):
        """Checks mark and words of a line. All other lines must be as in the good session, so that one fault has one line."""
        summary = summary or changed(**fields)
        found, said = self.line(name, summary, failures)
        self.assertEqual(found, mark, said)
        for word in words:
            self.assertIn(word, said)
        return said

    def only(self, name, mark, *words, failures=(), **fields):
        """Checks a line, and that no other line of the session is marked."""
        said = self.check(name, mark, *words, failures=failures, **fields)
        marked = [line[:2] for line in session_rules.lines_of(changed(**fields), failures) if line[0] not in (GOOD, UNMEASURED)]
        self.assertEqual(marked, [(mark, name)])
        return said


class GoodSessions(Lines):
    def test_a_good_session_has_no_mark(self):
        for summary in (SUMMARY, without_hand(), film(), changed(head_tracking=HEAD), changed(ranks=1, per_rank=SUMMARY["per_rank"][:1])):
            marks = {mark for mark, _, _ in session_rules.lines_of(summary)}
            self.assertLessEqual(marks, {GOOD, UNMEASURED}, session_rules.lines_of(summary))

    def test_each_figure_names_its_span(self):
        spans = (session_lines.SESSION, session_lines.START, session_lines.SERVER_START)
        for summary in SAMPLES:
            for _, name, words in session_rules.lines_of(summary, (SERVER_DIED,)):
                if re.search(r"\d", words) and name not in ("wall",):
                    self.assertTrue(any(span in words for span in spans), f"{name}: {words}")

    def test_what_was_not_measured_is_not_called_ok(self):
        nothing = {"mean": 0.0, "stddev": 0.0, "p50": 0.0, "p99": 0.0}
        without_report = {key: value for key, value in SUMMARY["haptic"].items() if key in ("reconnects", "hand_overs", "refused_by_server", "refused")}
        for name, fields in (("latency", {"latency_ms": nothing}), ("force", {"haptic": without_report}), ("force", {"haptic__hand_ticks": 0}),
                             ("strokes", {"haptic": without_report}), ("frames", {"frames": 1, "seconds": 0.0}),
                             ("checkpoints", {"journal__checkpoints": 0}), ("wall", {"per_rank": SUMMARY["per_rank"][:1]}),
                             ("head", {"head_tracking": {**HEAD, "packets": 0}}),
                             ("sand", {"compared__at_end": False, "compared__last_whole": 540, "compared__frames_since": 60})):
            self.check(name, UNMEASURED, "not ", **fields)
        self.check("journal", UNMEASURED, "none (off)", journal={**SUMMARY["journal"], "policy": "off", "state": "off", "whole": False})
        self.check("frames", UNMEASURED, "not measured", summary=film())

    def test_where_no_hand_was_asked_for_its_lines_are_left_out(self):
        names = {name for _, name, _ in session_rules.lines_of(without_hand())}
        self.assertFalse(names & {"latency", "hand", "force", "strokes", "refusals"}, names)
        pointer = changed(hand={**SUMMARY["hand"], "asked": "pointer"})
        names = {name for _, name, _ in session_rules.lines_of(pointer)}
        self.assertTrue({"latency", "hand"} <= names and not names & {"force", "strokes"}, names)


class SlowWalls(Lines):
    def test_a_slow_session_at_the_fast_pace_is_noted(self):
        # The demo on a busy machine: 600 frames at 17.6 frames/s take 34.03 s, 599 periods of 1/60 s take 9.98 s: 70.7 % lost.
        slow = {"pace": "fast", "late_frames": 0, "seconds": 34.03, "fps": 17.6}
        self.only("frames", NOTE, "17.6 of 60 frames/s", "70.7 % of the time lost", **slow)
        self.assertNotIn("frames late", self.line("frames", changed(**slow))[1], "with --pace fast nothing is measured as late")
        self.only("latency", NOTE, "85.0 ms", "2593.8 ms", pace="fast", late_frames=0, latency_ms__p50=85.0, latency_ms__p99=2593.8)

    def test_a_wall_that_stands_still_for_eight_seconds_has_lost_them(self):
        # 1171 frames: 1170 periods are 19.5 s of 27.5 s, so 29.1 % are lost.
        self.check("frames", NOTE, "29.1 % of the time lost", "longest 8017 ms", frames=1171, seconds=27.5, fps=42.5, late_frames=12,
                   frame_ms__max=8016.7, frame_ms__count=1170)

    def test_a_wall_that_misses_a_third_of_the_refreshes_has_lost_a_third(self):
        # (24.4 - 16.67) / 24.4 = 31.7 %; no frame is half a period late.
        self.only("frames", NOTE, "41.0 of 60 frames/s", "31.7 % of the time lost", seconds=599 * 0.0244, fps=41.0, late_frames=0)

    def test_a_hundredth_of_the_time_may_be_lost(self):
        asked = 599 / 60
        self.check("frames", GOOD, seconds=asked / 0.9901)
        self.check("frames", NOTE, seconds=asked / 0.9899)
        self.check("frames", GOOD, "0.0 % of the time lost", pace="fast", seconds=asked / 2, fps=120.0)

    def test_the_limit_of_the_median_depends_on_the_refresh(self):
        # Two periods and 50 ms: 83.3 ms at 60 Hz, 66.7 ms at 120 Hz.
        self.check("latency", GOOD, latency_ms__p50=83.3)
        self.check("latency", NOTE, latency_ms__p50=83.4)
        self.check("latency", NOTE, latency_ms__p50=66.7, refresh_hz=120.0)
        self.check("latency", GOOD, latency_ms__p99=500.0)
        self.check("latency", NOTE, latency_ms__p99=500.1)

    def test_ranks_that_swap_a_period_apart_are_noted(self):
        self.only("skew", NOTE, "200.0 ms", skew_us={"p50": 200.0, "p99": 200000.0, "max": 200000.0})
        self.check("skew", GOOD, skew_us__p99=16666.0)
        self.check("skew", NOTE, skew_us__p99=16667.0)

    def test_a_restart_is_told_apart_from_the_session(self):
        # 453 frames with 900 steps: 302 frames in 10 s since the restart.
        fields = {"frames": 453, "frames_before": 151, "steps": 900, "steps_before": 600, "seconds": 10.04, "fps": 29.98, "refresh_hz": 30.0,
                  "hand__frames_with_hand": 302, "recoveries": [RECOVERY, {**RECOVERY, "seconds_to_next_frame": 4.5}]}
        self.only("recoveries", NOTE, "2 in the session, the wall stood still for 7.0 s", **fields)
        self.check("frames", GOOD, "453 in the session; 30.0 of 30 frames/s for 10.0 s since the last start", **fields)
        self.check("steps", GOOD, "900 in the session, 300 since the last start", **fields)

    def test_a_session_that_was_resumed_by_hand_is_not_said_to_have_failed(self):
        by_hand = {**RECOVERY, "failure": "the start", "failed_rank": None, "failed_how": ""}
        self.only("recoveries", NOTE, "2 in the session, 1 of them by --resume, the wall stood still for 5.0 s", recoveries=[RECOVERY, by_hand])
        self.assertNotIn("--resume", self.check("recoveries", NOTE, recoveries=[RECOVERY]))

    def test_a_rank_that_draws_nothing_is_noted(self):
        blank = {**rank(2), "views": {"skipped": 600, "in_part": 0, "whole": 0, "pixel_share": 0.0}}
        self.only("views", NOTE, "no view was drawn in 600 frames since the last start by rank 2 (tile r1c2) on node01", per_rank=[rank(1), blank])
        self.check("views", NOTE, "in 598 frames", frames_before=2, per_rank=[blank, {**blank, "views": {**blank["views"], "skipped": 0}}])
        self.check("views", None, per_rank=[rank(1), {**blank, "views": {**blank["views"], "in_part": 1}}])
        self.check("views", None, frames_before=600, per_rank=[blank])

    def test_the_slowest_rank_is_noted(self):
        self.only("slowest", NOTE, "rank 2, last in 90 % of frames", slowest={"rank": 2, "name": "rank 2", "share": 0.9, "wall_waited_ms": 20.0})

    def test_each_output_that_was_dark_is_named(self):
        self.only("monitors", NOTE, "output r1c2 of tile r1c2 (DP-2) was dark 1 time, 12.4 s since the last start", dark=[DARK])
        self.only("monitors", NOTE, "was dark 2 times, 12.4 s and at the end; output r2c1_left of tile r2c1 (DP-1) was dark 1 time, 3.0 s since",
                  dark=[{**DARK, "times": 2, "at_end": True}, {**DARK, "output": "r2c1_left", "tile": "r2c1", "monitor": "DP-1", "seconds": 3.0}])


class Hands(Lines):
    def test_a_hand_that_never_came_is_bad(self):
        never = {"asked": "server", "links": 0, "frames_with_hand": 0, "linked_at_end": False, "slow_motion": None}
        self.check("hand", BAD, "never linked in the session: no answer", summary=without_hand(hand={**never, "last_refusal": "no answer"}))
        refused = without_hand(hand={**never, "last_refusal": "another scene"})
        self.check("hand", BAD, "never linked in the session: another scene", summary=refused)
        self.assertNotIn((GOOD, "latency"), [line[:2] for line in session_rules.lines_of(refused)])

    def test_a_hand_that_never_came_after_a_restart_is_bad(self):
        gone = {"hand": {**SUMMARY["hand"], "frames_with_hand": 0, "linked_at_end": False, "last_refusal": "no answer"}}
        self.check("hand", BAD, "never linked since the last start", **gone)
        self.check("hand", NOTE, "not linked at the end", seconds=1.0, frames=60, **gone)

    def test_a_device_that_answers_in_no_tick_is_bad(self):
        lost = {"haptic__hand_ticks": 2561, "haptic__felt_ticks": 0, "haptic__faulted_ticks": 2561, "haptic__guarded_ticks__lost": 2561}
        self.only("force", BAD, "the device answered in no tick", **lost)
        self.check("latency", UNMEASURED, "the device answered in no tick", **lost)

    def test_a_device_that_was_off_before_the_session_is_not_bad(self):
        self.check("force", GOOD, haptic__guarded_ticks__lost=100000)

    def test_faults_are_a_note_and_more_than_half_are_bad(self):
        for faulted, mark in ((100, GOOD), (101, NOTE), (5000, NOTE), (5001, BAD)):
            self.check("force", mark, f"a fault in {faulted}", haptic__faulted_ticks=faulted, haptic__guarded_ticks__missed=faulted)
        for away, mark in ((0, BAD), (1, NOTE), (5001, NOTE)):  # ticks in which a mouse was away
            self.check("force", mark, haptic__faulted_ticks=5001, haptic__guarded_ticks__lost=away, haptic__arm=False)
        self.check("force", BAD, haptic__faulted_ticks=5001, haptic__guarded_ticks__lost=5001)
        self.only("force", NOTE, "not_a_number 1", haptic__guarded_ticks__not_a_number=1)
        self.only("force", NOTE, "guards literal", haptic__literal=True)
        self.check("force", GOOD, "guards that acted: ramp 500", haptic__guarded_ticks__frozen=9000)

    def test_faults_in_more_than_a_tenth_of_the_seconds_are_bad(self):
        # An arm that loses one reading in 250: 0.4 % of the ticks, and each second.
        self.only("force", BAD, "a fault in 40, 0.4 %, and in 10 of 10 seconds", haptic__faulted_ticks=40, haptic__faulted_seconds=10)
        for seconds, faulty, mark in ((10, 2, GOOD), (10, 3, BAD), (30, 3, GOOD), (29, 3, BAD)):
            self.check("force", mark, haptic__hand_seconds=seconds, haptic__faulted_seconds=faulty, haptic__faulted_ticks=faulty)
            self.check("force", NOTE if mark == BAD else mark, haptic__hand_seconds=seconds, haptic__faulted_seconds=faulty,
                       haptic__faulted_ticks=faulty, haptic__arm=False)

    def test_a_hand_with_less_than_half_of_the_force_is_noted_and_below_a_tenth_bad_if_arm_or_link_are_to_blame(self):
        for cause in session_lines.SLOW:
            self.check("force", GOOD, haptic__asked_ticks=outcomes(half=2000, **{cause: 2000}))
            self.only("force", NOTE, f"{session_lines.SLOW[cause]} 9840", haptic__asked_ticks=outcomes(half=160, **{cause: 9840}))
        for cause in session_lines.FAULTY:
            # 2001 ticks are more than two ramps; the tenth of 2223 ticks is 222.3.
            for half, faulty, mark in ((2000, 2000, GOOD), (1999, 2000, NOTE), (222, 2001, BAD), (223, 2001, NOTE), (0, 2000, NOTE)):
                self.only_force(mark, outcomes(half=half, **{cause: faulty}))
        # 65 of 18,344 ticks with force: the master stands still for 0.35 s in each second.
        self.only("force", BAD, "at least half of it in 65 of 18344 ticks that ask for force, of 18344 ticks", "the start of a link 1000, no steps 17279",
                  haptic__hand_ticks=18344, haptic__hand_seconds=19, haptic__asked_ticks=outcomes(half=65, start=1000, steps=17279))

    def test_force_that_three_faults_have_switched_off_is_bad_for_an_arm_alone(self):
        switched_off = {"haptic__asked_ticks": outcomes(half=100, tripped=9000), "haptic__guarded_ticks__tripped": 9000,
                        "haptic__faulted_ticks": 9003, "haptic__faulted_seconds": 3}
        self.only("force", BAD, "force stays off after three faults in ten seconds", **switched_off)
        self.only("force", NOTE, "force stays off after three faults in ten seconds", haptic__arm=False, **switched_off)

    def test_slow_motion_is_a_note_however_little_the_hand_had(self):
        said = self.only("force", NOTE, "less because of: slow motion 9830", haptic__asked_ticks=outcomes(half=160, slow_motion=9830, steps=10))
        self.assertIn("at least half of it in 160 of 10000", said)

    def test_what_a_person_has_chosen_is_named_and_has_no_mark(self):
        self.check("force", GOOD, "at least half of it in 0 of 7459 ticks", "less because of: force is off 7459", haptic__felt_ticks=0,
                   haptic__asked_ticks=outcomes(off=7459))
        for cause, words in session_lines.CHOSEN.items():
            self.check("force", GOOD, f"{words} 9000", haptic__asked_ticks=outcomes(half=100, **{cause: 9000}))
            self.check("force", NOTE, f"{words} 9000", haptic__asked_ticks=outcomes(half=100, growth=101, **{cause: 9000}))

    def only_force(self, mark, asked):
        self.check("force", mark, haptic__asked_ticks=asked) if mark == GOOD else self.only("force", mark, haptic__asked_ticks=asked)

    def test_each_outcome_has_words(self):
        causes = {**session_lines.CHOSEN, **session_lines.SLOW, **session_lines.FAULTY}
        self.assertEqual(["half", *causes], list(OUTCOMES))

    def test_a_server_that_died_for_good_is_bad(self):
        half = {"hand": {**SUMMARY["hand"], "frames_with_hand": 300, "linked_at_end": False}}
        self.check("hand", BAD, "the haptic server was killed by SIGKILL and was not started again", "in 300 of 600 frames", failures=(SERVER_DIED,), **half)
        self.check("recoveries", NOTE, "0 in the session; 1 failure without a restart", failures=(SERVER_DIED,), **half)
        self.check("hand", NOTE, failures=({**SERVER_DIED, "restarted": True},), **half)
        self.check("hand", GOOD, failures=({**SERVER_DIED, "now": False},))

    def test_links_made_again_are_noted(self):
        self.only("hand", NOTE, "links made again: 500 in the session", haptic__reconnects=500, hand__links=501)

    def test_a_device_that_stopped_answering_is_noted(self):
        self.only("hand", NOTE, "the device stopped answering 1 time since the last start of the haptic server; linked", haptic__device_losses=1)
        self.only("hand", NOTE, "stopped answering 2 times", ", and did not answer at the end; linked", haptic__device_losses=2, haptic__device_away=True)

    def test_steps_withheld_have_their_cause(self):
        by = {"wall": 0, "disk": 0, "pause": 0, "start": 0}
        for cause, words, mark in (("wall", "because the wall was behind", NOTE), ("disk", "because the disk had no room", NOTE),
                                   ("start", "at the start", GOOD), ("pause", "in a pause", GOOD)):
            self.check("strokes", mark, f"70 steps withheld {words}", haptic__steps_withheld=70, haptic__steps_withheld_by={**by, cause: 70})
        self.check("strokes", NOTE, "for an unknown cause", haptic__steps_withheld=70)
        self.only("strokes", NOTE, "2 samples of the hand left out", haptic__samples_dropped=2)

    def test_a_tool_that_is_slower_than_the_hand_is_noted(self):
        self.check("motion", GOOD, "as fast as the hand", hand__slow_motion=1.1)
        self.only("motion", NOTE, "the tool was 4.0 times as slow as the hand", hand__slow_motion=4.0)
        self.only("motion", LAGGING, "the tool was 6.3 times as slow as the hand", hand__slow_motion=6.3)
        self.check("motion", UNMEASURED, "hardly in the sand", hand__slow_motion=None)
        self.check("motion", GOOD, "waits for 70 sweeps at the end", sweeps_owed=70)
        self.check("motion", UNMEASURED, "a recorded hand waits for the sand", pace="fast", hand__slow_motion=None)

    def test_refusals_are_noted(self):
        self.only("refusals", NOTE, "1 by the server in the session (secret 1)", haptic__refused_by_server={**REFUSALS, "secret": 1})


class Sand(Lines):
    def test_a_difference_of_the_last_second_is_not_called_equal(self):
        unhealed = {"divergences": 1, "unhealed": 1, "compared__at_end": False, "compared__first_difference": 600, "compared__last_whole": 540,
                    "compared__frames_since": 60}
        self.only("sand", BAD, "1 not healed", "first in frame 600", "not compared at the end: whole until frame 540, 60 frames since then", **unhealed)
        self.only("sand", NOTE, "first in frame 600", divergences=1, healed=1, compared__first_difference=600)

    def test_sand_that_differs_in_four_hundred_frames_and_was_healed_once_is_bad(self):
        self.only("sand", BAD, "399 not healed", "found in 400 frames on ranks", divergences=400, healed=1, compared__first_difference=20)
        self.only("sand", BAD, "2 not healed", divergences=1, healed=1, unhealed=2, compared__first_difference=20)

    def test_a_difference_that_ended_an_earlier_job_is_no_fault_of_the_sand_now(self):
        fields = {"divergences": 3, "healed": 2, "compared__first_difference": 20, "frames_before": 100, "hand__frames_with_hand": 500}
        self.check("sand", NOTE, recoveries=[RECOVERY], **fields)
        self.check("sand", BAD, "1 not healed", recoveries=[RECOVERY], **{**fields, "divergences": 5})

    def test_wrong_sand_of_the_server_is_bad(self):
        self.only("sand", BAD, "the haptic server's sand was wrong at the end", compared__server_at_end=False)
        self.only("sand", NOTE, "in 1 on the haptic server", server_divergences=1, compared__first_difference=20)

    def test_a_server_that_was_not_compared_is_not_called_equal(self):
        self.check("sand", UNMEASURED, "the haptic server was not compared at the end", compared__server_at_end=None)

    def test_a_majority_that_was_outvoted_is_noted(self):
        self.only("sand", NOTE, "outvoted a majority 3 times", outvoted=3)

    def test_a_rest_explains_why_there_are_few_steps(self):
        self.check("steps", GOOD, "; at rest for 598.2 s since the last start", held_seconds__rest=598.2)

    def test_steps_left_out_are_noted(self):
        self.only("steps", NOTE, "70 of 590 in the session", steps_left_out=70)

    def test_a_press_that_no_cell_could_take_is_noted_with_the_largest_radius(self):
        first = {"tool_shape": "sphere", "tool_radius": 0.61234, "largest_radius": 0.58}
        self.only("press", NOTE, "in 70 steps in the session", "first of a sphere of radius 0.6123; the largest one that fits there has radius 0.58",
                  steps_unplaced=70, refused_press=first)
        self.check("press", NOTE, "; none fits there", steps_unplaced=1, refused_press={**first, "largest_radius": 0})
        self.check("press", NOTE, "first of a sphere of radius 0.6123;", steps_unplaced=1, refused_press={**first, "largest_radius": None})
        self.check("press", NOTE, "in 1 step in the session", steps_unplaced=1)  # before the last start

    def test_an_inexact_volume_is_bad(self):
        self.only("volume", BAD, "+1 units", volume_final=891)


class Disks(Lines):
    def test_a_full_disk_is_the_cause_and_a_required_journal_is_bad(self):
        fields = {"steps": 0, "journal": {**SUMMARY["journal"], "state": "no_room", "whole": False, "checkpoints": 0,
                                          "full_disk": {"times": 1, "seconds": 3.9}},
                  "held_seconds": {"pause": 0.0, "disk": 3.9, "rest": 0.0}, "haptic__steps_withheld": 240,
                  "haptic__steps_withheld_by": {"wall": 0, "disk": 240, "pause": 0, "start": 0}}
        self.check("journal", BAD, "no room (required), not whole", **fields)
        self.check("disk", NOTE, "waited 1 time for room", "3.9 s", **fields)
        said = self.check("strokes", NOTE, "240 steps withheld because the disk had no room", **fields)
        self.assertNotIn("wall", said)

    def test_a_required_journal_without_its_end_is_bad(self):
        self.only("journal", BAD, "not whole", journal__whole=False)
        self.only("journal", NOTE, "failed (best-effort), not whole", journal__whole=False, journal__state="failed", journal__policy="best-effort")

    def test_checkpoints_that_failed_are_noted(self):
        self.only("checkpoints", NOTE, "3 not written", journal__checkpoints=3, journal__checkpoints_failed=3)
        self.only("checkpoints", NOTE, "2 after the end", journal__checkpoints_beyond=2)

    def test_a_head_that_was_lost_is_noted(self):
        self.only("head", NOTE, "lost 40 times", head_tracking={**HEAD, "lost": 40})
        self.only("head", NOTE, "of strangers 2", head_tracking={**HEAD, "strangers": 2})


if __name__ == "__main__":
    unittest.main()
