"""Acts that a watcher sees by windows that move on: once each, whole, with what was before."""

import numpy as np
import pytest
from cups import HEIGHT, MUG, RADIUS
from inhand_outcomes.measures.vessels import inside_of
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.room import LEVEL
from inhand_outcomes.rotations import multiply, of_matrix
from inhand_outcomes.thing import Thing
from inhand_outcomes.track import Track
from inhand_outcomes.watching import Watcher
from inhand_schemas.messages import ObjectPose, Person, Pose, Skeletons
from standing_person import HEAD, MOUTH, beside, frame_times, going, track_of, turns

START_NS = 1_700_000_000_000_000_000
CHEST = np.array([0.1, 0.35, 1.2])
PHONE = Thing(
    "phone",
    "phoning",
    np.array([[x, y, z] for x in (-0.04, 0.04) for y in (-0.005, 0.005) for z in (-0.08, 0.08)]),
    np.zeros((0, 3), np.int64),
)


def watched(track: Track, thing: Thing) -> list[Outcome]:
    """What a watcher says of a track, from its messages in the frame of a level camera."""
    watcher = Watcher({thing.name: thing}, "place")
    turn = LEVEL.matrix.T
    places, joints = track.positions @ turn.T, track.joints @ turn.T
    rotations = multiply(of_matrix(turn), track.poses[:, 3:])
    outcomes = []
    for frame, second in enumerate(track.times):
        time_ns = START_NS + round(second * 1e9)
        missing = np.isnan(joints[frame, :, 0])
        at = np.nan_to_num(joints[frame]).tolist()
        person = Person(
            id=1,
            joints=tuple((x, y, z) for x, y, z in at),
            states=tuple("missing" if one else "tracked" for one in missing),
            confidences=tuple(0.0 if one else 0.9 for one in missing),
        )
        outcomes += watcher.hear_skeletons(
            "front", Skeletons(sequence=frame, time_ns=time_ns, people=(person,))
        )
        (x, y, z), (w, i, j, k) = places[frame].tolist(), rotations[frame].tolist()
        outcomes += watcher.hear_pose(
            ObjectPose(
                sequence=frame,
                time_ns=time_ns,
                object=thing.name,
                camera="front",
                state="tracked",
                confidence=0.9,
                person=1,
                camera_from_object=Pose((x, y, z), (w, i, j, k)),
                covariance=tuple((1e-4 * np.eye(6)).ravel().tolist()),
            )
        )
    return outcomes + watcher.end_all()


def test_a_sip_long_after_another_takes_from_what_that_one_left() -> None:
    times = frame_times(95.0, 6.0)
    near, tilt = [(0.0, 0.0)], [(0.0, 0.0)]
    for start, deepest in ((2.0, 40.0), (86.0, 52.0)):
        near += [(start, 0.0), (start + 1.0, 1.0), (start + 3.0, 1.0), (start + 4.0, 0.0)]
        tilt += [(start + 1.0, 5.0), (start + 1.6, deepest), (start + 2.4, deepest)]
        tilt += [(start + 3.0, 5.0)]
    turned = turns("x", going(times, *tilt))
    lip = CHEST + going(times, *near)[:, None] * (MOUTH - CHEST)
    track = track_of(times, lip - turned.apply([0.0, -RADIUS, HEIGHT]), turned)
    sips = [one for one in watched(track, MUG) if one.kind == "sip"]
    assert len(sips) == 2
    inside = inside_of(MUG)
    assert inside is not None
    poured = inside.holds(np.radians(40.0)) - inside.holds(np.radians(52.0))
    assert [one.amounts["volume_ml"].value for one in sips] == [
        20.0,
        pytest.approx(poured, rel=0.2),
    ]


def test_a_call_that_outlasts_the_window_is_said_once_and_whole() -> None:
    times = frame_times(100.0, 6.0)
    ear = beside(HEAD, 0.09, 0.0, -0.02)
    way = going(times, (4.0, CHEST), (5.0, ear), (90.0, ear), (91.0, CHEST))
    calls = [one for one in watched(track_of(times, way), PHONE) if one.kind == "call"]
    assert len(calls) == 1
    assert calls[0].seconds == pytest.approx(85.5, abs=0.7)
    assert calls[0].amounts["duration_s"].value == pytest.approx(85.5, abs=0.7)
