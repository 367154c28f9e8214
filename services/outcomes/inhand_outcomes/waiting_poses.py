"""Poses that came before the skeletons of their frame, as two streams may."""

from inhand_schemas.messages import ObjectPose


class WaitingPoses:
    """Poses in order, by camera, until the people of their frame have come, or of a later one.

    At most ``most`` wait: where no skeletons come at all, the oldest go on without.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._poses: list[ObjectPose] = []

    def put(self, message: ObjectPose) -> list[ObjectPose]:
        """Let a pose wait; those that wait no longer."""
        self._poses.append(message)
        gone = max(len(self._poses) - self._most, 0)
        taken, self._poses = self._poses[:gone], self._poses[gone:]
        return taken

    def take(self, camera: str, time_ns: int) -> list[ObjectPose]:
        """Take those whose people came with the frame of this time, or will come no more."""

        def is_due(pose: ObjectPose) -> bool:
            return pose.camera == camera and pose.time_ns <= time_ns

        taken = [pose for pose in self._poses if is_due(pose)]
        self._poses = [pose for pose in self._poses if not is_due(pose)]
        return taken

    def take_all(self) -> list[ObjectPose]:
        """Take all."""
        taken, self._poses = self._poses, []
        return taken
