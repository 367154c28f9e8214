import numpy as np
import pytest
from inhand_tracker.mapping.body_pose_index import BodyPoseIndex
from inhand_tracker.mapping.mapping import Mapping, stretches
from inhand_tracker.mapping.parameters import DEFAULT_MAPPING
from inhand_tracker.mapping.pose_search import PoseSearch

LONGEST_STRETCH = DEFAULT_MAPPING.longest_stretch


def mapping_of(poses: list[np.ndarray], radii: list[float]) -> Mapping:
    """A mapping with only what is asked of body poses."""
    frames = sum(map(len, poses))
    ints, floats = np.zeros(frames, np.int64), np.zeros(frames)
    return Mapping(
        participants=tuple(f"p{i}" for i in range(len(poses))),
        starts=np.concatenate(([0], np.cumsum([len(p) for p in poses]))),
        radii=np.array(radii),
        body_poses=np.concatenate(poses),
        translations=np.zeros((frames, 19, 3)),
        rotations=np.tile([1.0, 0, 0, 0], (frames, 19, 1)),
        translation_variation=floats,
        rotation_variation=floats,
        stable_translation_part=ints,
        stable_rotation_part=ints,
        proximate_part=ints,
    )


def on_a_line(values: list[float]) -> np.ndarray:
    """Body poses that differ in one of 60 numbers."""
    poses = np.zeros((len(values), 60))
    poses[:, 17] = values
    return poses


LINE = mapping_of([on_a_line([0, 1, 2, 3, 1.2]), on_a_line([0, 1, 10])], [1.0, 0.5])


def test_frames_belong_to_the_sequence_between_its_starts() -> None:
    assert LINE.sequence_of(np.arange(8)).tolist() == [0] * 5 + [1] * 3


def test_the_nearest_frame_of_all_participants_is_found_with_its_distance() -> None:
    frame, distance = BodyPoseIndex(LINE).nearest(on_a_line([8.0])[0])
    assert frame == 7
    assert distance == pytest.approx(2.0)


def test_the_nearest_frame_is_the_one_of_a_search_through_all() -> None:
    random = np.random.default_rng(1)
    mapping = mapping_of([random.normal(size=(40, 60)), random.normal(size=(30, 60))], [1, 1])
    index = BodyPoseIndex(mapping)
    for pose in random.normal(size=(20, 60)):
        distances = [float(np.sqrt(np.sum((pose - b) ** 2))) for b in mapping.body_poses]
        frame, distance = index.nearest(pose)
        assert frame == int(np.argmin(distances))
        assert distance == pytest.approx(min(distances))


@pytest.mark.parametrize(
    ("frame", "cluster"),
    [
        (0, [0, 1]),
        (1, [0, 1, 2, 4]),
        (2, [1, 2, 3, 4]),
        (3, [2, 3]),
        (4, [1, 2, 4]),
        (5, [5]),
        (7, [7]),
    ],
)
def test_a_cluster_is_the_frames_of_the_same_sequence_within_its_radius(
    frame: int, cluster: list[int]
) -> None:
    assert BodyPoseIndex(LINE).cluster(frame).tolist() == cluster


def test_a_frame_is_in_its_own_cluster_at_any_radius() -> None:
    mapping = mapping_of([on_a_line([0, 1]), on_a_line([5, 6])], [0.0, 0.0])
    assert BodyPoseIndex(mapping).cluster(3).tolist() == [3]


def test_body_poses_that_are_all_equal_are_one_cluster() -> None:
    mapping = mapping_of([np.ones((500, 60)), np.ones((20, 60))], [0.0, 0.0])
    index = BodyPoseIndex(mapping)
    assert index.cluster(501).tolist() == list(range(500, 520))
    frame, distance = index.nearest(np.ones(60))
    assert 0 <= frame < 520
    assert distance == 0.0


def walking(frames: int, seed: int = 0) -> np.ndarray:
    """Body poses of a slow walk through the 60 dimensions, with noise."""
    random = np.random.default_rng(seed)
    path = np.cumsum(random.normal(size=(frames, 6)), axis=0) / np.sqrt(frames)
    return path @ random.normal(size=(6, 60)) + 0.02 * random.normal(size=(frames, 60))


def test_a_sequence_of_up_to_2048_frames_is_one_stretch() -> None:
    assert stretches(1).tolist() == [0, 1]
    assert stretches(LONGEST_STRETCH).tolist() == [0, LONGEST_STRETCH]


@pytest.mark.parametrize("frames", [2049, 5000, 108_000])
def test_a_longer_sequence_is_cut_into_equal_stretches(frames: int) -> None:
    cuts = stretches(frames)
    lengths = np.diff(cuts)
    assert (cuts[0], cuts[-1]) == (0, frames)
    assert lengths.max() <= LONGEST_STRETCH
    assert lengths.max() - lengths.min() <= 1
    assert len(lengths) == -(-frames // LONGEST_STRETCH)


def test_a_cluster_does_not_leave_its_stretch() -> None:
    """A person who stands still for three stretches, after a recording of somebody else."""
    mapping = mapping_of([np.zeros((7, 60)), np.ones((3 * LONGEST_STRETCH, 60))], [0.1, 0.1])
    index = BodyPoseIndex(mapping)
    for stretch in range(3):
        first = 7 + stretch * LONGEST_STRETCH
        for frame in (first, first + LONGEST_STRETCH - 1):
            expected = np.arange(first, first + LONGEST_STRETCH)
            np.testing.assert_array_equal(index.cluster(frame), expected)


def test_no_nearest_pose_is_missed_while_all_lists_are_looked_through() -> None:
    count = DEFAULT_MAPPING.list_length * DEFAULT_MAPPING.probes // 4
    poses, asked = walking(count), walking(count, seed=1)[::400]
    frames, distances = PoseSearch(poses).nearest(asked)
    for pose, frame, distance in zip(asked, frames, distances, strict=True):
        all_distances = np.linalg.norm(poses - pose, axis=1)
        assert all_distances[frame] == pytest.approx(all_distances.min(), rel=1e-5)
        assert distance == pytest.approx(all_distances.min(), rel=1e-5)


def test_few_probes_find_a_pose_that_is_hardly_farther() -> None:
    poses, asked = walking(20_000), walking(20_000, seed=1)[::200]
    search = PoseSearch(poses)
    _, exact = search.nearest(asked)
    _, approximate = search.nearest(asked, probes=4)
    assert (approximate >= exact * (1.0 - 1e-6)).all()
    assert np.median(approximate) <= 1.02 * np.median(exact)


def test_a_search_is_the_same_whenever_it_is_made() -> None:
    poses, asked = walking(3000), walking(3000, seed=1)[::50]
    first, second = (PoseSearch(poses).nearest(asked, probes=2) for _ in range(2))
    np.testing.assert_array_equal(first, second)
