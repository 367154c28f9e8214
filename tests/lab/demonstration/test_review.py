"""What a review finds in a rig's recording."""

from pathlib import Path

import numpy as np
from inhand_lab.demonstration.review import FrameName, Traffic, review
from inhand_runtime.recording import RecordingWriter
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose, Pose
from inhand_schemas.topics import LABEL, POSE
from msgspec.structs import replace

VERTICES = np.array([[0.1, 0.0, 0.0], [0.0, 0.2, 0.0]])


def message(sequence: int, x: float | None) -> ObjectPose:
    return ObjectPose(
        sequence=sequence,
        time_ns=1_000_000 * sequence,
        object="mug",
        camera="camera",
        state="lost" if x is None else "tracked",
        confidence=0.5,
        camera_from_object=None if x is None else Pose((x, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0)),
    )


def test_poses_are_compared_with_the_labels_of_their_frames(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    labels = [message(sequence, 0.0) for sequence in range(3)]
    # Another camera's frames have the same numbers.
    labels += [replace(message(sequence, 0.7), camera="left") for sequence in range(3)]
    poses = [message(0, 0.01), message(1, None), message(2, 0.03), message(3, 0.5)]
    with RecordingWriter(path) as writer:
        for topic, messages in ((LABEL, labels), (POSE, poses)):
            for one in messages:
                writer.write(
                    topic.key(Site("home", "kitchen"), "mug"),
                    topic.encode(one),
                    received_ns=one.time_ns + 5_000_000,
                    captured_ns=one.time_ns,
                    sequence=one.sequence,
                )
    reviewed = review(path, "mug", VERTICES)
    assert [frame.sequence for frame in reviewed.frames] == [0, 2]
    np.testing.assert_allclose(reviewed.vertex_errors_m, [0.01, 0.03])
    np.testing.assert_allclose(reviewed.latencies_ms, np.full(4, 5.0))
    assert reviewed.traffic == {"label": Traffic(0, 6, 6, 0), "pose": Traffic(0, 4, 4, 0)}
    assert reviewed.poses[FrameName("camera", 3)] == poses[3]
