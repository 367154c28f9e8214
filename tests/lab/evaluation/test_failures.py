"""What goes wrong with bodies in Darby et al. 2014, section 6.5, and how soon it is over.

Each failure is scripted into an unseen person's skeletons. Recovery is counted in frames from the
first right skeleton on, against the same tracker on the same person without the failure.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from inhand_lab.evaluation.vertex_error import vertex_error
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.messages import shape_of
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.joints import JOINT_NAMES
from inhand_tracker.body.skeleton import pelvis_basis
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.methods.darby2014.variants import VARIANTS
from inhand_tracker.methods.registry import FUSION, new_tracker
from inhand_tracker.model.model import Model
from inhand_tracker.prior.learning import learn_prior
from inhand_tracker.shape.viewpoints import Viewpoints

SEED = 3
FRAME_RATE = 15.0
FILMED = replace(KINECT, frame_rate=FRAME_RATE)
FRAME_NS = 66_666_667
PEOPLE = range(4)
STRANGER = 5
TOASTS = range(4, 8)
"""Seeds of people who learn and of a stranger who raises the mug: what is told is the median, for
where somebody reached for the mug with the arm raised, the mug is taken to lie on the table."""
ALL = [*VARIANTS, FUSION]
REINITIALISING = [name for name in ALL if name == FUSION or VARIANTS[name].reinitialises]
BEST = "gd-stable-proximate"
BEGIN, END = 75, 87  # the mug is being drunk from
RECOVERED_M = 0.04
CHI_SQUARE_90 = 10.645
"""Of six degrees of freedom."""
ALLOWED = dict.fromkeys(ALL, 0) | {"gd-random": 2}
"""Frames to recover; random parts scatter by themselves."""

Joints = np.ndarray
Failure = Callable[[Joints], Joints]


@cache
def drinking(participant: int, seed: int = SEED) -> Simulation:
    return simulate("drinkFromMug", participant, seed, 180, FILMED)


def skeletons(simulation: Simulation) -> Joints:
    joints = simulation.joints_in_camera.copy()
    joints[simulation.joint_states == 0] = np.nan
    return joints


def is_left_handed(simulation: Simulation) -> bool:
    return simulation.person.handedness == "left"


@cache
def mug_model(seed: int) -> Model:
    people = [drinking(participant, seed) for participant in PEOPLE]
    shape = shape_of(people[0].object_model)
    sequences = [
        LabelledSequence(
            f"p{one.participant}",
            is_left_handed(one),
            skeletons(one),
            one.translations,
            one.rotations,
            FRAME_RATE,
        )
        for one in people
    ]
    unseen = Viewpoints(np.eye(3), np.zeros((3, 1, 3)))
    return Model(
        "drinkFromMug",
        shape,
        learn(sequences, shape.mirror_normal),
        unseen,
        prior=learn_prior(sequences, shape),
    )


@dataclass(frozen=True)
class Run:
    """A tracker's estimates, and its vertex errors in metres (the last pose counts when lost)."""

    estimates: list[Estimate]
    errors: np.ndarray

    def frames_to_recover(self, usual: "Run", end: int) -> int:
        """Frames after ``end`` before the error is the usual one again."""
        return int(np.argmax(self.errors[end:] < usual.errors[end:] + RECOVERED_M))


def track(
    method: str,
    joints: Joints | list[Joints | None],
    truth: tuple[np.ndarray, np.ndarray],
    seed: int = SEED,
) -> Run:
    model = mug_model(seed)
    left_handed = is_left_handed(drinking(STRANGER, seed))
    tracker = new_tracker(model, method, left_handed=left_handed, terms=())
    estimates, errors, last = [], [], None
    for frame, body in enumerate(joints):
        estimate = tracker.step(body, (frame + 1) * FRAME_NS)
        if estimate.translation is not None:
            last = estimate.translation, estimate.rotation
        at = truth[0][frame], truth[1][frame]
        errors.append(float(vertex_error(last, at, model.shape.marked_vertices)))
        estimates.append(estimate)
    return Run(estimates, np.array(errors))


