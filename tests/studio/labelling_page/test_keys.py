"""The keys of the labelling page."""

import re
from pathlib import Path

from inhand_studio.labelling_page.keys import KEYS, described

DOCS = Path(__file__).parents[3] / "docs" / "studio.md"
TURN_THE_SCENE = {"W", "A", "S", "D", "Q", "E", "arrowup", "arrowdown", "arrowleft", "arrowright"}


def test_each_key_does_one_thing_and_none_of_those_that_turn_the_scene() -> None:
    pressed = [(one.key, one.modifier) for one in KEYS]
    assert len(set(pressed)) == len(pressed)
    assert not {one.key for one in KEYS} & TURN_THE_SCENE


def test_the_page_and_the_document_list_every_key() -> None:
    table = DOCS.read_text(encoding="utf-8").split("| key |", 1)[1]
    listed = set(re.findall(r"[A-Z](?![a-z])|\d|[a-z ]+", table))
    words = {one.strip() for one in listed}
    assert {one.key.replace("page", "page ").strip() for one in KEYS} <= words
    assert all(one.about in described() for one in KEYS)
