"""Golf and tennis: swings as fast and as even as people's, beside measured ones."""

from functools import cache

import numpy as np
import pytest
from inhand_lab.geometry.transforms import Transform
from inhand_lab.motions.performance import ContactKind
from inhand_lab.objects.golf_club import SOLE
from inhand_lab.objects.racket import TIP
from inhand_lab.people.body_motion import BodyMotion
from inhand_lab.people.kinematics import place_body
from inhand_lab.people.person import sample_person
from inhand_lab.world.interactions import INTERACTIONS
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array, Bytes
from real_data import DATA
from scipy.spatial.transform import Rotation

MEASURED = DATA / "motion"
RATE = 240
PARTICIPANTS = range(6)
PERSON_FROM_MEASURED = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


@cache
def swung(interaction: str, participant: int) -> tuple[BodyMotion, Transform, Bytes]:
    """BodyMotion, world_from_object and contact over 12 s at 240 Hz."""
    person = sample_person(20, participant)
    times = np.arange(0.0, 12.0, 1.0 / RATE)
    random = np.random.default_rng([20, participant])
    done = INTERACTIONS[interaction].perform(person, times, random)
    body = place_body(person, done.posture, done.right_hand, done.left_hand)
    return body, done.world_from_object, done.contact


def speeds(points: Array) -> Array:
    """(T,) metres a second of points (T, 3)."""
    return np.asarray(np.linalg.norm(np.gradient(points, axis=0), axis=1) * RATE)


def turning(rotation: Array) -> Array:
    """(T - 1,) radians a second."""
    between = np.swapaxes(rotation[:-1], 1, 2) @ rotation[1:]
    return np.asarray(np.linalg.norm(Rotation.from_matrix(between).as_rotvec(), axis=1) * RATE)


def chest_turn(joints: Array) -> Array:
    """Turn (T,) of the shoulders to the left, degrees, from joints (T, 20, 3)."""
    across = joints[:, Joint.SHOULDER_RIGHT] - joints[:, Joint.SHOULDER_LEFT]
    return np.asarray(np.degrees(np.unwrap(np.arctan2(across[:, 1], across[:, 0]))))


def judged(joints: Array, head: Array) -> dict[str, float]:
    """Figures of one swing from joints (T, 20, 3) and the way (T, 3) of the club's head."""
    hands = 0.5 * (joints[:, Joint.HAND_RIGHT] + joints[:, Joint.HAND_LEFT])
    impact = int(speeds(head).argmax())
    earliest = impact - int(0.48 * RATE)
    top = earliest + int(speeds(hands)[earliest : impact - int(0.12 * RATE)].argmin())
    start = int(np.flatnonzero(speeds(head)[: top - int(0.35 * RATE)] < 0.6)[-1])
    turn = chest_turn(joints)
    return {
        "backswing": (top - start) / RATE,
        "downswing": (impact - top) / RATE,
        "head speed": float(speeds(head).max()),
        "hand speed": float(speeds(hands)[start:].max()),
        "chest at top": float(turn[top] - turn[start]),
        "chest at end": float(turn[min(impact + int(0.45 * RATE), len(turn) - 1)] - turn[start]),
    }


@cache
def simulated_swings(participant: int) -> list[dict[str, float]]:
    """Figures of every golf swing of a participant: the club is fastest once in each."""
    body, club, _ = swung("hitGolfBall", participant)
    head = club.apply(np.array([0.0, 0.03, SOLE + 0.02]))
    fast = np.flatnonzero(speeds(head) > 0.6 * speeds(head).max())
    hits = np.split(fast, np.flatnonzero(np.diff(fast) > RATE) + 1)
    windows = [slice(hit[0] - int(1.5 * RATE), hit[-1] + int(0.6 * RATE)) for hit in hits]
    return [judged(body.joints[window], head[window]) for window in windows]


