"""The tree of domain faults.

    Fault                    exit code   carries
    ├── DrawingFault              3      the drawing cannot be used (also a ValueError)
    ├── LineFault                 4      no line at the place asked for, or the line was lost: place, heading
    ├── TapeFault                 5      not a tape, cut short, silent, format unknown (also a ValueError)
    │   └── ProgramFault          5      not a program of its kind, cut short, garbled: line of the file
    ├── LockFault                 6      a drive left the comparator's range: axis, tape time, positions
    │   └── DropoutFault          6      the way within a dropout is not known: its length, where to go on
    ├── FollowingFault            6      a drive lags more than its speed explains: axis, time, places, limit
    ├── MotionFault               7      no motion to be recorded: axis, time, speed (also a ValueError)
    ├── FileFault                 8      a file that cannot be read or written (also an OSError)
    ├── CardFault                 9      a mistake in a card or a file of settings: line, field
    │                                    (also a ValueError)
    └── DeviceFault              10      a sound device is not there, or left out samples: device, tape time
                                         (also an OSError)

A message is one line: what was wrong, the value got, the values allowed, what to do next.
"""

from __future__ import annotations

from typing import Any

SHOWN = 40  # characters of a wrong line or value: a fault is one line
# exit codes; 1 is a fault of no kind, 2 wrong use
DRAWING, LINE, TAPE, LOCK, MOTION, FILE, CARD, DEVICE = 3, 4, 5, 6, 7, 8, 9, 10
MISTAKE = 70  # EX_SOFTWARE of sysexits.h
BY_SIGNAL = 128  # and the number of the signal, as a shell gives it
SIGKILL = 9  # also where the system has no such name


class Fault(Exception):
    """Root of the tree; `exit_code` is what the command line ends with."""

    exit_code = 1

    def __reduce__(self) -> tuple[Any, ...]:
        """Travel to another process with all that the fault carries."""
        return _unpacked, (type(self), self.args, dict(self.__dict__))


class DrawingFault(Fault, ValueError):
    """The drawing cannot be used."""

    exit_code = DRAWING


class LineFault(Fault):
    """No line at the place asked for (`nearest_mm`: the nearest), or the head lost it; sheet mm, rad."""

    exit_code = LINE

    def __init__(
        self,
        message: str,
        *,
        x_mm: float | None = None,
        y_mm: float | None = None,
        heading_rad: float | None = None,
        nearest_mm: tuple[float, float] | None = None,
    ) -> None:
        super().__init__(message)
        self.x_mm, self.y_mm, self.heading_rad, self.nearest_mm = (
            x_mm,
            y_mm,
            heading_rad,
            nearest_mm,
        )


class TapeFault(Fault, ValueError):
    """The file is no tape that can be played; `time_s` is tape time where one is known."""

    exit_code = TAPE

    def __init__(self, message: str, *, time_s: float | None = None) -> None:
        super().__init__(message)
        self.time_s = time_s


class ProgramFault(TapeFault):
    """The file is no program that can be played; `line` is the line of the file where one is known."""

    def __init__(
        self, message: str, *, line: int | None = None, time_s: float | None = None
    ) -> None:
        super().__init__(message, time_s=time_s)
        self.line = line


class LockFault(Fault):
    """A drive left the comparator's range (fault circuit 162)."""

    exit_code = LOCK

    def __init__(
        self, message: str, *, axis: str, time_s: float, error_cycles: float, position_mm: float
    ) -> None:
        super().__init__(message)
        self.axis, self.time_s, self.error_cycles, self.position_mm = (
            axis,
            time_s,
            error_cycles,
            position_mm,
        )


class DropoutFault(LockFault):
    """The way within a dropout is not known; `resume_mm` is where all axes are behind it, at `resume_at_s`.

    Both are None where the tape does not tell it; `error_cycles`, how far the count lies off behind it, is
    then nan. The length of the dropout includes the filter's reach.
    """

    def __init__(
        self,
        message: str,
        *,
        axis: str,
        time_s: float,
        position_mm: float,
        length_s: float,
        resumes: tuple[float, tuple[float, ...]] | None = None,
        error_cycles: float = float("nan"),
    ) -> None:
        super().__init__(
            message,
            axis=axis,
            time_s=time_s,
            error_cycles=error_cycles,
            position_mm=position_mm,
        )
        self.length_s = length_s
        self.resume_at_s: float | None = None
        self.resume_mm: tuple[float, ...] | None = None
        if resumes is not None:
            self.resume_at_s, self.resume_mm = resumes


class FollowingFault(Fault):
    """A drive is further behind its demand than the demand's speed allows (patent ES 414458, figure 1)."""

    exit_code = LOCK

    def __init__(
        self,
        message: str,
        *,
        axis: str,
        time_s: float,
        demand_mm: float,
        actual_mm: float,
        limit_mm: float,
    ) -> None:
        super().__init__(message)
        self.axis, self.time_s = axis, time_s
        self.demand_mm, self.actual_mm, self.limit_mm = demand_mm, actual_mm, limit_mm


class MotionFault(Fault, ValueError):
    """A motion or path file that cannot be recorded."""

    exit_code = MOTION

    def __init__(
        self,
        message: str,
        *,
        axis: str | None = None,
        time_s: float | None = None,
        speed_mm_s: float | None = None,
    ) -> None:
        super().__init__(message)
        self.axis, self.time_s, self.speed_mm_s = axis, time_s, speed_mm_s


class FileFault(Fault, OSError):
    """A file that cannot be read or written."""

    exit_code = FILE


class CardFault(Fault, ValueError):
    """A mistake in the operator's card: the line of the file, the field, and what it holds."""

    exit_code = CARD

    def __init__(
        self, message: str, *, line: int | None = None, field: str = "", holds: str = ""
    ) -> None:
        super().__init__(message)
        self.line, self.field, self.holds = line, field, holds


class DeviceFault(Fault, OSError):
    """A sound device that is not there, stopped, or left out samples `time_s` into the tape."""

    exit_code = DEVICE

    def __init__(self, message: str, *, device: str = "", time_s: float | None = None) -> None:
        super().__init__(message)
        self.device, self.time_s = device, time_s


def _unpacked(kind: type[Fault], args: tuple[Any, ...], carried: dict[str, Any]) -> Fault:
    """A fault that came from another process."""
    fault = kind.__new__(kind, *args)
    fault.__dict__.update(carried)
    return fault
