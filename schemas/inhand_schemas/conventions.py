"""Conventions of skeletons, by name: whose joints they are, and so where each lies in a body.

What one tracker calls the spine, or the end of a hand, lies elsewhere in the same body than another
one's. ``Skeletons.convention`` names the source's; a source that is not listed here gives its own a
name of its own, of small letters, digits and underscores, and keeps it.
"""

SIMULATED = "simulated"
"""The simulated world's, which is the canonical body: what other conventions are mapped to."""
KINECT_V1 = "kinect_v1"
"""Kinect for Xbox 360 and for Windows, as in UTD-MHAD."""
KINECT_V2 = "kinect_v2"
"""Kinect for Xbox One, as in NTU RGB+D."""
AZURE_KINECT = "azure_kinect"
"""Azure Kinect Body Tracking."""
ZED = "zed"
"""ZED's BODY_34."""
COCO = "coco"
"""Seventeen key points of COCO, in space."""
BLAZEPOSE = "blazepose"
"""BlazePose's landmarks, lifted by depth (``skeletons = "estimated"``)."""
