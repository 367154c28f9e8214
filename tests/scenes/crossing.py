"""Two simulated people who walk past each other before one camera, each with an object.

They are two simulations, moved sideways through the room. While one hides the other, the hidden one
is not seen, and a camera that tells people by where they are may give each the other's id.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from inhand_lab.world.messages import person_message
from inhand_lab.world.simulation import simulate
from inhand_schemas.messages import Person
from inhand_tracker.geometry.arrays import Array

INTERACTIONS = ("drinkFromMug", "answerPhone")
FRAME_RATE = 30.0
HALF_WAY_M = 1.0
BEHIND_M = (0.45, 0.9)
"""How far one passes behind the other."""
HIDDEN_M = 0.25
"""So near to each other in the image's plane, the one behind is not seen."""


@dataclass(frozen=True)
class CrossingFrame:
    """``people`` as the camera tells them; ``who`` is the true person (0 or 1) of each."""

    time_ns: int
    people: tuple[Person, ...]
    who: tuple[int, ...]


def cross(seed: int, frames: int = 240) -> Iterator[CrossingFrame]:
    """Frames of person 0, with a mug, and person 1, with a phone, who cross once.

    Every second seed's camera exchanges their ids where they pass.
    """
    random = np.random.default_rng([seed, 0xC705])
    simulations = [simulate(name, n, seed, frames) for n, name in enumerate(INTERACTIONS)]
    share = np.clip((np.arange(frames) - 0.2 * frames) / (0.6 * frames), 0.0, 1.0)
    along = HALF_WAY_M * (2.0 * share - 1.0)
    behind = int(random.integers(2))
    depth = random.uniform(*BEHIND_M)
    exchanged = False
    for frame in range(frames):
        offsets = [np.array([side * along[frame], 0.0, 0.0]) for side in (1.0, -1.0)]
        offsets[behind][2] = depth
        met = abs(2.0 * along[frame]) < HIDDEN_M
        if met and seed % 2 == 1:
            exchanged = True
        people, who = [], []
        for number, simulation in enumerate(simulations):
            if met and number == behind:
                continue
            told = person_message(simulation, frame)
            shift = offsets[number] - _start(simulation.joints_in_camera)
            camera_id = 1 - number if exchanged else number
            people.append(_moved(told, shift, camera_id))
            who.append(number)
        if random.random() < 0.5:
            people.reverse()
            who.reverse()
        time_ns = round((frame + 1) * 1e9 / FRAME_RATE)
        yield CrossingFrame(time_ns, tuple(people), tuple(who))


def _start(joints: Array) -> Array:
    """Takes the hips' first place to x = 0, and leaves height and distance."""
    return np.array([joints[0, 0, 0], 0.0, joints[0, 0, 2] - 3.0])


def _moved(person: Person, shift: Array, camera_id: int) -> Person:
    joints = [tuple((np.array(joint) + shift).tolist()) for joint in person.joints]
    seen = [
        joint if state != "missing" else (0.0, 0.0, 0.0)
        for joint, state in zip(joints, person.states, strict=True)
    ]
    return Person(
        id=camera_id, joints=tuple(seen), states=person.states, confidences=person.confidences
    )
