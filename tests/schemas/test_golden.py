"""What was written once decodes for ever."""

import json
from pathlib import Path
from typing import Any

import make_golden
import msgspec
import pytest
from examples import EXAMPLES, GOLDEN_MESSAGES
from inhand_schemas.json_schema import json_schemas
from inhand_schemas.topics import TOPICS
from make_golden import GOLDEN

BY_TYPE = {topic.message_type.__name__: topic for topic in TOPICS.values()}
TYPES = sorted(BY_TYPE)


def holds(whole: Any, part: Any) -> bool:
    """Whether ``whole`` says all that ``part`` says; it may have grown by fields."""
    if isinstance(part, dict):
        return all(key in whole and holds(whole[key], value) for key, value in part.items())
    if isinstance(part, list):
        return len(whole) == len(part) and all(map(holds, whole, part))
    return bool(whole == part)


@pytest.mark.parametrize("stem", GOLDEN_MESSAGES)
def test_golden_bytes_decode_to_what_they_meant(stem: str) -> None:
    topic = BY_TYPE[stem.split(".")[0]]
    message = topic.decode((GOLDEN / f"{stem}.msgpack").read_bytes())
    decoded = json.loads(msgspec.json.encode(message))
    assert holds(decoded, json.loads((GOLDEN / f"{stem}.json").read_text()))


def test_each_type_has_an_example() -> None:
    assert sorted(type(message).__name__ for message in EXAMPLES) == TYPES
    assert sorted(json_schemas()) == TYPES


def test_making_golden_files_never_changes_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "Event.v1.msgpack").write_bytes(b"precious")
    make_golden.main(tmp_path)
    assert (tmp_path / "Event.v1.msgpack").read_bytes() == b"precious"
    assert "Event.v1.msgpack stays as it is" in capsys.readouterr().out
    assert len(list(tmp_path.iterdir())) == 2 * len(GOLDEN_MESSAGES)
