"""What trackers get to see of recordings, simulated or recorded."""

from pathlib import Path

import msgspec
import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.observations import observe, track_together
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.training.model_training import train
from inhand_runtime.pixels import encode_depth
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, ColourImage, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, RGBD, SKELETONS
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from waving import FRAME_NS, HEIGHT, START_NS, WIDTH, info, messages, person, waving, write_dataset

TOPICS = {CameraInfo: INFO, Skeletons: SKELETONS, RgbdFrame: RGBD, ObjectPose: LABEL}
FRAMES = 6


def record(path: Path, *cameras: str, labelled: tuple[str, ...]) -> Path:
    """What a recorder writes of several cameras, each with its own person and pixels."""
    with RecordingWriter(path) as writer:
        for seed, camera in enumerate(cameras):
            for message in messages(FRAMES, seed, images=True, camera=camera):
                label = isinstance(message, ObjectPose)
                if label and camera not in labelled:
                    continue
                topic = TOPICS[type(message)]
                writer.write(
                    topic.key(Site(), "box" if label else camera),
                    topic.encode(message),
                    received_ns=message.time_ns + seed,
                    captured_ns=message.time_ns,
                    sequence=message.sequence,
                )
    return path


def test_of_several_cameras_the_labelled_one_is_seen(tmp_path: Path) -> None:
    path = record(tmp_path / "a.mcap", "left", "right", labelled=("right",))
    frames = load_frames(path, "box")
    seen = list(observe(path, frames, ("edges",)))
    joints, _, _ = waving(FRAMES, seed=1)
    assert len(seen) == FRAMES
    for observation, expected in zip(seen, joints, strict=True):
        np.testing.assert_allclose(observation.joints, expected)
    (alone,) = [one for one in messages(1, 1, images=True) if isinstance(one, RgbdFrame)]
    assert seen[0].image is not None
    assert alone.colour is not None
    assert seen[0].image.grey is not None
    assert seen[0].image.grey.shape == (alone.colour.height, alone.colour.width)


def test_labels_in_two_cameras_are_refused(tmp_path: Path) -> None:
    path = record(tmp_path / "a.mcap", "left", "right", labelled=("left", "right"))
    with pytest.raises(DatasetError, match=r"2 cameras \(left, right\): label it in one"):
        load_frames(path, "box")


def test_two_cameras_without_a_label_are_refused(tmp_path: Path) -> None:
    path = record(tmp_path / "a.mcap", "left", "right", labelled=())
    with pytest.raises(DatasetError, match="no label are of 2 cameras"):
        load_frames(path, "box")


def test_labels_of_a_camera_that_was_not_recorded_are_refused(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "a.mcap") as writer:
        for message in messages(2, 0, camera="front"):
            topic = TOPICS[type(message)]
            writer.write(
                topic.key(Site(), "box" if topic is LABEL else "back"),
                topic.encode(message),
                received_ns=message.time_ns,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )
    with pytest.raises(DatasetError, match="made in camera 'front', and the skeletons are of back"):
        load_frames(tmp_path / "a.mcap", "box")


def write(path: Path, *recorded: Skeletons | RgbdFrame | CameraInfo) -> Path:
    with RecordingWriter(path) as writer:
        for message in recorded:
            topic = TOPICS[type(message)]
            writer.write(
                topic.key(Site(), "camera"),
                topic.encode(message),
                received_ns=message.time_ns,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )
    return path


def at(frame: int) -> dict[str, int]:
    return {"sequence": frame, "time_ns": START_NS + frame * FRAME_NS}


def test_a_frame_whose_pixels_were_lost_is_seen_without_an_image(tmp_path: Path) -> None:
    all_of_them = [one for one in messages(4, 0, images=True) if not isinstance(one, ObjectPose)]
    kept = [one for one in all_of_them if not (isinstance(one, RgbdFrame) and one.sequence == 2)]
    path = write(tmp_path / "a.mcap", *kept)
    seen = list(observe(path, load_frames(path, None), ("edges",)))
    assert [one.image is not None for one in seen] == [True, True, False, True]


def test_damaged_pixels_are_none(tmp_path: Path) -> None:
    _, skeletons, _ = messages(1, 0)
    assert isinstance(skeletons, Skeletons)
    broken = RgbdFrame(**at(0), colour=ColourImage("jpeg", WIDTH, HEIGHT, b"no picture"))
    path = write(tmp_path / "a.mcap", info(), skeletons, broken)
    (seen,) = observe(path, load_frames(path, None), ("edges",))
    assert seen.image is None


