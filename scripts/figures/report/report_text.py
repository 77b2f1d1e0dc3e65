# SPDX-License-Identifier: Apache-2.0
"""Sections of the report, in their order."""

from dataclasses import dataclass
from typing import Callable, Optional

from report import report_piles as piles
from report import report_steps as steps
from report.report_data import TableFault
from report.report_extremes import extremes
from report.report_haptics import force_rate, force_work, latency, stability
from report.report_tin import tin_piles, tin_simplify, tin_tool


@dataclass
class Section:
    title: str
    figure: Optional[str]  # name of the function in report_pile_figures or report_step_figures, and of the picture; None: no figure
    needs: list  # names of the tables; the figure is drawn from the first
    reading: Callable  # takes all tables by name, and returns the text

    def text(self, tables):
        """Returns the text. Raises TableFault, in one line, if the tables cannot support it."""
        try:
            return self.reading(tables)
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            # A value of another kind than the text needs, such as a word in place of a number.
            named = ", ".join(f"{name}.csv" for name in self.needs)
            raise TableFault(f"{named}: its rows do not fit the text ({type(error).__name__}: {error})") from error


SECTIONS = [
    Section("Error against time, at one N", "work_precision", ["work-precision"], piles.work_precision),
    Section("Least time for a wanted error", "envelope", ["work-precision"], piles.envelope),
    Section("Seconds to rest", None, ["rest", "rest-moving"], piles.rest),
    Section("Error at rest against N", "error_at_rest", ["error-at-rest"], piles.error_at_rest),
    Section("Sweeps to rest against N", "sweeps", ["sweeps"], piles.sweeps),
    Section("Roundness", "anisotropy", ["anisotropy"], piles.anisotropy),
    Section("Motion until rest", "decay", ["decay"], piles.decay),
    Section("Height bits", "height_bits", ["height-bits"], piles.height_bits),
    Section("The hysteresis band", "band", ["band"], piles.band),
    Section("One edit", "edit", ["edit"], steps.edit),
    Section("Digging", "dig", ["dig"], steps.dig),
    Section("Large tools", "large_tools", ["large-tools"], steps.large_tools),
    Section("Held tools", "held_tools", ["held-tools"], steps.held_tools),
    Section("Throughput", "throughput", ["throughput"], steps.throughput),
    Section("Mass", "mass_drift", ["mass-drift"], piles.mass_drift),
    Section("The certificate", "certificate", ["certificate"], piles.certificate),
    Section("The parts of one pile's error", "budget", ["budget"], piles.budget),
    Section("Extremes", None, ["extremes"], extremes),
    Section("Springs that an arm bears", "stability", ["stability", "guarded-sweep"], stability),
    Section("Parts that a scene does not need", None, ["parts"], steps.parts),
    Section("A scene explained", None, ["explain"], steps.explain),
    Section("Picture error against draw time", "detail", ["detail"], steps.detail),
    Section("Force between surfaces", "force_rate", ["force-rate"], force_rate),
    Section("Work of the force", None, ["force-work"], force_work),
    Section("Piles on a TIN", "tin_piles", ["tin-piles"], tin_piles),
    Section("A TIN of a raster", "tin_simplify", ["tin-simplify"], tin_simplify),
    Section("A tool in a TIN", None, ["tin-imprint", "tin-active"], tin_tool),
    Section("From the hand to the wall", None, ["latency"], latency),
    Section("One hash", None, ["hashes-release"], steps.hashes),
]
