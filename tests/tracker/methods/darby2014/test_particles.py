from dataclasses import replace

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from inhand_tracker.body.skeleton import Bases
from inhand_tracker.geometry.weights import systematic_resample
from inhand_tracker.mapping.body_pose_index import BodyPoseIndex
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014, Darby2014Parameters
from inhand_tracker.methods.darby2014.particles import (
    Particles,
    draw,
    mixing_fractions,
    propagate,
    redraw,
)
from inhand_tracker.methods.darby2014.variants import VARIANTS
from people import quaternion_of, same_rotation
from scipy.spatial.transform import Rotation
from scipy.stats import norm

COUNT = 20_000
HAND = 10
STARTS = np.array([0, 100, 130])


def make_mapping(rotation_variation: float = 0.0, translation_variation: float = 0.0) -> Mapping:
    """Two sequences of 100 and 30 frames; in the first, ten frames each share a body pose."""
    random = np.random.default_rng(0)
    poses = np.zeros((130, 60))
    poses[:100, 0] = np.arange(100) // 10
    poses[100:, 0] = 1000 + np.arange(30)
    turns = Rotation.from_rotvec(random.normal(size=(130 * 19, 3)))
    return Mapping(
        participants=("p0", "p1"),
        starts=STARTS,
        radii=np.array([0.5, 0.5]),
        body_poses=poses,
        translations=random.normal(size=(130, 19, 3)),
        rotations=quaternion_of(turns).reshape(130, 19, 4),
        translation_variation=np.full(130, translation_variation),
        rotation_variation=np.full(130, rotation_variation),
        stable_translation_part=np.arange(130) % 19,
        stable_rotation_part=(np.arange(130) + 5) % 19,
        proximate_part=(np.arange(130) + 11) % 19,
    )


def all_at(frame: int, count: int = COUNT) -> Particles:
    return Particles(*(np.full(count, value) for value in (frame, frame, 3, 4)))


def advancing(frames: float) -> Darby2014Parameters:
    return replace(DEFAULT_DARBY2014, advance=frames)


def walked(frame: int, advance: float, seed: int = 0) -> Particles:
    return propagate(all_at(frame), make_mapping(), np.random.default_rng(seed), advancing(advance))


@pytest.mark.parametrize("advance", [0.0, 1.0])
def test_frames_walk_by_the_advance_with_unit_variance(advance: float) -> None:
    moved = walked(50, advance)
    for frames in (moved.translation_frames, moved.rotation_frames):
        # Rounding adds 1/12 to the variance; standard errors are 0.007 and 0.011.
        assert frames.mean() == pytest.approx(50 + advance, abs=0.04)
        assert frames.var() == pytest.approx(1.0 + 1 / 12, abs=0.06)
        expected = norm.cdf(0.5 - advance) - norm.cdf(-0.5 - advance)
        assert np.mean(frames == 50) == pytest.approx(expected, abs=0.02)


def test_translation_and_rotation_walk_independently() -> None:
    moved = walked(50, 1.0)
    steps = np.corrcoef(moved.translation_frames, moved.rotation_frames)
    assert abs(steps[0, 1]) < 0.04


def test_the_walk_is_one_frame_on_by_default() -> None:
    moved = propagate(all_at(50), make_mapping(), np.random.default_rng(0))
    assert moved.rotation_frames.mean() == pytest.approx(51.0, abs=0.04)


@pytest.mark.parametrize("first", [0, 100])
def test_the_walk_is_reflected_at_the_start_of_its_sequence(first: int) -> None:
    frames = walked(first, 0.0).translation_frames - first
    # round|N(0, 1)|: below 0.5 gives 0, between 0.5 and 1.5 gives 1, on both sides.
    assert np.mean(frames == 0) == pytest.approx(2 * (norm.cdf(0.5) - 0.5), abs=0.015)
    assert np.mean(frames == 1) == pytest.approx(2 * (norm.cdf(1.5) - norm.cdf(0.5)), abs=0.015)
    assert frames.min() == 0


@pytest.mark.parametrize("last", [99, 129])
def test_the_walk_stops_at_the_end_of_its_sequence(last: int) -> None:
    frames = walked(last, 1.0).rotation_frames
    assert frames.max() == last
    assert np.mean(frames == last) == pytest.approx(1 - norm.cdf(-1.5), abs=0.015)