def true_mug(seed: int = SEED) -> tuple[np.ndarray, np.ndarray]:
    return drinking(STRANGER, seed).translations, drinking(STRANGER, seed).rotations


@cache
def usual(method: str, seed: int = SEED) -> Run:
    return track(method, skeletons(drinking(STRANGER, seed)), true_mug(seed), seed)


def hand_joint(name: str, seed: int = SEED) -> int:
    """The joint of the arm that drinks."""
    return JOINT_NAMES.index(
        name + ("Left" if is_left_handed(drinking(STRANGER, seed)) else "Right")
    )


def with_flipped_wrist(joints: Joints) -> Joints:
    """The forearm is seen 90° off, as in the paper's Fig. 8a."""
    joints = joints.copy()
    elbow = joints[BEGIN:END, hand_joint("Elbow")]
    forearm = joints[BEGIN:END, hand_joint("Wrist")] - elbow
    axis = np.cross(forearm, [0.0, 0.0, 1.0])
    turn = rotations.from_vector(0.5 * np.pi * axis / np.linalg.norm(axis, axis=1, keepdims=True))
    for joint in (hand_joint("Wrist"), hand_joint("Hand")):
        joints[BEGIN:END, joint] = elbow + rotations.rotate(turn, joints[BEGIN:END, joint] - elbow)
    return joints


def collapsed(joints: Joints) -> Joints:
    """All joints are seen within a heap: the body tracker has failed (Fig. 10a)."""
    joints = joints.copy()
    heap = np.random.default_rng(0).normal(size=(END - BEGIN, 20, 3))
    joints[BEGIN:END] = joints[BEGIN:END, :1] + 0.15 * heap
    return joints


def scattered(joints: Joints) -> Joints:
    """Every joint is seen a metre or so away from where it is."""
    joints = joints.copy()
    joints[BEGIN:END] += np.random.default_rng(0).normal(size=(END - BEGIN, 20, 3))
    return joints


def without_the_arm(joints: Joints) -> Joints:
    joints = joints.copy()
    joints[BEGIN:END, [hand_joint(name) for name in ("Elbow", "Wrist", "Hand")]] = np.nan
    return joints


def failing(method: str, failure: Failure) -> Run:
    return track(method, failure(skeletons(drinking(STRANGER))), true_mug())


def during(run: Run) -> float:
    return float(np.median(run.errors[BEGIN:END]))


def test_a_flipped_wrist_carries_the_estimate_away() -> None:
    assert during(failing(BEST, with_flipped_wrist)) > during(usual(BEST)) + 0.15


def test_random_parts_suffer_less_from_a_flipped_wrist_than_the_hand() -> None:
    by_hand, at_random = (
        during(failing(method, with_flipped_wrist)) for method in ("gd-hand", "gd-random")
    )
    assert at_random < 0.8 * by_hand


@pytest.mark.parametrize("method", REINITIALISING)
@pytest.mark.parametrize("failure", [with_flipped_wrist, without_the_arm, collapsed, scattered])
def test_the_object_is_back_with_the_first_right_skeleton(failure: Failure, method: str) -> None:
    frames = failing(method, failure).frames_to_recover(usual(method), END)
    # Scattered joints make the person seem 1 % taller; two learned poses are nearly as near here.
    tied = method == "gd-stable" and failure is scattered
    assert frames <= ALLOWED[method] + tied


@pytest.mark.parametrize("failure", [collapsed, scattered])
def test_a_body_that_is_wholly_wrong_misleads_while_it_lasts(failure: Failure) -> None:
    assert during(failing(BEST, failure)) > 0.30


@pytest.mark.parametrize("failure", [with_flipped_wrist, collapsed, scattered])
def test_fusion_is_less_sure_of_a_wrong_body_and_errs_less_than_the_paper_s_best(
    failure: Failure,
) -> None:
    run = failing(FUSION, failure)
    sure, usually_sure = (
        np.mean([estimate.confidence for estimate in one.estimates[BEGIN:END]])
        for one in (run, usual(FUSION))
    )
    assert sure < 0.9 * usually_sure
    assert during(run) < during(failing(BEST, failure))