def test_only_what_the_terms_need_is_decoded(tmp_path: Path) -> None:
    (pixels,) = [one for one in messages(1, 0, images=True) if isinstance(one, RgbdFrame)]
    depth = encode_depth(np.full((12, 16), 2500, np.uint16))
    frame = RgbdFrame(**at(0), colour=pixels.colour, depth=depth)
    skeletons = Skeletons(**at(0), people=(person(waving(1, 0)[0][0]),))
    path = write(tmp_path / "a.mcap", info(), skeletons, frame)
    frames = load_frames(path, None)
    (nothing,) = observe(path, frames)
    assert nothing.image is None
    (edges,) = observe(path, frames, ("edges",))
    assert edges.image is not None
    assert edges.image.depth is None
    (both,) = observe(path, frames, ("edges", "depth"))
    assert both.image is not None
    assert both.image.grey is not None
    assert both.image.depth is not None
    np.testing.assert_allclose(both.image.depth, 2.5)
    (surfaces,) = observe(path, frames, ("depth",))
    assert surfaces.image is not None
    assert surfaces.image.grey is None


def test_a_change_of_person_is_marked(tmp_path: Path) -> None:
    body = waving(1, 0)[0][0]
    first, second = person(body), person(body + np.array([0.1, 0.0, 0.0]))
    other = type(second)(
        id=7, joints=second.joints, states=second.states, confidences=second.confidences
    )
    people = [first, first, other, other]
    path = write(
        tmp_path / "a.mcap",
        *(Skeletons(**at(80 * frame), people=(who,)) for frame, who in enumerate(people)),
    )
    seen = list(observe(path, load_frames(path, None)))
    assert [one.somebody_else for one in seen] == [True, False, True, False]


def test_trackers_together_give_what_each_gives_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    dataset = write_dataset(tmp_path / "set", frames=12, images=True)
    *trained, tested = dataset.entries
    model = train(dataset, trained)
    path = dataset.path(tested)
    frames = load_frames(path, "box")

    def trackers() -> list[ParticleTracker]:
        return [
            ParticleTracker(model, VARIANTS["gd-stable"], seed=0),
            ParticleTracker(model, VARIANTS["gd-random"], seed=1),
            ParticleTracker(model, VARIANTS["gd-random"], terms=(), seed=1),
        ]

    alone = [
        [seen.show(tracker) for seen in observe(path, frames, ("edges",))] for tracker in trackers()
    ]
    decoded = []
    monkeypatch.setattr(
        "inhand_tracker.wire.conversion.decode_grey",
        lambda image: decoded.append(1) or np.zeros((image.height, image.width), np.uint8),
    )
    list(observe(path, frames, ("edges",)))
    assert len(decoded) == 12
    monkeypatch.undo()
    joints, tracks = track_together(trackers(), path, frames, ("edges",))
    assert np.isfinite(joints).all()
    for track, estimates in zip(tracks, alone, strict=True):
        np.testing.assert_array_equal(track.translations, [one.translation for one in estimates])
        np.testing.assert_array_equal(track.rotations, [one.rotation for one in estimates])
    assert not np.array_equal(tracks[1].translations, tracks[2].translations)


RESTAMPED = {
    "1 ms late": {"time_ns": 10**6},
    "1 ms early": {"time_ns": -(10**6)},
    "numbered anew": {"sequence": 1000},
}


@pytest.mark.parametrize("other", RESTAMPED)
def test_pixels_are_seen_though_another_program_stamped_them(tmp_path: Path, other: str) -> None:
    assert images_by(tmp_path, RESTAMPED[other]) == [True] * FRAMES


def test_pixels_of_another_moment_are_not_seen(tmp_path: Path) -> None:
    assert images_by(tmp_path, {"time_ns": 7 * FRAME_NS // 10}) == [False] * FRAMES


def images_by(folder: Path, off: dict[str, int]) -> list[bool]:
    """Whether each frame is seen with an image, where the pixels' stamps are off."""
    with RecordingWriter(folder / "a.mcap") as writer:
        for message in messages(FRAMES, 0, images=True, camera="front"):
            if isinstance(message, RgbdFrame):
                stamps = {name: getattr(message, name) + by for name, by in off.items()}
                message = msgspec.structs.replace(message, **stamps)
            topic = TOPICS[type(message)]
            writer.write(
                topic.key(Site(), "box" if topic is LABEL else "front"),
                topic.encode(message),
                received_ns=message.time_ns,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )
    path = folder / "a.mcap"
    seen = observe(path, load_frames(path, "box"), ("colour",))
    return [one.image is not None for one in seen]
