"""What a person sees between keyframes is what labels will say."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_lab.labelling.interpolation import interpolate
from inhand_lab.labelling.keyframes import Keyframe
from inhand_lab.labelling.scene import load_scene
from inhand_studio.labelling_page import editing as edits
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.labelling_page.shown_pose import shown_pose
from inhand_tracker.shape.shape import Symmetry
from keyframed import FRAMES, dataset, key, later, pose, unlabelled

PARTS = (None, "right hand", "trunk")
ROUND = (Symmetry((0.0, 0.0, 1.0)),)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Iterator[OpenedRecording]:
    opened = OpenedRecording(dataset(tmp_path_factory.mktemp("dataset")))
    yield opened
    opened.close()


keyframes = st.dictionaries(
    st.integers(0, FRAMES - 1),
    st.tuples(st.none() | st.floats(-0.5, 0.5).map(pose), st.sampled_from(PARTS)),
    max_size=5,
).map(
    lambda chosen: tuple(
        key(frame, at, relative_to=None if at is None else part)
        for frame, (at, part) in sorted(chosen.items())
    )
)


@given(chosen=keyframes)
def test_shown_poses_are_those_of_the_labels(
    recording: OpenedRecording, chosen: tuple[Keyframe, ...]
) -> None:
    scene = load_scene(recording.path, recording.camera)
    labels = interpolate(chosen, scene.times_ns, scene.joints)
    for frame in range(FRAMES):
        shown = shown_pose(edits.opened(chosen), recording, frame, ())
        assert (shown.standing == "absent") == labels.absent[frame]
        labelled = np.isfinite(labels.translations[frame, 0])
        assert (shown.standing in ("keyframe", "between")) == labelled
        if labelled:
            assert shown.pose is not None
            assert shown.pose[0] == pytest.approx(labels.translations[frame], abs=1e-9)
            assert shown.pose[1] == pytest.approx(labels.rotations[frame], abs=1e-9)


def test_a_gap_in_time_is_shown_as_a_guess_with_the_reason(tmp_path: Path) -> None:
    late = [later(one, 10**9 if one.sequence >= 15 else 0) for one in unlabelled()]
    opened = OpenedRecording(dataset(tmp_path, late))
    editing = edits.opened((key(0, pose()), key(30, pose(0.3))))
    shown = shown_pose(editing, opened, 20, ())
    opened.close()
    assert shown.standing == "guess"
    assert "1.0 s are missing before frame 15" in shown.note


def test_no_keyframe_begins_at_the_hand(recording: OpenedRecording) -> None:
    shown = shown_pose(edits.opened(()), recording, 0, ROUND)
    assert shown.standing == "guess"
    assert shown.pose is not None
    assert np.linalg.norm(shown.pose[0] - [-0.2, -0.13, 2.12]) < 0.2
