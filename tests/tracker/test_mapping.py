import numpy as np
import pytest
from inhand_tracker.mapping import BodyPoseIndex, Mapping


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
