"""What detectors give: boxes, (..., 4), of a middle and a size, and scores."""

import numpy as np
from numpy.typing import NDArray

from inhand_capture.estimation.found_person import Floats

MOST_LOGIT = 100.0


def scores_of(logits: NDArray[np.float32]) -> Floats:
    """Return scores from 0 to 1 of a network's logits."""
    bounded = np.clip(logits.astype(float), -MOST_LOGIT, MOST_LOGIT)
    scores: Floats = 1.0 / (1.0 + np.exp(-bounded))
    return scores


def overlap(boxes: Floats, box: Floats) -> Floats:
    """Return the shared over the joint area of boxes (..., 4), each with one (4,)."""
    low = np.maximum(boxes[..., :2] - 0.5 * boxes[..., 2:], box[:2] - 0.5 * box[2:])
    high = np.minimum(boxes[..., :2] + 0.5 * boxes[..., 2:], box[:2] + 0.5 * box[2:])
    shared = np.clip(high - low, 0.0, None).prod(axis=-1)
    joint = boxes[..., 2:].prod(axis=-1) + box[2:].prod() - shared
    shares: Floats = shared / np.maximum(joint, 1e-12)
    return shares
