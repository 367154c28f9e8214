"""Checks skeletons from images on simulated people, whose joints are known."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from inhand_capture.estimation.body_lengths import BodyLengths
from inhand_capture.estimation.estimator import SkeletonEstimator
from inhand_capture.estimation.found_person import FoundPerson, PoseNetwork
from inhand_capture.estimation.lifting import DepthPicture, Lifter, lens_of
from inhand_runtime.pinhole import Pinhole
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Person
from inhand_tracker.geometry.arrays import Array, Bytes
from numpy.typing import NDArray

from inhand_lab.benchmarks.joint_distances import JointDistances, by_joint, summed_up
from inhand_lab.benchmarks.lifting_rules import RULES, kinect_joints
from inhand_lab.benchmarks.parameters import DEFAULT_SKELETON_CHECK, SkeletonCheckParameters
from inhand_lab.sensing.cameras import KINECT, Camera
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.messages import camera_info
from inhand_lab.world.simulation import simulate

OWN_RULE, FOLLOWED = "surfaces and lengths, one frame", "the same, followed and smoothed"


@dataclass(frozen=True)
class ActionCheck:
    """How one interaction's people were found.

    ``found`` and ``exchanged`` are shares of frames: with somebody in the person's place, and with
    left and right the wrong way round. ``ids`` is the number of ids that the people had, 1 each at
    the best.
    """

    interaction: str
    frames: int
    found: float
    exchanged: float
    ids: float
    distances: JointDistances


@dataclass(frozen=True)
class SkeletonCheck:
    """What skeletons from images are worth on simulated people, by action, joint and rule."""

    actions: tuple[ActionCheck, ...]
    joints: dict[str, JointDistances]
    rules: dict[str, JointDistances]


@dataclass
class _Tally:
    """What was found in the frames of one interaction."""

    distances: list[Array] = field(default_factory=list)
    exchanged: list[bool] = field(default_factory=list)
    ids: list[int] = field(default_factory=list)
    by_rule: dict[str, list[Array]] = field(default_factory=dict)


class Overheard:
    """A network whose people of the last picture can be asked for."""

    def __init__(self, network: PoseNetwork) -> None:
        self._network = network
        self.people: Sequence[FoundPerson] = ()

    def find(self, colour: NDArray[np.uint8]) -> Sequence[FoundPerson]:
        """Find the people in a picture, and keep them."""
        self.people = self._network.find(colour)
        return self.people


def check_steps(parameters: SkeletonCheckParameters = DEFAULT_SKELETON_CHECK) -> int:
    """Return the number of recordings that are looked at."""
    return len(INTERACTIONS) * parameters.people


def check_skeletons(
    new_network: Callable[[], PoseNetwork],
    on_recording: Callable[[], None],
    camera: Camera = KINECT,
    parameters: SkeletonCheckParameters = DEFAULT_SKELETON_CHECK,
) -> SkeletonCheck:
    """Estimate skeletons of people who do everything; ``on_recording`` hears of each recording."""
    actions, distances = [], []
    by_rule: dict[str, list[Array]] = {}
    for interaction in INTERACTIONS:
        tally = _Tally()
        for participant in range(parameters.people):
            _check_recording(
                interaction, participant, camera, Overheard(new_network()), tally, parameters
            )
            on_recording()
        actions.append(_summary(interaction, tally, parameters))
        distances += tally.distances
        for rule, found in tally.by_rule.items():
            by_rule.setdefault(rule, []).extend(found)
    rules = {rule: summed_up(np.array(found)) for rule, found in by_rule.items()}
    return SkeletonCheck(
        tuple(actions), by_joint(distances), {**rules, FOLLOWED: summed_up(np.array(distances))}
    )


def simulated_frames(
    interaction: str, participant: int, camera: Camera, parameters: SkeletonCheckParameters
) -> Iterator[tuple[Bytes, NDArray[np.uint16], Array]]:
    """The colour, depth and true joints (20, 3) of one recording's frames."""
    last = parameters.first_frame + parameters.frames
    simulation = simulate(interaction, participant, parameters.seed, last, camera)
    for frame in range(parameters.first_frame, last):
        seen = simulation.render(frame)
        yield seen.colour, seen.depth, simulation.true_joints_in_camera[frame]


