"""Two bones and the joint between them."""

import numpy as np
import pytest
from inhand_lab.people.parameters import DEFAULT_LIMITS
from inhand_lab.people.two_bones import bend_towards, span

UPPER, LOWER = 0.30, 0.25
ROOT = np.zeros((3, 3))
TIP = np.array([[0.4, 0.1, 0.0], [2.0, 0.0, 0.0], [0.0, 0.01, 0.0]])
"""A tip within reach, one too far and one too near."""


def test_every_place_on_the_circle_keeps_both_bones() -> None:
    circle, reached = bend_towards(ROOT, TIP, (UPPER, LOWER), np.radians(172.0))
    across = np.cross(circle.axis, [0.0, 0.0, 1.0])
    middle = circle.centre + circle.radius[:, None] * across
    assert np.linalg.norm(middle - ROOT, axis=1) == pytest.approx(UPPER)
    assert np.linalg.norm(reached - middle, axis=1) == pytest.approx(LOWER)


def test_a_tip_is_reached_or_brought_to_the_limits() -> None:
    _, reached = bend_towards(ROOT, TIP, (UPPER, LOWER), np.radians(172.0))
    assert reached[0] == pytest.approx(TIP[0])
    distances = np.linalg.norm(reached - ROOT, axis=1)
    assert distances[1] == pytest.approx(span(UPPER, LOWER, np.radians(172.0)))
    assert distances[2] == pytest.approx(span(UPPER, LOWER, DEFAULT_LIMITS.flexion))
