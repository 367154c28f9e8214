"""Which picture is shown, and which people and objects with it."""

import numpy as np
from examples import POSE as PLACE
from inhand_runtime.pixels import encode_colour
from inhand_schemas.messages import ObjectPose, RgbdFrame, Skeletons
from inhand_studio.live_page.moment import moment_of
from inhand_studio.live_page.parameters import DEFAULT_LIVE
from inhand_studio.picture import Picture
from inhand_studio.rig import CameraNews

FRAME_NS = 33_000_000
NOW_S = 100.0


def _time_ns(sequence: int) -> int:
    return 10**18 + FRAME_NS * sequence


def _picture(sequence: int) -> Picture:
    colour = encode_colour(np.zeros((2, 2, 3), np.uint8))
    frame = RgbdFrame(sequence=sequence, time_ns=_time_ns(sequence), colour=colour)
    return Picture(frame, NOW_S)


def _pose(sequence: int, person: int = 0, name: str = "mug") -> ObjectPose:
    return ObjectPose(
        sequence=sequence,
        time_ns=_time_ns(sequence),
        object=name,
        camera="front",
        state="tracked",
        confidence=1.0,
        person=person,
        camera_from_object=PLACE,
    )


def _people(sequence: int) -> Skeletons:
    return Skeletons(sequence=sequence, time_ns=_time_ns(sequence))


def _news(pictures: range, poses: list[ObjectPose], poses_at: float = NOW_S) -> CameraNews:
    return CameraNews(
        tuple(map(_picture, pictures)),
        tuple(map(_people, pictures)),
        tuple(poses),
        NOW_S,
        poses_at if poses else None,
    )


def test_a_picture_waits_for_its_poses_and_is_shown_with_them_and_its_people() -> None:
    moment = moment_of(_news(range(5), [_pose(1), _pose(2)]), NOW_S, DEFAULT_LIVE)
    assert moment.picture is not None
    assert moment.picture.sequence == 2
    assert moment.people is not None
    assert moment.people.sequence == 2
    assert [pose.sequence for pose in moment.objects] == [2]


def test_pictures_go_on_where_no_poses_come_or_they_have_stopped() -> None:
    stopped = _news(range(5), [_pose(1)], NOW_S - 2.0 * DEFAULT_LIVE.poses_missed_s)
    for news in (_news(range(5), []), stopped):
        moment = moment_of(news, NOW_S, DEFAULT_LIVE)
        assert moment.picture is not None
        assert moment.picture.sequence == 4


def test_pictures_of_a_camera_that_began_anew_are_shown_though_poses_have_old_numbers() -> None:
    moment = moment_of(_news(range(3), [_pose(900)]), NOW_S, DEFAULT_LIVE)
    assert moment.picture is not None
    assert moment.picture.sequence == 2
    assert moment.objects == ()


def test_one_object_of_two_people_and_two_objects_of_one_are_all_shown() -> None:
    poses = [_pose(1), _pose(1, person=1), _pose(1, name="jug"), _pose(0, name="jug")]
    shown = moment_of(_news(range(2), poses), NOW_S, DEFAULT_LIVE).objects
    assert [(one.object, one.person) for one in shown[-2:]] == [("mug", 0), ("mug", 1)]
    assert shown[0].object == "jug"


def test_a_pose_that_is_long_past_is_no_longer_drawn() -> None:
    old = 2 * DEFAULT_LIVE.hold_ns // FRAME_NS
    assert moment_of(_news(range(old, old + 2), [_pose(0)]), NOW_S, DEFAULT_LIVE).objects == ()