@pytest.mark.parametrize("interaction", ["hitGolfBall", "hitTennisBall"])
@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_a_swing_is_even_at_a_high_rate(interaction: str, participant: int) -> None:
    body, carried, _ = swung(interaction, participant)
    assert np.linalg.norm(np.diff(body.joints, axis=0), axis=2).max() < 0.07
    assert np.linalg.norm(np.diff(carried.translation, axis=0), axis=1).max() < 0.07
    assert np.degrees(turning(carried.rotation).max() / RATE) < 20.0


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_a_golf_swing_goes_back_slowly_and_down_fast(participant: int) -> None:
    for swing in simulated_swings(participant):
        assert 1.5 < swing["backswing"] / swing["downswing"] < 4.0
        assert 20.0 < swing["head speed"] < 50.0
        assert 5.0 < swing["hand speed"] < 14.0
        assert -110.0 < swing["chest at top"] < -60.0
        assert swing["chest at end"] > 90.0


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_club_starts_at_the_ball_on_the_floor(participant: int) -> None:
    _, club, contact = swung("hitGolfBall", participant)
    sole = club.apply(np.array([0.0, 0.03, SOLE]))
    hit = int(speeds(sole).argmax())
    before = slice(hit - 3 * RATE // 2, hit - RATE // 2)
    assert (contact[before] == ContactKind.BOTH_HANDS).all()
    address = before.start + int(sole[before, 2].argmin())
    assert -0.005 < sole[address, 2] < 0.06
    assert sole[address, 1] > 0.35


@pytest.mark.skipif(
    not MEASURED.is_dir(), reason="the measured swings (../shared/data/motion) are not here"
)
def test_golf_swings_are_like_measured_ones() -> None:
    measured = []
    for path in sorted(MEASURED.glob("golf_*.npz")):
        with np.load(path) as recorded:
            joints = recorded["joints"].astype(float) @ PERSON_FROM_MEASURED.T
            pose, marks = recorded["object_pose"], recorded["vertices"].astype(float)
        rotation = Rotation.from_quat(pose[:, 3:], scalar_first=True).as_matrix()
        club = Transform(pose[:, :3] @ PERSON_FROM_MEASURED.T, PERSON_FROM_MEASURED @ rotation)
        measured.append(judged(joints, club.apply(marks[3:].mean(axis=0))))
    simulated = [swing for number in PARTICIPANTS for swing in simulated_swings(number)]
    for name, ratios in {
        "backswing": (0.75, 1.35),
        "downswing": (0.85, 1.45),
        "head speed": (0.6, 1.1),
        "hand speed": (0.7, 1.15),
        "chest at top": (0.8, 1.1),
        "chest at end": (0.85, 1.1),
    }.items():
        real, ours = (float(np.mean([s[name] for s in swings])) for swings in (measured, simulated))
        assert ratios[0] < ours / real < ratios[1], name


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_tennis_strokes_go_from_low_behind_to_high_ahead(participant: int) -> None:
    body, racket, _ = swung("hitTennisBall", participant)
    tip = racket.apply(np.array([0.0, 0.0, TIP]))
    hips = body.joints[:, Joint.HIP_CENTER]
    hits = np.flatnonzero(speeds(tip) > 0.7 * speeds(tip).max())
    assert speeds(tip).max() > 6.0
    for hit in np.split(hits, np.flatnonzero(np.diff(hits) > RATE) + 1):
        around = slice(hit[0] - int(0.4 * RATE), hit[-1] + int(0.4 * RATE))
        height, ahead = tip[around, 2] - hips[around, 2], tip[around, 1] - hips[around, 1]
        assert height.min() < 0.05
        assert ahead.min() < -0.1
        assert ahead.max() > 0.5
        assert height.argmin() < ahead.argmax()
        assert height[-1] > 0.5


def test_wrists_are_laid_back_differently_between_people_and_strokes() -> None:
    furthest = []
    for participant in PARTICIPANTS:
        body, racket, _ = swung("hitTennisBall", participant)
        forearm = body.joints[:, Joint.WRIST_RIGHT] - body.joints[:, Joint.ELBOW_RIGHT]
        forearm /= np.linalg.norm(forearm, axis=1, keepdims=True)
        behind = racket.translation[:, 1] < body.joints[:, Joint.HIP_CENTER, 1]
        along = np.sum(forearm * racket.rotation[:, :, 2], axis=1)[behind]
        furthest.append(np.degrees(np.arccos(along.min())))
    assert np.ptp(furthest) > 15.0