@given(
    st.lists(st.integers(0, 129), min_size=1, max_size=30), st.floats(-50, 50), st.integers(0, 99)
)
def test_the_walk_never_leaves_its_sequence(frames: list[int], advance: float, seed: int) -> None:
    start = np.array(frames)
    particles = Particles(start, start[::-1], start % 19, start % 7)
    moved = propagate(particles, make_mapping(), np.random.default_rng(seed), advancing(advance))
    for before, after in (
        (particles.translation_frames, moved.translation_frames),
        (particles.rotation_frames, moved.rotation_frames),
    ):
        np.testing.assert_array_equal(before < 100, after < 100)
        assert after.min() >= 0
        assert after.max() < 130
        assert np.issubdtype(after.dtype, np.integer)
    np.testing.assert_array_equal(moved.translation_parts, particles.translation_parts)
    np.testing.assert_array_equal(moved.rotation_parts, particles.rotation_parts)


@pytest.mark.parametrize(
    ("rotation", "translation", "alpha", "beta"),
    [
        (0.0, 0.0, 1.0, 1.0),
        # σ² = π/16 = 0.19635: exp(-0.25 / 0.3927) and exp(-0.01 / 0.2).
        (0.5, 0.1, 0.529077, 0.951229),
        # one σ each
        (np.sqrt(np.pi) / 4, np.sqrt(0.1), 0.606531, 0.606531),
        (1e6, 1e6, 0.0, 0.0),
    ],
)
def test_mixing_fractions_by_hand(
    rotation: float, translation: float, alpha: float, beta: float
) -> None:
    fractions = mixing_fractions(make_mapping(rotation, translation), 7)
    assert fractions == pytest.approx((alpha, beta), abs=1e-6)


def test_the_variation_of_the_nearest_frame_counts() -> None:
    mapping = make_mapping()
    mapping.rotation_variation[7] = 0.5
    mapping.translation_variation[8] = 0.1
    assert mixing_fractions(mapping, 7) == pytest.approx((0.529077, 1.0), abs=1e-6)
    assert mixing_fractions(mapping, 8) == pytest.approx((1.0, 0.951229), abs=1e-6)


NEAREST = 34
CLUSTER = list(range(30, 40))


def drawn(name: str, seed: int = 0) -> Particles:
    mapping = make_mapping()
    return draw(
        COUNT, mapping, BodyPoseIndex(mapping), NEAREST, VARIANTS[name], np.random.default_rng(seed)
    )


@pytest.mark.parametrize("name", VARIANTS)
def test_frames_are_drawn_evenly_from_the_cluster(name: str) -> None:
    particles = drawn(name)
    for frames in (particles.translation_frames, particles.rotation_frames):
        values, counts = np.unique(frames, return_counts=True)
        assert values.tolist() == CLUSTER
        # 2000 are expected of each, ± 42.
        assert np.abs(counts - COUNT / 10).max() < 210
    together = np.histogram2d(particles.translation_frames, particles.rotation_frames, bins=10)[0]
    assert np.abs(together - COUNT / 100).max() < 75


@pytest.mark.parametrize(
    ("name", "translation_part", "rotation_part"),
    [
        ("g-hand", HAND, HAND),
        ("gd-hand", HAND, HAND),
        ("gd-stable", 34 % 19, (34 + 5) % 19),
        ("gd-stable-proximate", (34 + 11) % 19, (34 + 5) % 19),
    ],
)
def test_parts_are_drawn_by_the_method(
    name: str, translation_part: int, rotation_part: int
) -> None:
    particles = drawn(name)
    assert set(particles.translation_parts.tolist()) == {translation_part}
    assert set(particles.rotation_parts.tolist()) == {rotation_part}


def test_random_parts_are_drawn_evenly_and_independently() -> None:
    particles = drawn("gd-random")
    for parts in (particles.translation_parts, particles.rotation_parts):
        values, counts = np.unique(parts, return_counts=True)
        assert values.tolist() == list(range(19))
        assert np.abs(counts - COUNT / 19).max() < 160
    agree = np.mean(particles.translation_parts == particles.rotation_parts)
    assert agree == pytest.approx(1 / 19, abs=0.01)


# φᶿ and φᵉ that give α = 0.3 and β = 0.8.
PHI_R = float(np.sqrt(-2 * np.pi / 16 * np.log(0.3)))
PHI_T = float(np.sqrt(-2 * 0.1 * np.log(0.8)))


