"""The limbs of a body: chains of joints from the trunk outwards."""

import numpy as np
from inhand_schemas.joints import Joint

SHOULDERS = (Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT)
HIPS = (Joint.HIP_LEFT, Joint.HIP_RIGHT)
TRUNK_ENDS = (*SHOULDERS, *HIPS)
"""Joints that every network knows, and from which those of the trunk are derived."""
DERIVED = (Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER)

LIMBS = tuple(
    np.array([Joint[f"{name}_{side}"] for name in names])
    for side in ("LEFT", "RIGHT")
    for names in (("SHOULDER", "ELBOW", "WRIST", "HAND"), ("HIP", "KNEE", "ANKLE", "FOOT"))
)
"""Joints of arms and legs, each from the trunk outwards."""
HANDS_AND_FEET = tuple(Joint(int(limb[-1])) for limb in LIMBS)
"""The ends of limbs, which some networks do not know."""
