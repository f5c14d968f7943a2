"""The page of a batch: each remark stands by itself, and its options can be copied in one piece."""

from __future__ import annotations

import re

from morfax.batch import page


def test_an_option_is_not_broken_at_its_hyphens_nor_a_place_below_zero() -> None:
    shown = page._paragraph("at -3.5,2 mm; --recatch 5mm & `morfax correct --rub` follow it")
    assert shown.startswith("<p>") and shown.endswith("</p>") and "5mm &amp; " in shown
    assert re.findall(r'<span class="option">(.*?)</span>', shown) == ["--recatch", "--rub"]
    assert ".option { white-space: nowrap; }" in page.STYLE
