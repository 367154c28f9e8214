"""Random numbers of a simulated world, and the versions that they depend on."""

from __future__ import annotations

import zlib

import numpy as np

GENERATOR_VERSION = 6
"""Version of the generator: the same version and seed make the same bytes."""
PEOPLE_VERSION = 4
"""Version whose people and movements these are: what a version leaves alone stays the same."""


def random_stream(
    seed: int, participant: int, interaction: str, purpose: str, *more: int
) -> np.random.Generator:
    """A stream of its own for every purpose, so that none depends on how much another draws."""
    named = zlib.crc32(f"{interaction}/{purpose}".encode())
    return np.random.default_rng([PEOPLE_VERSION, seed, participant, named, *more])
