"""What a picture and its skeletons lack."""

import numpy as np
import pytest
from inhand_lab.new_recordings.view_checks import people_lacks, picture_lacks
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, Person, RgbdFrame, Skeletons
from posed_person import standing

INFO = CameraInfo(
    sequence=0, time_ns=0, width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5
)
BRIGHT = encode_colour(np.full((48, 64, 3), 120, np.uint8))
DARK = encode_colour(np.full((48, 64, 3), 10, np.uint8))
ROOM = encode_depth(np.full((48, 64), 2000, np.uint16))
NOTHING = encode_depth(np.zeros((48, 64), np.uint16))


def _kinds(**images: object) -> list[str]:
    frame = RgbdFrame(sequence=0, time_ns=0, **images)  # type: ignore[arg-type]
    return [lack.kind for lack in picture_lacks(frame)]


def _person(right_hand: tuple[float, float, float] | None = (0.1, 0.0, 2.0)) -> Person:
    joints = np.nan_to_num(standing())
    states = ["tracked"] * 20
    joints[Joint.HAND_LEFT] = (-0.2, 0.0, 2.0)
    if right_hand is None:
        states[Joint.HAND_RIGHT] = "missing"
    else:
        joints[Joint.HAND_RIGHT] = right_hand
    return Person(
        id=1,
        joints=tuple(map(tuple, joints.tolist())),
        states=tuple(states),  # type: ignore[arg-type]
        confidences=(1.0,) * 20,
    )


def _people(*people: Person) -> list[str]:
    return [
        lack.text for lack in people_lacks(Skeletons(sequence=0, time_ns=0, people=people), INFO)
    ]


def test_a_bright_picture_with_depth_lacks_nothing_and_each_other_one_says_what() -> None:
    assert _kinds(colour=BRIGHT, depth=ROOM) == []
    assert _kinds(colour=DARK, depth=ROOM) == ["light"]
    assert _kinds(colour=BRIGHT, depth=NOTHING) == ["depth"]
    assert _kinds(colour=BRIGHT) == ["depth"]
    assert _kinds(depth=ROOM) == ["colour"]


def test_one_person_whose_hands_are_seen_lacks_nothing_and_nobody_and_two_do() -> None:
    assert _people(_person()) == []
    assert _people() == ["Nobody is in view."]
    assert _people(_person(), _person()) == ["2 people are in view: only one should be."]


@pytest.mark.parametrize(
    ("hand", "said"),
    [
        (None, "is not seen"),
        ((1.2, 0.0, 2.0), "at the edge"),
        ((0.0, -0.9, 2.0), "at the edge"),
        ((1.5, 0.0, 2.0), "out of the picture"),
        ((0.0, 0.0, -1.0), "out of the picture"),
    ],
)
def test_a_hand_that_is_unseen_at_the_edge_or_outside_is_named(
    hand: tuple[float, float, float] | None, said: str
) -> None:
    (text,) = _people(_person(hand))
    assert text.startswith("The right hand")
    assert said in text
