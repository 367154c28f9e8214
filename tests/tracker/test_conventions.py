"""A tracker whose skeletons are of another convention than its model's, over a real session."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from inhand_runtime.inbox import Received
from inhand_schemas.messages import ObjectPose, Skeletons
from inhand_schemas.topics import POSE, SKELETONS
from inhand_tracker.body.convention_map import move_joints
from inhand_tracker.body.convention_table import TABLE
from inhand_tracker.body.parameters import DEFAULT_BODY
from inhand_tracker.body.skeleton import stature_of
from inhand_tracker.model.model_file import save_model
from people import FRAME_NS, unseen_wave, wave_model
from running_rig import RunningRig, eventually
from waving import person
from wire import Wire

FRAMES = 40
LEGS = range(12, 20)


def skeletons(
    joints: np.ndarray, convention: str | None, first: int, missing: range = range(0)
) -> Iterator[Skeletons]:
    for number, frame in enumerate(joints, first):
        yield Skeletons(
            sequence=number,
            time_ns=(number + 1) * FRAME_NS,
            people=(person(frame, missing),),
            convention=convention,
        )


def places(heard: list[Received], first: int) -> np.ndarray:
    poses = [POSE.decode(one.payload) for one in heard]
    given: list[ObjectPose] = [pose for pose in poses if first <= pose.sequence < first + FRAMES]
    return np.array([pose.camera_from_object.translation for pose in given])


@pytest.mark.long
def test_a_tracker_maps_what_it_knows_and_status_says_what_nobody_showed(
    rig: RunningRig, wire: Wire
) -> None:
    model = wave_model()
    file = rig.folder / "wedge.model"
    save_model(replace(model, mapping=replace(model.mapping, convention="simulated")), file)
    rig.configure(
        f'[tracker.wedge]\nmodel = "{file}"\ncamera = "front"\n'
        "likelihood = []\nevery_frame = true\n"
    )
    rig.inhand("tracker", "--config", rig.config).said("wedge is up")
    heard, publisher = wire.hear(POSE), wire.publisher(SKELETONS, "front")
    eventually("the reader", publisher.wanted)
    joints = unseen_wave(FRAMES)
    away = TABLE["kinect_v1"] - TABLE["simulated"]
    kinect = move_joints(joints, away, stature_of(joints))
    for first, some, name in (
        (0, joints, "simulated"),
        (100, kinect, "kinect_v1"),
        (200, kinect, "simulated"),
    ):
        for message in skeletons(some, name, first):
            publisher.put(message)
        eventually("all poses", lambda first=first: len(places(heard, first)) == FRAMES)
    usual, mapped, taken_as_it_is = (places(heard, first) for first in (0, 100, 200))
    apart = np.linalg.norm(mapped - usual, axis=1)
    wrong = np.linalg.norm(taken_as_it_is - usual, axis=1)
    assert np.median(apart) < 0.5 * np.median(wrong)
    assert rig.health("wedge")["troubles"] == []

    many = np.concatenate([joints] * (DEFAULT_BODY.patience // FRAMES + 1))
    for message in skeletons(many, "my_sensor", 300, LEGS):
        publisher.put(message)
    told = (
        "tracker wedge: skeletons are 'my_sensor' and the model is 'simulated': poses are less sure"
    )
    status = eventually(
        "the trouble",
        lambda: (s := rig.done("status", "--config", rig.config).stdout) and told in s and s,
    )
    assert sum("my_sensor" in line for line in status.splitlines()) == 1
    for message in skeletons(joints, "simulated", 900):
        publisher.put(message)
    eventually("well again", lambda: rig.health("wedge")["troubles"] == [])
