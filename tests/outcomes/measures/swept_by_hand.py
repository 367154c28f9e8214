"""A broom whose head goes to and fro, moved by hand."""

import numpy as np
from hand_made import moved, thing, track
from scipy.spatial.transform import Rotation

BROOM = thing(
    "broom", ([-0.15, -0.03, -0.7], [0.15, 0.03, -0.6]), ([-0.01, -0.01, -0.6], [0.01, 0.01, 0.7])
)


def broom(*, strokes=5, lift=0.07, rate=30.0, turn=0.0, start=1.0, base=0.0, seed=0):
    """A broom, wide along y, that sweeps 0.5 m along x and is lifted on its way back.

    A stroke takes 0.8 s, the way back 0.6 s, and 0.2 s of rest follow.
    """
    times = np.arange(0.0, start + 1.6 * strokes + 3.0, 1.0 / rate)
    keys, high = [(0.0, 0.0)], np.zeros(len(times))
    for number in range(strokes):
        begin = start + 1.6 * number
        keys += [(begin, 0.0), (begin + 0.8, 0.5), (begin + 1.4, 0.0)]
        share = np.clip((times - begin - 0.8) / 0.6, 0.0, 1.0)
        high += lift * 4.0 * share * (1.0 - share)
    along = moved(times, keys)[:, 0]
    head = np.stack([along, np.full(len(times), 2.0), base + high], axis=1)
    around = Rotation.from_euler("z", turn)
    noise = np.random.default_rng(seed).normal(0.0, 0.004, head.shape)
    positions = around.apply(head + noise + np.array([0.0, 0.0, 0.7]))
    wide = around * Rotation.from_euler("z", 0.5 * np.pi)
    return track(times, positions, Rotation.concatenate([wide] * len(times)))