@pytest.mark.parametrize("away", [12, 45])
@pytest.mark.parametrize("method", ALL)
def test_a_lost_body_s_object_is_predicted_then_lost_and_back_with_the_body(
    method: str, away: int
) -> None:
    """Away for 0.8 s and for 3 s; g-hand follows on without a fresh start after the shorter one."""
    back = BEGIN + away
    bodies: list[Joints | None] = list(skeletons(drinking(STRANGER)))
    bodies[BEGIN:back] = [None] * away
    run = track(method, bodies, true_mug())
    states = [estimate.state for estimate in run.estimates]
    assert states[BEGIN : BEGIN + 12] == ["predicted"] * 12
    assert set(states[BEGIN + 16 : back]) <= {"lost"}
    assert set(states[back:]) == {"tracked"}
    if method in REINITIALISING:
        assert run.frames_to_recover(usual(method), back) <= ALLOWED[method]


# --- Unusual use: a mug raised in a toast


def with_a_toast(seed: int) -> tuple[Joints, tuple[np.ndarray, np.ndarray]]:
    """The arm is raised high instead of to the mouth, and the mug with it, level (section 7)."""
    joints = skeletons(drinking(STRANGER, seed))
    places, turns = true_mug(seed)
    up = rotations.rotate(pelvis_basis(joints[BEGIN:END]).rotations, np.array([0.0, 1.0, 0.0]))
    hand = joints[BEGIN:END, hand_joint("Hand", seed)].copy()
    for name, height in (("Elbow", 0.28), ("Wrist", 0.53), ("Hand", 0.61)):
        joints[BEGIN:END, hand_joint(name, seed)] = (
            joints[BEGIN:END, hand_joint("Shoulder", seed)] + height * up
        )
    places = places.copy()
    places[BEGIN:END] += joints[BEGIN:END, hand_joint("Hand", seed)] - hand
    return joints, (places, turns)


@cache
def toasts(method: str) -> tuple[Run, ...]:
    return tuple(track(method, *with_a_toast(seed), seed) for seed in TOASTS)


def typical(method: str) -> float:
    return float(np.median([during(run) for run in toasts(method)]))


def test_in_a_toast_the_mug_stays_by_the_hand_and_random_parts_lose_it() -> None:
    assert typical(BEST) < 0.20
    assert typical("gd-random") > 2.0 * typical(BEST)


def test_in_a_toast_the_fallback_keeps_the_mug_by_the_hand_too() -> None:
    assert typical("gd-fallback") < 0.20


@pytest.mark.parametrize("method", [BEST, "gd-fallback", FUSION])
def test_after_a_toast_the_mug_is_back_at_once(method: str) -> None:
    for seed, run in zip(TOASTS, toasts(method), strict=True):
        assert run.frames_to_recover(usual(method, seed), END) == 0


def test_in_a_toast_fusion_takes_the_mug_along_with_the_hand_and_says_how_unsure_it_is() -> None:
    assert typical(FUSION) < 0.25
    within = []
    for seed, run in zip(TOASTS, toasts(FUSION), strict=True):
        places, turns = with_a_toast(seed)[1]
        told = run.estimates[BEGIN:END]
        assert np.median([estimate.confidence for estimate in told]) < 0.2
        for one, place, turn in zip(told, places[BEGIN:END], turns[BEGIN:END], strict=True):
            turned = rotations.multiply(one.rotation, rotations.conjugate(turn))
            off = np.concatenate((one.translation - place, rotations.to_vector(turned)))
            within.append(off @ np.linalg.solve(one.covariance, off) < CHI_SQUARE_90)
    assert np.mean(within) > 0.6


def test_usual_use_by_a_stranger_hardly_ever_falls_back() -> None:
    plain, fallback = usual(BEST), usual("gd-fallback")
    same = [
        np.array_equal(a.translation, b.translation)
        for a, b in zip(plain.estimates, fallback.estimates, strict=True)
    ]
    assert np.mean(same) > 0.9
    assert fallback.errors.mean() < plain.errors.mean() + 0.01
