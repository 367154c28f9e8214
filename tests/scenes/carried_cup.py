"""Somebody who carries a cup about, as the messages of a tracker and a camera."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_outcomes.thing import Thing
from inhand_schemas.joints import Joint
from inhand_schemas.messages import ObjectPose, Person, Pose, Skeletons
from numpy.typing import NDArray

RATE_HZ = 30.0
START_NS = 1_700_000_000_000_000_000
CUP = Thing(
    "cup",
    "",
    0.04 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float),
    np.zeros((0, 3), np.int64),
)
COVARIANCE = tuple((1e-4 * np.eye(6)).ravel().tolist())
# In a level camera's frame: x right, y down, z forward.
TABLE, ELSEWHERE, CHEST, SIDE = (
    np.array(place)
    for place in ([0.4, 0.2, 2.0], [0.1, 0.2, 2.3], [0.1, -0.2, 2.1], [0.3, 0.5, 1.7])
)


@dataclass(frozen=True)
class Carrying:
    """A cup that a person takes from a table at 2 s and puts down elsewhere at 6 s, of 9 s."""

    person: int = 0
    start_ns: int = START_NS
    name: str = "cup"

    def messages(self, until_s: float = 9.0) -> Iterator[tuple[Skeletons, ObjectPose]]:
        """The frames in order: who is seen, and where the cup is."""
        times = np.arange(0.0, until_s, 1.0 / RATE_HZ)
        cups = through(times, (2.0, TABLE), (3.0, CHEST), (5.0, CHEST), (6.0, ELSEWHERE))
        knots = (
            (1.0, SIDE),
            (2.0, TABLE),
            (3.0, CHEST),
            (5.0, CHEST),
            (6.0, ELSEWHERE),
            (7.0, SIDE),
        )
        hands = through(times, *knots)
        for number, (second, cup, hand) in enumerate(zip(times, cups, hands, strict=True)):
            time_ns = self.start_ns + round(second * 1e9)
            yield (
                Skeletons(sequence=number, time_ns=time_ns, people=(a_person(self.person, hand),)),
                a_pose(self.name, number, time_ns, self.person, cup),
            )


def through(
    times: NDArray[np.float64], *knots: tuple[float, NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Places (T, 3) on straight ways between places at times."""
    at = [time for time, _ in knots]
    return np.stack(
        [np.interp(times, at, [place[axis] for _, place in knots]) for axis in range(3)], axis=1
    )


def a_person(number: int, right_hand: Sequence[float] | NDArray[np.float64]) -> Person:
    """A person who stands before the camera with the right hand there."""
    joints = [(0.0, 0.2, 2.5)] * 20
    joints[Joint.HEAD] = (0.0, -0.6, 2.5)
    joints[Joint.HAND_LEFT] = (-0.4, 0.4, 2.4)
    x, y, z = (float(one) for one in right_hand)
    joints[Joint.HAND_RIGHT] = (x, y, z)
    for foot in (Joint.FOOT_LEFT, Joint.FOOT_RIGHT, Joint.ANKLE_LEFT, Joint.ANKLE_RIGHT):
        joints[foot] = (0.0, 1.1, 2.5)
    return Person(
        id=number, joints=tuple(joints), states=("tracked",) * 20, confidences=(0.9,) * 20
    )


def a_pose(
    name: str, number: int, time_ns: int, person: int | None, place: NDArray[np.float64]
) -> ObjectPose:
    """A tracked pose of an object that stands upright."""
    x, y, z = place.tolist()
    return ObjectPose(
        sequence=number,
        time_ns=time_ns,
        object=name,
        camera="front",
        state="tracked",
        confidence=0.9,
        person=person,
        camera_from_object=Pose((x, y, z), (1.0, 0.0, 0.0, 0.0)),
        covariance=COVARIANCE,
        class_probabilities={name: 0.9},
    )


def write_model(path: Path, interaction: str = "carryCup", name: str = CUP.name) -> Path:
    """Write as much of a model of the cup, or of one like it, as tells its mesh."""
    said = json.dumps({"object": name, "interaction": interaction})
    faces = np.zeros((1, 3), np.int64)
    arrays = {"model": np.array(said), "shape.vertices": CUP.vertices, "shape.faces": faces}
    with path.open("wb") as file:
        np.savez(file, **arrays)
    return path