def redrawn(name: str) -> Particles:
    """Particles of the other sequence after a discriminative step."""
    mapping = make_mapping(PHI_R, PHI_T)
    random = np.random.default_rng(1)
    particles = replace(all_at(120), translation_parts=np.full(COUNT, 18))
    particles = replace(particles, rotation_parts=np.full(COUNT, 17))
    return redraw(particles, drawn(name), mixing_fractions(mapping, NEAREST), random)


def test_alpha_and_beta_are_the_shares_that_are_redrawn_independently() -> None:
    particles = redrawn("gd-stable-proximate")
    turned = particles.rotation_frames < 100
    moved = particles.translation_frames < 100
    assert turned.mean() == pytest.approx(0.3, abs=0.015)
    assert moved.mean() == pytest.approx(0.8, abs=0.015)
    assert (turned & moved).mean() == pytest.approx(0.24, abs=0.015)


def test_what_is_redrawn_takes_frame_and_part_together_and_the_rest_stays() -> None:
    particles = redrawn("gd-stable-proximate")
    turned = particles.rotation_frames < 100
    moved = particles.translation_frames < 100
    assert set(particles.rotation_frames[turned].tolist()) == set(CLUSTER)
    assert set(particles.rotation_parts[turned].tolist()) == {(34 + 5) % 19}
    assert set(particles.rotation_frames[~turned].tolist()) == {120}
    assert set(particles.rotation_parts[~turned].tolist()) == {17}
    assert set(particles.translation_parts[moved].tolist()) == {(34 + 11) % 19}
    assert set(particles.translation_frames[~moved].tolist()) == {120}
    assert set(particles.translation_parts[~moved].tolist()) == {18}


@pytest.mark.parametrize(("variation", "share"), [(0.0, 1.0), (1e3, 0.0)])
def test_sure_moments_redraw_all_and_doubtful_ones_none(variation: float, share: float) -> None:
    fractions = mixing_fractions(make_mapping(variation, variation), NEAREST)
    particles = redraw(all_at(120), drawn("gd-hand"), fractions, np.random.default_rng(2))
    assert np.mean(particles.rotation_frames < 100) == share
    assert np.mean(particles.translation_frames < 100) == share


def test_particles_are_taken_whole() -> None:
    random = np.random.default_rng(3)
    particles = Particles(*random.integers(0, 19, (4, 8)))
    rows = np.column_stack(
        (
            particles.translation_frames,
            particles.rotation_frames,
            particles.translation_parts,
            particles.rotation_parts,
        )
    )
    taken = particles.take(np.array([5, 5, 0]))
    np.testing.assert_array_equal(taken.translation_frames, rows[[5, 5, 0], 0])
    np.testing.assert_array_equal(taken.rotation_frames, rows[[5, 5, 0], 1])
    np.testing.assert_array_equal(taken.translation_parts, rows[[5, 5, 0], 2])
    np.testing.assert_array_equal(taken.rotation_parts, rows[[5, 5, 0], 3])


def test_a_particle_s_pose_is_its_frames_in_its_parts_with_the_height() -> None:
    random = np.random.default_rng(4)
    mapping = make_mapping()
    origins = random.normal(size=(19, 3))
    turns = Rotation.from_rotvec(random.normal(size=(19, 3)))
    particles = Particles(
        random.integers(0, 130, 6),
        random.integers(0, 130, 6),
        random.integers(0, 19, 6),
        random.integers(0, 19, 6),
    )
    bases = Bases(origins, quaternion_of(turns))
    translations, orientations = particles.poses(mapping, bases, 1.6)
    for p in range(6):
        part, frame = particles.translation_parts[p], particles.translation_frames[p]
        place = turns[part].apply(1.6 * mapping.translations[frame, part]) + origins[part]
        np.testing.assert_allclose(translations[p], place, atol=1e-12)
        part, frame = particles.rotation_parts[p], particles.rotation_frames[p]
        inner = Rotation.from_quat(mapping.rotations[frame, part], scalar_first=True)
        assert same_rotation(orientations[p], quaternion_of(turns[part] * inner))


def test_one_particle_is_enough() -> None:
    mapping = make_mapping()
    random = np.random.default_rng(6)
    index = BodyPoseIndex(mapping)
    one = draw(1, mapping, index, NEAREST, VARIANTS["gd-random"], random)
    one = one.take(systematic_resample(np.ones(1), random))
    one = redraw(propagate(one, mapping, random), one, (0.5, 0.5), random)
    assert one.translation_frames.shape == (1,)
