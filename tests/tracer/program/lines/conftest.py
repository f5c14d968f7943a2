"""What the tests of several contours share."""

from __future__ import annotations

import pytest

from morfax.tracer.program.program import Trace
from morfax.tracer.program.trace_lines import trace_lines
from tests.tracer.inked import inked
from tests.tracer.program.plate import LINES


@pytest.fixture(scope="module")
def all_lines() -> Trace:
    return trace_lines(inked(*LINES, seed=1))
