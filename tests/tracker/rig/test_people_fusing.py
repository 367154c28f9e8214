"""People of several cameras become one each, with numbers that stay."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_schemas.joints import MIRRORED_JOINTS
from inhand_tracker.rig.people_fusing import PeopleFuser, person_message
from inhand_tracker.rig.person_track import FusedPerson
from inhand_tracker.rig.sightings import CameraPeople
from people import FRAME_NS
from rig_people import PLACES, person_seen, standing_at

MIRRORED = list(MIRRORED_JOINTS)


def frames(count: int) -> list[int]:
    return [FRAME_NS * (number + 1) for number in range(count)]


def seen_by(camera: str, time_ns: int, *people: np.ndarray, first_id: int = 0) -> CameraPeople:
    place = PLACES[camera]
    return CameraPeople(
        camera,
        time_ns,
        [person_seen(joints, place, first_id + one) for one, joints in enumerate(people)],
    )


def fused_once(
    *cameras: str, fuser: PeopleFuser | None = None, time_ns: int = FRAME_NS
) -> list[FusedPerson]:
    fuser = fuser or PeopleFuser(PLACES)
    return fuser.fuse([seen_by(one, time_ns, standing_at(0.0)) for one in cameras], time_ns)


def test_one_person_before_three_cameras_is_one() -> None:
    (person,) = fused_once(*PLACES)
    assert person.joints == pytest.approx(standing_at(0.0), abs=1e-6)
    message = person_message(person)
    assert message.states == ("tracked",) * 20
    assert min(message.confidences) == pytest.approx(0.9)


def test_noise_of_three_cameras_is_less_than_that_of_one() -> None:
    random = np.random.default_rng(1)
    fuser, errors, alone = PeopleFuser(PLACES), [], []
    for time_ns in frames(60):
        noisy = {camera: standing_at(0.0) + random.normal(0.0, 0.02, (20, 3)) for camera in PLACES}
        (person,) = fuser.fuse([seen_by(one, time_ns, noisy[one]) for one in noisy], time_ns)
        errors.append(np.linalg.norm(person.joints - standing_at(0.0), axis=1))
        alone.append(np.linalg.norm(noisy["front"] - standing_at(0.0), axis=1))
    assert np.mean(errors) < 0.65 * np.mean(alone)


def test_who_leaves_one_cameras_view_for_anothers_is_the_same_person() -> None:
    fuser, numbers = PeopleFuser(PLACES), set()
    for index, time_ns in enumerate(frames(90)):
        joints = standing_at(0.02 * index)
        cameras = ["left"] if index < 40 else ["left", "front"] if index < 50 else ["front"]
        seen = [seen_by(one, time_ns, joints, first_id=index % 7) for one in cameras]
        numbers |= {person.identity for person in fuser.fuse(seen, time_ns)}
    assert len(numbers) == 1


def test_two_who_pass_each_other_keep_their_numbers_whatever_cameras_call_them() -> None:
    fuser, where = PeopleFuser(PLACES), {}
    for index, time_ns in enumerate(frames(100)):
        way = 0.02 * (index - 50)
        both = standing_at(way), standing_at(-way, 0.35)
        seen = [seen_by("front", time_ns, *both), seen_by("left", time_ns, *both[::-1])]
        if index % 20 > 15:
            seen = seen[:1]
        people = fuser.fuse(seen, time_ns)
        assert len(people) == 2
        for person in people:
            where.setdefault(person.identity, []).append(person.joints[0, 0])
    assert sorted(where) == [0, 1]
    assert all(np.abs(np.diff(way)).max() < 0.1 for way in where.values())


def test_a_camera_that_sees_the_back_and_reads_it_as_a_front_changes_no_side() -> None:
    fuser = PeopleFuser(PLACES)
    for time_ns in frames(30):
        swapped = standing_at(0.0)[MIRRORED]
        seen = [
            seen_by("front", time_ns, standing_at(0.0)),
            seen_by("left", time_ns, standing_at(0.0)),
            seen_by("right", time_ns, swapped),
        ]
        (person,) = fuser.fuse(seen, time_ns)
        assert person.joints == pytest.approx(standing_at(0.0), abs=1e-3)


def test_who_was_first_read_the_wrong_way_round_is_put_right_by_the_others() -> None:
    fuser = PeopleFuser(PLACES)
    for time_ns in frames(10):
        fuser.fuse([seen_by("right", time_ns, standing_at(0.0)[MIRRORED])], time_ns)
    for time_ns in frames(60)[10:]:
        seen = [seen_by(one, time_ns, standing_at(0.0)) for one in ("front", "left")]
        (person,) = fuser.fuse(seen, time_ns)
    assert person.joints == pytest.approx(standing_at(0.0), abs=1e-3)


def test_what_cameras_see_earlier_is_moved_to_the_time_of_the_whole() -> None:
    fuser, speed = PeopleFuser(PLACES), 1.5
    early_ns = FRAME_NS // 2
    for time_ns in frames(30):
        now, then = (standing_at(speed * at / 1e9) for at in (time_ns, time_ns - early_ns))
        seen = [seen_by("front", time_ns, now), seen_by("left", time_ns - early_ns, then)]
        (person,) = fuser.fuse(seen, time_ns)
    assert np.abs(person.joints - now).max() < 0.5 * speed * early_ns / 1e9 / 2


def test_who_was_seen_as_two_by_two_cameras_becomes_one_again() -> None:
    fuser = PeopleFuser(PLACES)
    for index, time_ns in enumerate(frames(60)):
        off = 0.6 if index < 5 else 0.05
        seen = [
            seen_by("front", time_ns, standing_at(0.0)),
            seen_by("left", time_ns, standing_at(off)),
        ]
        people = fuser.fuse(seen, time_ns)
        if index < 5:
            assert len(people) == 2
    assert [person.identity for person in people] == [0]


def test_a_camera_that_somebody_bumped_is_left_out_and_back_once_it_agrees() -> None:
    off = np.array([0.14, 0.0, 0.0])
    fuser, random = PeopleFuser(PLACES), np.random.default_rng(2)
    for index, time_ns in enumerate(frames(600)):
        way = np.array([0.3 * np.sin(0.05 * index), 0.0, 0.0])
        true = standing_at(0.0) + way
        seen = []
        for camera in PLACES:
            noisy = true + random.normal(0.0, 0.02, (20, 3))
            if camera == "left" and 150 <= index < 350:
                noisy = noisy + off
            seen.append(seen_by(camera, time_ns, noisy))
        (person,) = fuser.fuse(seen, time_ns)
        if index in (149, 599):
            assert not fuser.left_out
        if index == 349:
            assert fuser.left_out == {"left": pytest.approx(0.14, abs=0.03)}
        if 250 <= index < 350:
            assert np.linalg.norm(np.mean(person.joints - true, axis=0)) < 0.02


def test_of_two_cameras_that_disagree_the_first_is_believed() -> None:
    two = {camera: PLACES[camera] for camera in ("front", "left")}
    fuser = PeopleFuser(two)
    for time_ns in frames(200):
        seen = [
            seen_by("front", time_ns, standing_at(0.0)),
            seen_by("left", time_ns, standing_at(0.14)),
        ]
        (person,) = fuser.fuse(seen, time_ns)
    assert list(fuser.left_out) == ["left"]
    assert person.joints == pytest.approx(standing_at(0.0), abs=1e-6)


def test_joints_that_no_camera_sees_are_missing_and_inferred_ones_count_less() -> None:
    states = ["tracked"] * 20
    states[11] = "missing"
    front = replace(
        seen_by("front", FRAME_NS),
        people=[person_seen(standing_at(0.0), PLACES["front"], states=states)],
    )
    states = ["inferred"] * 20
    states[11] = "missing"
    left = replace(
        seen_by("left", FRAME_NS),
        people=[person_seen(standing_at(0.06), PLACES["left"], states=states)],
    )
    (person,) = PeopleFuser(PLACES).fuse([front, left], FRAME_NS)
    message = person_message(person)
    assert message.states == (*["tracked"] * 11, "missing", *["tracked"] * 8)
    off = person.joints[:11] - standing_at(0.0)[:11]
    assert np.abs(off).max() < 0.02


def test_nobody_is_nobody() -> None:
    assert PeopleFuser(PLACES).fuse([seen_by("front", FRAME_NS)], FRAME_NS) == []
    assert PeopleFuser(PLACES).fuse([], FRAME_NS) == []
