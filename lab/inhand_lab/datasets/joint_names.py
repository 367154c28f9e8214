"""Names joints in sentences."""

from collections.abc import Sequence

from inhand_schemas.joints import JOINT_NAMES


def named_joints(joints: Sequence[int]) -> str:
    """Name joints, as ``KneeLeft, AnkleLeft``."""
    return ", ".join(JOINT_NAMES[joint] for joint in joints)
