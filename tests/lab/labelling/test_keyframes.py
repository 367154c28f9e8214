"""The file of a person's keyframes."""

from pathlib import Path

import pytest
from inhand_lab.labelling.keyframes import LabellingError, load_keyframes, save_keyframes
from keyframed import file_of, key, pose


def test_what_is_saved_comes_back_in_the_order_of_frames(tmp_path: Path) -> None:
    path = tmp_path / "box.json"
    last, first = key(30, pose(), relative_to="right hand"), key(0, None)
    save_keyframes(path, file_of(last, first))
    assert load_keyframes(path) == file_of(first, last)
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_cannot_be_replaced_stays(tmp_path: Path) -> None:
    path = tmp_path / "box.json"
    save_keyframes(path, file_of(key(0, pose())))
    before = path.read_bytes()
    (tmp_path / "box.json.part").mkdir()
    with pytest.raises(LabellingError, match=r"cannot write .*box\.json: "):
        save_keyframes(path, file_of(key(0, pose(x=1.0))))
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda text: text[: len(text) // 2], "is no whole JSON"),
        (lambda text: "[]", "holds no keyframes: give a file of inhand-keyframes"),
        (lambda text: text.replace('"version": 1', '"version": 2'), "version 2, and this release"),
        (lambda text: text.replace('"frame": 30', '"frame": 0'), "frame 0 has 2 keyframes"),
        (lambda text: text.replace('"frame": 30', '"frame": -3'), "`int` >= 0"),
        (lambda text: text.replace('"time_ns"', '"time"', 1), "unknown field `time`|missing"),
        (lambda text: text.replace("2.0", "NaN", 1), "is no whole JSON"),
        (lambda text: text.replace('"relative_to": null', '"relative_to": "tail"', 1), "'tail'"),
        (lambda text: text.replace("1.0", "1.5", 1), "rotation is no unit quaternion"),
    ],
)
def test_a_file_that_is_none_gets_one_line(tmp_path: Path, change: object, line: str) -> None:
    path = tmp_path / "box.json"
    save_keyframes(path, file_of(key(0, pose()), key(30, pose())))
    path.write_text(change(path.read_text()))  # type: ignore[operator]
    with pytest.raises(LabellingError, match=line) as raised:
        load_keyframes(path)
    assert "\n" not in str(raised.value)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(LabellingError, match=r"cannot read .*none.json: No such file"):
        load_keyframes(tmp_path / "none.json")
