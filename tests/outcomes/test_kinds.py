"""The documents name the kinds of outcomes with the amounts that goals may be of."""

import re
from pathlib import Path

from inhand_outcomes.kinds import HANDLED, amounts_by_kind
from inhand_outcomes.uses import USES

DOCUMENT = Path(__file__).parents[2] / "docs" / "outcomes.md"


def test_the_table_of_uses_has_all_kinds_and_their_amounts() -> None:
    documented: dict[str, set[str]] = {}
    amounts: set[str] = set()
    table = DOCUMENT.read_text(encoding="utf-8").partition("### Uses")[2].partition("Parts, and")[0]
    for row in (line.split("|") for line in table.splitlines() if line.count("|") == 5):
        if row[4].strip() != "the same":
            amounts = set(re.findall(r"`(\w+)`", row[4]))
        for kind in re.findall(r"`(\w+)`", row[2]):
            documented.setdefault(kind, set()).update(amounts)
    kinds = amounts_by_kind()
    assert documented == {kind: kinds[kind] for kind in kinds if kind not in HANDLED}


def test_the_table_of_parts_has_those_that_settings_may_name() -> None:
    documented: dict[str, set[str]] = {}
    table = (
        DOCUMENT.read_text(encoding="utf-8").partition("Parts, and")[2].partition("**Volumes")[0]
    )
    for row in (line.split("|") for line in table.splitlines() if line.startswith("| `")):
        for use in re.findall(r"`(\w+)`", row[1]):
            documented.setdefault(use, set()).update(re.findall(r"`(\w+)`", row[2]))
    assert documented == {name: set(use.parts) for name, use in USES.items() if use.parts}
