"""Settings of outcomes that cannot be meant are refused before a start."""

from typing import Any

import pytest
from inhand_outcomes.settings import ObjectUse
from pydantic import ValidationError


@pytest.mark.parametrize(
    ("settings", "line"),
    [
        (
            {"use": "pouring", "parts": {"spuot": [0, 0, 0]}},
            r"no part 'spuot' \(did you mean spout",
        ),
        ({"use": "pouring", "parts": {"rim": [0, 0, 0]}}, r"no part 'rim' \(there are: spout\)"),
        ({"parts": {"nose": [0, 0, 0]}}, "no part 'nose'"),
        ({"use": "lifting", "parts": {"head": [0, 0, 0]}}, "lifting goes by no parts"),
        ({"use": "pouring", "parts": {"spout": [float("nan"), 0, 0]}}, "finite number"),
    ],
)
def test_a_part_that_nothing_goes_by_is_refused(settings: dict[str, Any], line: str) -> None:
    with pytest.raises(ValidationError, match=line):
        ObjectUse.model_validate(settings)


def test_without_a_use_a_part_may_be_of_any() -> None:
    assert ObjectUse.model_validate({"parts": {"rim": [0, 0, 0.1]}}).parts == {"rim": (0, 0, 0.1)}
