"""Trackers that follow a body frame by frame, and what every pose of theirs must be."""

from collections.abc import Sequence

import numpy as np
import pytest
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.object_tracker import ObjectTracker
from people import FRAME_NS


def follow(
    tracker: ObjectTracker,
    joints: np.ndarray,
    seen: Sequence[Image | None] | None = None,
    first: int = 1,
) -> list[Estimate]:
    """The estimates of frames (T, 20, 3), the first of a number, with or without images."""
    given = [None] * len(joints) if seen is None else seen
    return [
        tracker.step(pose, (first + number) * FRAME_NS, image)
        for number, (pose, image) in enumerate(zip(joints, given, strict=True))
    ]


def assert_proper(estimate: Estimate) -> None:
    """A pose of finite numbers, a unit quaternion and a covariance that is one."""
    assert estimate.state == "tracked"
    assert 0.0 <= estimate.confidence <= 1.0
    assert np.isfinite(estimate.translation).all()
    assert np.linalg.norm(estimate.rotation) == pytest.approx(1.0)
    np.testing.assert_allclose(estimate.covariance, estimate.covariance.T, atol=1e-12)
    assert np.linalg.eigvalsh(estimate.covariance).min() > -1e-12
