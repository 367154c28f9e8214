"""One thing is named as one."""

import pytest
from inhand_runtime.wording import counted


@pytest.mark.parametrize(
    ("number", "text"), [(0, "0 keys"), (1, "1 key"), (2, "2 keys"), (10_000, "10,000 keys")]
)
def test_only_one_is_singular(number: int, text: str) -> None:
    assert counted(number, "key") == text


def test_an_irregular_plural_is_given() -> None:
    assert [counted(number, "entry", "entries") for number in (1, 2)] == ["1 entry", "2 entries"]
