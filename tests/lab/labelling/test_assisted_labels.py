"""Labels that the images of a recording refine."""

from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np
import pytest
from changed_recordings import replace, write_messages
from inhand_lab.datasets.dataset import Dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.datasets.tracks import Track, true_track
from inhand_lab.evaluation.pose_errors import ErrorGauge, PoseErrors
from inhand_lab.labelling.assistance import Assisted
from inhand_lab.labelling.assisted_labels import AssistedLabels, assist, doubt
from inhand_lab.labelling.interpolation import Interpolated, interpolate
from inhand_lab.labelling.keyframes import Keyframe, LabellingError
from inhand_lab.labelling.labelled_copy import Labels
from inhand_lab.labelling.scene import Scene, load_scene
from inhand_lab.labelling.smoothing import Way
from inhand_runtime.pixels import encode_colour
from inhand_schemas.messages import Message, RgbdFrame
from inhand_tracker.shape.viewpoints import find_viewpoints
from inhand_tracker.wire.poses import pose_message
from keyframed import key, pose
from waving import box, messages

LAST = 60
INACCURACY = np.array([0.003, -0.004, 0.0])


@cache
def dataset() -> Dataset:
    settings = GenerationSettings(("hammerNail",), participants=1, seed=17, frames=LAST + 1)
    return generate(Path(mkdtemp()) / "hammering", settings, lambda: None)


@cache
def hammering() -> tuple[Scene, Track, tuple[Keyframe, ...], Interpolated, AssistedLabels]:
    """A scene, its truth, keyframes 5 mm off, and labels without and with assistance."""
    (entry,) = dataset().entries
    path = dataset().path(entry)
    truth, scene = true_track(load_frames(path, "hammer")), load_scene(path, "camera")
    keyframes = tuple(
        Keyframe(
            frame=frame,
            time_ns=int(scene.times_ns[frame]),
            camera_from_object=pose_message(
                truth.translations[frame] + INACCURACY, truth.rotations[frame]
            ),
        )
        for frame in (0, 30, LAST)
    )
    shape = dataset().shape("hammer")
    way = interpolate(keyframes, scene.times_ns, scene.joints, shape.symmetries)
    found = assist(scene, keyframes, way, (shape, find_viewpoints(shape)))
    return scene, truth, keyframes, way, found


def errors(labels: Any) -> PoseErrors:
    """Errors of the frames between keyframes."""
    truth = hammering()[1]
    between = np.arange(LAST + 1) % 30 > 0
    gauge = ErrorGauge(dataset().shape("hammer"))
    return gauge.compare(
        Track(labels.translations, labels.rotations).of(between), truth.of(between)
    )


@pytest.mark.long
def test_images_bring_labels_nearer_to_the_truth() -> None:
    *_, way, found = hammering()
    plain, refined = errors(way), errors(found.labels)
    assert np.median(refined.translation_m) < 0.75 * np.median(plain.translation_m)
    assert np.rad2deg(np.median(refined.rotation_rad)) < 2.0


@pytest.mark.long
def test_keyframes_keep_their_poses_and_are_not_doubted() -> None:
    _, _, keyframes, _, found = hammering()
    for one in keyframes:
        assert one.pose is not None
        np.testing.assert_array_equal(found.labels.translations[one.frame], one.pose[0])
        np.testing.assert_array_equal(found.labels.rotations[one.frame], one.pose[1])
        assert found.doubts[one.frame] == 0.0


@pytest.mark.long
def test_every_frame_between_keyframes_has_a_covariance_and_a_doubt() -> None:
    *_, found = hammering()
    between = np.arange(LAST + 1) % 30 > 0
    covariances = found.labels.covariances
    assert covariances is not None
    assert np.linalg.eigvalsh(covariances[between]).min() > 0.0
    assert (found.doubts[between] > 0.0).all()
    assert found.worst_frame is not None
    assert found.doubts[found.worst_frame] == found.doubts.max()


@pytest.mark.long
def test_the_same_recording_is_labelled_the_same_again() -> None:
    scene, _, keyframes, way, found = hammering()
    shape = dataset().shape("hammer")
    again = assist(scene, keyframes, way, (shape, find_viewpoints(shape)))
    np.testing.assert_array_equal(again.labels.translations, found.labels.translations)


def pictures(frames: int, colour: bool) -> list[Message]:
    shown = list(messages(frames, 0, images=colour))
    return [
        replace(one, colour=encode_colour(np.zeros((120, 160, 3), np.uint8)))
        if isinstance(one, RgbdFrame)
        else one
        for one in shown
    ]


@pytest.mark.parametrize(("colour", "lacking"), [(True, "depth"), (False, "pictures")])
def test_a_recording_that_shows_no_depth_is_refused(
    tmp_path: Path, colour: bool, lacking: str
) -> None:
    path = write_messages(tmp_path / "wave.mcap", pictures(11, colour))
    scene = load_scene(path, "camera")
    keyframes = key(0, pose()), key(10, pose())
    way = interpolate(keyframes, scene.times_ns, scene.joints)
    line = f"wave.mcap holds no {lacking} of camera camera at its keyframes"
    with pytest.raises(LabellingError, match=line):
        assist(scene, keyframes, way, (box(), None))  # type: ignore[arg-type]


def uncertain(metres: float, radians: float, disagreement: float) -> float:
    covariance = np.diag(np.repeat([metres**2, radians**2], 3) / 3.0)
    way = Way(np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0, 0.0]]), np.zeros(1))
    found = Assisted(way, covariance[None], np.array([disagreement]))
    return float(doubt(found, 0.1)[0])


def test_a_doubt_is_the_expected_error_and_grows_with_disagreement() -> None:
    assert uncertain(0.01, 1e-9, 0.3) == pytest.approx(0.01)
    assert uncertain(1e-9, 0.3, 0.3) == pytest.approx(0.1 * 0.3 * np.sqrt(2.0 / 3.0))
    assert uncertain(0.01, 1e-9, 4.0) == pytest.approx(0.04)


def test_without_a_pose_there_is_no_worst_frame() -> None:
    nothing = Labels(np.full((3, 3), np.nan), np.full((3, 4), np.nan), np.zeros(3, bool))
    assert AssistedLabels(nothing, np.full(3, np.nan)).worst_frame is None
