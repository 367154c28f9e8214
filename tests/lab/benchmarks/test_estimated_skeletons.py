"""The check of skeletons from images, by a network that knows the truth."""

from collections.abc import Sequence

import numpy as np
import pytest
from inhand_capture.estimation.found_person import FoundPerson
from inhand_lab.benchmarks.estimated_skeletons import are_exchanged, check_skeletons
from inhand_lab.benchmarks.parameters import SkeletonCheckParameters
from inhand_schemas.joints import MIRRORED_JOINTS
from numpy.typing import NDArray
from posed_person import standing


class Blind:
    """Finds nobody."""

    def find(self, colour: NDArray[np.uint8]) -> Sequence[FoundPerson]:
        """Find nobody."""
        return []


def test_sides_are_exchanged_where_left_lies_on_the_right() -> None:
    joints = standing()
    assert not are_exchanged(joints, joints)
    assert are_exchanged(joints[np.array(MIRRORED_JOINTS)], joints)


@pytest.mark.long
def test_who_is_not_found_counts_as_missing_in_every_action() -> None:
    recordings: list[None] = []
    shown = SkeletonCheckParameters(people=1, frames=2, first_frame=0)
    check = check_skeletons(Blind, lambda: recordings.append(None), parameters=shown)
    assert len(recordings) == len(check.actions) == 15
    assert {(one.frames, one.found, one.ids) for one in check.actions} == {(2, 0.0, 0.0)}
    assert {one.missing for one in check.rules.values()} == {1.0}
