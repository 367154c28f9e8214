"""One message of each type with every field filled."""

import math

from inhand_schemas.messages import (
    Box,
    CameraInfo,
    ColourImage,
    DepthImage,
    Event,
    Health,
    Latency,
    Message,
    ObjectPose,
    Person,
    Pose,
    Preview,
    RecordingState,
    RgbdFrame,
    Skeletons,
    TopicHealth,
)
from msgspec.structs import replace

TIME_NS = 1_753_000_000_123_456_789
POSE = Pose((0.125, -0.25, 1.5), (math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0))
PERSON = Person(
    id=3,
    joints=tuple((0.25 * joint, -0.5, 2.0) for joint in range(20)),
    states=("missing", "inferred", *["tracked"] * 18),
    confidences=(0.0, 0.5, *[1.0] * 18),
)

RUNNING = Health(
    sequence=0,
    time_ns=1,
    service="tracker",
    instance="mug",
    state="running",
    uptime_s=1.0,
    resident_bytes=1,
)
"""What an instance says of itself that has nothing to tell."""

RECORDING = RecordingState(
    file="rig_20261129T201800Z.mcap",
    file_bytes=1 << 20,
    ring_seconds=29.5,
    ring_bytes=1 << 27,
    clip="rig_20261129T201801Z.mcap",
    folder_bytes=1 << 33,
    free_bytes=1 << 34,
    deleted=3,
)
EXAMPLES: tuple[Message, ...] = (
    CameraInfo(
        sequence=1,
        time_ns=TIME_NS,
        width=640,
        height=480,
        fx=575.5,
        fy=576.25,
        cx=319.5,
        cy=239.5,
        distortion=(0.1, -0.05, 0.0, 0.0, 0.01),
        depth_scale=0.001,
        frame_rate=30.0,
        has_colour=True,
        has_depth=False,
        rig_from_camera=POSE,
        description="über dem Tisch",
    ),
    RgbdFrame(
        sequence=2**40,
        time_ns=TIME_NS,
        time_uncertainty_ns=500_000,
        colour=ColourImage("jpeg", 640, 480, b"\xff\xd8\xff\xe0 pixels \xff\xd9"),
        depth=DepthImage("z16", 2, 1, b"\x00\x04\xff\xff"),
    ),
    Preview(sequence=4, time_ns=TIME_NS, width=160, height=120, jpeg=b"\xff\xd8\xff\xd9"),
    Skeletons(sequence=5, time_ns=TIME_NS, people=(PERSON,), convention="kinect_v1"),
    ObjectPose(
        sequence=6,
        time_ns=TIME_NS,
        object="mug",
        camera="kitchen",
        state="tracked",
        confidence=0.875,
        person=3,
        camera_from_object=POSE,
        rig_from_object=POSE,
        covariance=tuple(float(i // 6 == i % 6) for i in range(36)),
        box=Box(10.5, 20.25, 30.0, 40.0),
        class_probabilities={"mug": 0.75, "glasses": 0.25},
        visible_fraction=0.75,
        contact="right_hand",
        person_joints=PERSON.joints,
    ),
    Event(
        sequence=7,
        time_ns=TIME_NS,
        kind="drank",
        object="mug",
        person=3,
        duration_ns=2_500_000_000,
        evidence={"tilt": 0.5, "height": 1.25},
        description="drank from the mug",
        id="5d1c0a7c8a1b4f0e9d2c3b4a",
        probability=0.875,
        amounts={"volume_ml": 20.5},
        deviations={"volume_ml": 8.0},
        rig_from_object=POSE,
        first_sequence=101,
        last_sequence=176,
    ),
    Health(
        sequence=8,
        time_ns=TIME_NS,
        service="tracker",
        instance="tracker_1",
        state="running",
        uptime_s=12.5,
        resident_bytes=200_000_000,
        topics={
            "inhand/@v1/rig/rgbd/kitchen": TopicHealth(
                published=1, received=360, dropped=2, malformed=3, rate_hz=30.0, lost=4, late_ms=7.5
            )
        },
        latency_ms=Latency(p50=12.5, p99=40.0),
        last_error="none yet",
        troubles=("no camera info of kitchen yet",),
        loop_age_s=0.25,
        effort=0.75,
        shutter_closed=True,
        recording=RECORDING,
        paused=True,
    ),
)
LATE = replace(
    next(message for message in EXAMPLES if isinstance(message, Health)),
    sequence=10,
    topics={"inhand/@v1/rig/rgbd/kitchen": TopicHealth(received=360, late_ms=7.5)},
    effort=0.75,
    recording=None,
)
SHUT = replace(LATE, service="capture", effort=None, shutter_closed=True)
PAUSED = replace(
    LATE,
    service="recorder",
    effort=None,
    recording=RecordingState(paused=True, file="rig_20261129T201800Z.mcap", file_bytes=1 << 20),
)
KEEPING = replace(
    PAUSED,
    recording=RECORDING,
)
UNMEASURED = replace(LATE, service="outcomes", instance="home", effort=None, paused=True)
UNMANAGED = replace(
    PAUSED,
    recording=RecordingState(
        folder_bytes=1 << 33, unmanaged=2, unmanaged_bytes=1 << 32, clips_bytes=1 << 31
    ),
)
REFUSED = replace(LATE, topics={"(other keys)": TopicHealth(refused=12)})

PNG = RgbdFrame(
    sequence=11,
    time_ns=TIME_NS,
    depth=DepthImage(
        "png16",
        3,
        2,
        bytes.fromhex(
            "89504e470d0a1a0a0000000d4948445200000003000000021000000000e88fe58500000015494441"
            "54081d63000246160686ffff398f30b003000da802d8049bb0850000000049454e44ae426082"
        ),
    ),
)
TRUTH = ObjectPose(
    sequence=9,
    time_ns=TIME_NS,
    object="mug",
    camera="kitchen",
    state="tracked",
    confidence=1.0,
    person=3,
    camera_from_object=POSE,
    visible_fraction=0.75,
    contact="right_hand",
    person_joints=PERSON.joints,
)

NAMED = Skeletons(sequence=12, time_ns=TIME_NS, people=(PERSON,), convention="azure_kinect")

GOLDEN_MESSAGES: dict[str, Message] = {
    **{f"{type(message).__name__}.v1": message for message in EXAMPLES},
    "Event.v1.sip": next(one for one in EXAMPLES if isinstance(one, Event)),
    "Health.v1.keeping": KEEPING,
    "Health.v1.unmeasured": UNMEASURED,
    "Health.v1.late": LATE,
    "Health.v1.paused": PAUSED,
    "Health.v1.refused": REFUSED,
    "Health.v1.shutter": SHUT,
    "Health.v1.unmanaged": UNMANAGED,
    "ObjectPose.v1.truth": TRUTH,
    "RgbdFrame.v1.png": PNG,
    "Skeletons.v1.convention": NAMED,
}
"""By the stem of their golden files: one of each type, and one more for fields it grew by."""
