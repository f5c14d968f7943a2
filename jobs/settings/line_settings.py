"""Settings of the lines: which are followed, where each begins, which way round, and in what order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from morfax.jobs.wrong_use import WrongUse

if TYPE_CHECKING:
    from morfax.tracer.following.direction import Direction

Place = tuple[float, float]  # mm on the sheet
# of a letter's height: its strokes stand a third of that apart, and between them a cutter must have room
LETTER_CUTTERS = 3.0


@dataclass(frozen=True, slots=True)
class LineSettings:
    """Which line is followed, or which lines, and what holds them together."""

    start_mm: Place | None = None
    # None: the one line at the start, or the longest; with a cutter the contours
    lines: str | tuple[int, ...] | None = None
    line_width_mm: float | None = None
    gap_mm: float | None = None
    recatch_mm: float | None = None
    direction: Direction | None = None
    reference_mm: Place | None = None  # None: looked for on the drawing
    # further places to start: the line at each is traced as well
    more_starts_mm: tuple[Place, ...] = ()
    # where lines begin, and a place that way along them; without `lines` they pick the lines
    arrows_mm: tuple[tuple[Place, Place], ...] = ()
    order: tuple[int, ...] = ()  # numbers of the lines that are cut first, in this order
    # of contours or all the ink: lettering as high is followed, 0 all of it, infinite none; None: not set
    lettering_mm: float | None = None

    @property
    def is_asked_for(self) -> bool:
        """Whether somebody has said which line or lines: by places, by numbers or by their kind."""
        return self.lines is not None or bool(self.starts_mm)

    @property
    def are_several(self) -> bool:
        """Whether lines are asked for, and not one line."""
        return self.lines is not None or len(self.starts_mm) > 1

    @property
    def starts_mm(self) -> tuple[Place, ...]:
        """The places at which lines are picked, those of arrows too."""
        if self.start_mm is not None:
            return (self.start_mm, *self.more_starts_mm)
        return () if self.lines is not None else tuple(place for place, _ in self.arrows_mm)

    def letters_from_mm(self, cutter_mm: float) -> float:
        """How high lettering must be to be followed: as somebody says, or, where a cutter runs round
        contours, high enough for it to run between the strokes of a letter.
        """
        if self.lettering_mm is not None:
            return self.lettering_mm
        return LETTER_CUTTERS * cutter_mm if self.lines in ("contours", "outer") else 0.0

    def _check_lettering(self) -> None:
        """Raise WrongUse for lettering where one line, or some by their numbers, are asked for."""
        if self.lettering_mm is not None and not isinstance(self.lines, str):
            raise WrongUse(
                "--lettering is for --lines all, contours or outer; give one of these too, or leave "
                "--lettering out"
            )

    def check(self) -> None:
        """Raise WrongUse for two that do not go together."""
        self._check_lettering()
        self._check_places()
        self._check_arrows()
        self._check_order()

    def _check_places(self) -> None:
        """Raise WrongUse for places beside other ways to choose, or without a first one."""
        if self.lines is not None and self.start_mm is not None:
            raise WrongUse("--start picks one line, --lines several; give one of them")
        if self.more_starts_mm and self.start_mm is None:
            raise WrongUse("more_starts_mm are further places; give the first one as start_mm")

    def _check_arrows(self) -> None:
        """Raise WrongUse for arrows beside another word on how a line begins."""
        if self.arrows_mm and (self.start_mm is not None or self.direction is not None):
            other = "--start" if self.start_mm is not None else "--direction"
            raise WrongUse(
                f"--arrow and {other} both say how a line begins; give --arrow alone"
            )
        for place, towards in self.arrows_mm:
            if place == towards:
                raise WrongUse(
                    f"--arrow {place[0]:g},{place[1]:g} has two equal places; give a second place along"
                    " the way"
                )

    def _check_order(self) -> None:
        """Raise WrongUse for an order of what has its own, of one line, or with a line twice."""
        if self.lines == "all" and (self.arrows_mm or self.order):
            what = "--arrow" if self.arrows_mm else "--order"
            raise WrongUse(
                f"--lines all puts its strokes in order by itself and does not take {what}; give --lines"
                " contours, or numbers"
            )
        if self.order and not self.are_several:
            raise WrongUse("--order is for several lines; give them with --lines or --start")
        twice = sorted({n for n in self.order if self.order.count(n) > 1})
        if twice:
            raise WrongUse(f"--order names line {twice[0]} twice; name each once")
