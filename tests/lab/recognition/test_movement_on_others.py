import numpy as np
from inhand_lab.recognition.movement_on_others import KnownFrames, still_frames, together
from inhand_schemas.joints import Joint
from people import STANDING


def test_somebody_is_still_until_an_arm_has_moved() -> None:
    joints = np.repeat(STANDING[None], 6, axis=0)
    joints[1] += 0.5
    joints[2] = np.nan
    joints[4, Joint.WRIST_LEFT] += 0.2
    assert list(still_frames(joints)) == [True, True, True, True, False, False]
    assert still_frames(np.full((3, 20, 3), np.nan)).all()


def test_counts_of_a_kind_add_up() -> None:
    one = KnownFrames("taught", "hammerNail", 100, 60, 10, 20, 1)
    other = KnownFrames("taught", "liftWeights", 100, 20, 0, 5, 0)
    assert together([one, other]) == KnownFrames("taught", "all", 200, 80, 10, 25, 1)
    assert together([one, other]).percent == (40.0, 5.0, 4.0)