def _check_recording(
    interaction: str,
    participant: int,
    camera: Camera,
    network: Overheard,
    tally: _Tally,
    parameters: SkeletonCheckParameters,
) -> None:
    """Estimate one recording's skeletons, and compare them with the true ones."""
    info = camera_info(camera.intrinsics, camera.frame_rate)
    lens = lens_of(info, camera.intrinsics.width, camera.intrinsics.height)
    estimator = SkeletonEstimator(network, info)
    ids: set[int] = set()
    frames = simulated_frames(interaction, participant, camera, parameters)
    for number, (colour, depth, truth) in enumerate(frames, 1):
        people = estimator.estimate(colour, depth, round(number * 1e9 / camera.frame_rate))
        person = _in_place(people, truth, parameters.in_place_m)
        if person is None:
            tally.distances.append(np.full(len(Joint), np.nan))
        else:
            joints = joints_of(person)
            tally.distances.append(np.linalg.norm(joints - truth, axis=1))
            tally.exchanged.append(are_exchanged(joints, truth))
            ids.add(person.id)
        picture = DepthPicture(depth, info.depth_scale)
        for one in network.people[:1]:
            for rule, joints in _by_rules(one, picture, lens).items():
                distances = np.linalg.norm(joints - truth, axis=1)
                tally.by_rule.setdefault(rule, []).append(distances)
    tally.ids.append(len(ids))


def _by_rules(person: FoundPerson, picture: DepthPicture, lens: Pinhole) -> dict[str, Array]:
    """Return one person's Kinect joints (20, 3) by each rule, as if it were the first frame."""
    placed = {name: kinect_joints(rule(person, picture, lens)) for name, rule in RULES.items()}
    lifter = Lifter(lens)
    surfaces = lifter.read(person, picture)
    unknown = np.full((len(Joint), 3), np.nan)
    lifted = surfaces and lifter.lift(person, surfaces, BodyLengths(), unknown)
    return {**placed, OWN_RULE: lifted.joints if lifted else unknown}


def joints_of(person: Person) -> Array:
    """Return a message's joints (20, 3), NaN where missing."""
    joints = np.array(person.joints)
    joints[[state == "missing" for state in person.states]] = np.nan
    return joints


def are_exchanged(joints: Array, truth: Array) -> bool:
    """Whether joints (20, 3) have their left where the true ones have their right."""
    sides = [Joint.SHOULDER_LEFT, Joint.HIP_LEFT], [Joint.SHOULDER_RIGHT, Joint.HIP_RIGHT]
    across, true_across = (j[sides[0]] - j[sides[1]] for j in (joints, truth))
    return float(np.nansum(across * true_across)) < 0.0


def _in_place(people: Sequence[Person], truth: Array, within: float) -> Person | None:
    """Return the person whose HipCenter is nearest to the true one; None where none is near."""
    hips = truth[Joint.HIP_CENTER]
    distances = [float(np.linalg.norm(joints_of(one)[Joint.HIP_CENTER] - hips)) for one in people]
    if not distances or min(distances) > within:
        return None
    return people[int(np.argmin(distances))]


def _summary(interaction: str, tally: _Tally, parameters: SkeletonCheckParameters) -> ActionCheck:
    frames = len(tally.distances)
    return ActionCheck(
        interaction=interaction,
        frames=frames,
        found=len(tally.exchanged) / frames,
        exchanged=sum(tally.exchanged) / frames,
        ids=sum(tally.ids) / parameters.people,
        distances=summed_up(np.array(tally.distances)),
    )
