"""Keyframes while they are edited: whatever was done can be undone."""

from collections.abc import Callable

from hypothesis import given
from hypothesis import strategies as st
from inhand_lab.labelling.keyframes import Keyframe
from inhand_schemas.messages import Pose
from inhand_studio.labelling_page import editing as edits
from inhand_studio.labelling_page.editing import Editing

Change = Callable[[Editing], Editing]

poses = st.none() | st.floats(-1.0, 1.0).map(lambda x: Pose((x, 0.0, 2.0), (1.0, 0.0, 0.0, 0.0)))
frames = st.integers(0, 9)
parts = st.sampled_from((None, "right hand", "trunk"))


def _key(frame: int, pose: Pose | None, part: str | None = None) -> Keyframe:
    relative = None if pose is None else part
    return Keyframe(frame=frame, time_ns=frame, camera_from_object=pose, relative_to=relative)


keys = st.builds(_key, frames, poses, parts)
changes: st.SearchStrategy[Change] = st.one_of(
    keys.map(lambda key: lambda one: edits.with_keyframe(one, key)),
    frames.map(lambda frame: lambda one: edits.without_keyframe(one, frame)),
    st.tuples(parts, frames).map(lambda two: lambda one: edits.relative_to(one, *two)),
)
steps = st.lists(st.one_of(changes, st.sampled_from((edits.undone, edits.redone))), max_size=20)


def _after(done: list[Change], start: Editing) -> Editing:
    for change in done:
        start = change(start)
    return start


@given(before=steps, change=changes)
def test_undo_takes_back_what_was_done_and_redo_does_it_again(
    before: list[Change], change: Change
) -> None:
    editing = _after(before, Editing())
    changed = change(editing)
    if changed.keyframes == editing.keyframes:
        return
    assert edits.undone(changed).keyframes == editing.keyframes
    assert edits.redone(edits.undone(changed)).keyframes == changed.keyframes


@given(done=steps)
def test_all_can_be_undone_to_what_was_opened_and_done_again(done: list[Change]) -> None:
    start = edits.opened((_key(3, None),))
    editing = _after(done, start)
    back = _after([edits.undone] * len(done), editing)
    assert back.keyframes == start.keyframes
    assert not back.unsaved
    assert _after([edits.redone] * (2 * len(done)), back).keyframes == (
        _after([edits.redone] * len(done), editing).keyframes
    )


@given(done=steps)
def test_keyframes_stay_in_order_and_one_a_frame(done: list[Change]) -> None:
    numbers = [one.frame for one in _after(done, Editing()).keyframes]
    assert numbers == sorted(set(numbers))


@given(done=steps, change=changes)
def test_a_change_after_undo_forgets_what_was_undone(done: list[Change], change: Change) -> None:
    undone = edits.undone(_after(done, Editing()))
    changed = change(undone)
    if changed.keyframes != undone.keyframes:
        assert edits.redone(changed) == changed


@given(done=steps)
def test_unsaved_is_what_the_disk_does_not_hold(done: list[Change]) -> None:
    editing = _after(done, Editing())
    assert editing.unsaved == (editing.keyframes != ())
    assert not edits.saved(editing, editing.keyframes).unsaved


def test_a_body_part_changes_the_keyframe_of_the_frame_alone() -> None:
    pose = Pose((0.0, 0.0, 2.0), (1.0, 0.0, 0.0, 0.0))
    editing = edits.opened((_key(1, pose), _key(2, None), _key(3, pose)))
    chosen = edits.relative_to(editing, "right hand", 3)
    assert [one.relative_to for one in chosen.keyframes] == [None, None, "right hand"]
    assert edits.relative_to(editing, "right hand", 2).keyframes == editing.keyframes
    assert chosen.part == "right hand"
