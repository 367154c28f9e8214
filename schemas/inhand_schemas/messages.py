"""Every message, as plain MessagePack maps.

Lengths are metres, times integer nanoseconds since the epoch, quaternions unit and
(w, x, y, z), camera frames OpenCV's (x right, y down, z forward). Types only grow, by optional
fields, so that old recordings open for ever.
"""

import math
from typing import Annotated

import msgspec
from msgspec import Meta, Struct

from inhand_schemas.fields import (
    LONGEST_LENS,
    MOST_PEOPLE,
    UNIT_TOLERANCE,
    WIDEST_LENS,
    ColourCodec,
    Contact,
    Count,
    DepthCodec,
    Fraction,
    FractionOrNaN,
    JointState,
    Name,
    Nanoseconds,
    NonNegative,
    Pixels,
    PoseState,
    Positive,
    Quaternion,
    ServiceState,
    Text,
    Vector3,
    require_finite,
    require_pixels,
)


class Message(Struct, frozen=True, kw_only=True):
    """What every message on a stream shares."""

    sequence: Count
    time_ns: Nanoseconds


class Pose(Struct, frozen=True):
    """A rigid transform: ``x' = R(rotation) x + translation``."""

    translation: Vector3
    rotation: Quaternion

    def __post_init__(self) -> None:
        require_finite("pose", (*self.translation, *self.rotation))
        if abs(math.hypot(*self.rotation) - 1.0) > UNIT_TOLERANCE:
            raise ValueError("rotation is no unit quaternion")


class CameraInfo(Message, frozen=True, kw_only=True):
    """How a camera sees: pinhole intrinsics of its ``width`` × ``height`` image.

    Depth is aligned to the same view; an image of another size scales the intrinsics with it.
    """

    width: Pixels
    height: Pixels
    fx: Positive
    fy: Positive
    cx: float
    cy: float
    distortion: Annotated[tuple[float, ...], Meta(max_length=14)] = ()
    depth_scale: Positive = 0.001
    frame_rate: Positive = 30.0
    has_colour: bool = True
    has_depth: bool = True
    rig_from_camera: Pose = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    description: Text = ""

    def __post_init__(self) -> None:
        numbers = (self.fx, self.fy, self.cx, self.cy, self.depth_scale, self.frame_rate)
        require_finite("camera info", (*numbers, *self.distortion))
        require_pixels(self.width, self.height)
        size = max(self.width, self.height)
        if not all(
            WIDEST_LENS * size <= focal <= LONGEST_LENS * size for focal in (self.fx, self.fy)
        ):
            raise ValueError("no lens has this focal length: it is in pixels")
        if not all(abs(centre) <= LONGEST_LENS * size for centre in (self.cx, self.cy)):
            raise ValueError("the principal point is far from the image: it is in pixels")
        if not 1e-6 <= self.depth_scale <= 1.0:
            raise ValueError("the depth scale is in metres a unit, 0.001 for millimetres")
        if not 1e-3 <= self.frame_rate <= 1e4:
            raise ValueError("no camera has this frame rate")


class ColourImage(Struct, frozen=True, omit_defaults=True):
    """Colour pixels: ``jpeg``, or ``rgb8`` (rows of 3-byte RGB pixels).

    ``h264`` stands in recordings alone, and never on the wire: one picture in Annex B. It
    ``builds_on`` the picture before it, whose digest that is; one that begins anew has none. The
    digest of a picture is the lowest 63 bits of XXH3 of its data, with what it builds on, or 0, as
    the seed.
    """

    codec: ColourCodec
    width: Pixels
    height: Pixels
    data: bytes
    builds_on: Count | None = None

    def __post_init__(self) -> None:
        require_pixels(self.width, self.height)
        if self.builds_on is not None and self.codec != "h264":
            raise ValueError("only H.264 builds on another picture")
        if self.codec == "rgb8" and len(self.data) != 3 * self.width * self.height:
            raise ValueError("colour bytes do not fill the image")


class DepthImage(Struct, frozen=True):
    """Depth pixels, unsigned 16-bit, 0 = not measured: ``z16`` is little-endian, ``z16-zstd`` the
    same as Zstandard, and ``png16`` a PNG of one channel."""

    codec: DepthCodec
    width: Pixels
    height: Pixels
    data: bytes

    def __post_init__(self) -> None:
        require_pixels(self.width, self.height)
        if self.codec == "z16" and len(self.data) != 2 * self.width * self.height:
            raise ValueError("depth bytes do not fill the image")


class RgbdFrame(Message, frozen=True, kw_only=True):
    """One capture of a camera; ``time_ns`` is when it was exposed, ± the uncertainty."""

    time_uncertainty_ns: Nanoseconds = 0
    colour: ColourImage | None = None
    depth: DepthImage | None = None


class ViewedColour(ColourImage, frozen=True):
    """Colour whose ``data`` is a view of what it was decoded from."""

    data: memoryview  # type: ignore[assignment]


class ViewedDepth(DepthImage, frozen=True):
    """Depth whose ``data`` is a view of what it was decoded from."""

    data: memoryview  # type: ignore[assignment]


class ViewedFrame(RgbdFrame, frozen=True, kw_only=True):
    """A frame that was decoded without a copy of its pictures."""

    colour: ViewedColour | None = None
    depth: ViewedDepth | None = None


class Preview(Message, frozen=True, kw_only=True):
    """A small JPEG for far viewers; ``sequence`` and ``time_ns`` are the source frame's."""

    width: Pixels
    height: Pixels
    jpeg: bytes


class Person(Struct, frozen=True, kw_only=True):
    """One person's 20 joints in the camera frame, in the order of ``JOINT_NAMES``.

    The position of a ``missing`` joint means nothing (it is written as zeros). A joint that is
    exactly at zero, in the camera itself, or no finite number is missing whatever its state says:
    trackers write so of what they do not see. A confidence that is no number is none, 0.
    """

    id: Count
    joints: Annotated[tuple[Vector3, ...], Meta(min_length=20, max_length=20)]
    states: Annotated[tuple[JointState, ...], Meta(min_length=20, max_length=20)]
    confidences: Annotated[tuple[FractionOrNaN, ...], Meta(min_length=20, max_length=20)]

    def __post_init__(self) -> None:
        places = [any(joint) and all(map(math.isfinite, joint)) for joint in self.joints]
        if not all(places):
            self._leave_out(places)
        if any(map(math.isnan, self.confidences)):
            sure = tuple(0.0 if math.isnan(one) else one for one in self.confidences)
            msgspec.structs.force_setattr(self, "confidences", sure)
        if not all(0.0 <= one <= 1.0 for one in self.confidences):
            raise ValueError("a confidence is not from 0 to 1")

    def _leave_out(self, places: list[bool]) -> None:
        """Take joints as missing where they are no places."""
        kept = [
            (joint, state) if there else ((0.0, 0.0, 0.0), "missing")
            for joint, state, there in zip(self.joints, self.states, places, strict=True)
        ]
        msgspec.structs.force_setattr(self, "joints", tuple(joint for joint, _ in kept))
        msgspec.structs.force_setattr(self, "states", tuple(state for _, state in kept))


class Skeletons(Message, frozen=True, kw_only=True):
    """The people in one frame; ``sequence`` and ``time_ns`` are the source frame's.

    ``convention`` names whose joints these are (``conventions``), and so where each lies in a body;
    None where that is not said, as before there was this field.
    """

    people: Annotated[tuple[Person, ...], Meta(max_length=MOST_PEOPLE)] = ()
    convention: Name | None = None


class Box(Struct, frozen=True):
    """A rectangle in the image, in pixels."""

    left: float
    top: float
    width: NonNegative
    height: NonNegative

    def __post_init__(self) -> None:
        require_finite("box", (self.left, self.top, self.width, self.height))


class ObjectPose(Message, frozen=True, kw_only=True):
    """Where an object is; ``sequence`` and ``time_ns`` are the source frame's.

    ``covariance`` is 6 × 6, row by row, of (translation in the camera frame, rotation vector
    applied on the left), in metres and radians. A lost object has no pose.

    A simulated world's truth says more on ``label``: ``visible_fraction``, the share of the
    object's pixels that nothing hides, 0 where it is out of the image; ``contact``, what carries
    it; and ``person_joints``, where the person's 20 joints truly are, in the camera frame.
    """

    object: Name
    camera: Name
    state: PoseState
    confidence: Fraction
    person: Count | None = None
    camera_from_object: Pose | None = None
    rig_from_object: Pose | None = None
    covariance: Annotated[tuple[float, ...], Meta(min_length=36, max_length=36)] | None = None
    box: Box | None = None
    class_probabilities: Annotated[dict[Name, Fraction], Meta(max_length=1024)] = {}
    visible_fraction: Fraction | None = None
    contact: Contact | None = None
    person_joints: Annotated[tuple[Vector3, ...], Meta(min_length=20, max_length=20)] | None = None

    def __post_init__(self) -> None:
        if self.camera_from_object is None and self.state != "lost":
            raise ValueError(f"a {self.state} object needs a pose")
        require_finite("confidence", (self.confidence, *self.class_probabilities.values()))
        if self.covariance is not None:
            require_finite("covariance", self.covariance)
        if self.visible_fraction is not None:
            require_finite("visible fraction", (self.visible_fraction,))
        for joint in self.person_joints or ():
            require_finite("joint", joint)


class Event(Message, frozen=True, kw_only=True):
    """What was achieved, when, with which object, and the evidence for it.

    It lasted ``duration_ns`` until ``time_ns``. ``id`` is the event's own, however often it is
    published; ``probability`` is how likely it is that it happened. ``amounts`` are by names that
    end in their unit (``volume_ml``), and ``deviations`` the standard deviations of those that have
    one. ``rig_from_object`` is where the object was, and the frames of ``first_sequence`` to
    ``last_sequence`` show it.
    """

    kind: Name
    object: Name | None = None
    person: Count | None = None
    duration_ns: Nanoseconds = 0
    evidence: Annotated[dict[Name, float], Meta(max_length=256)] = {}
    description: Text = ""
    id: Text | None = None
    probability: Fraction | None = None
    amounts: Annotated[dict[Name, float], Meta(max_length=64)] = {}
    deviations: Annotated[dict[Name, NonNegative], Meta(max_length=64)] = {}
    rig_from_object: Pose | None = None
    first_sequence: Count | None = None
    last_sequence: Count | None = None

    def __post_init__(self) -> None:
        numbers = (*self.evidence.values(), *self.amounts.values(), *self.deviations.values())
        require_finite("evidence", (self.probability or 0.0, *numbers))


class TopicHealth(Struct, frozen=True, kw_only=True):
    """The traffic of one key at one instance since it started.

    ``dropped`` reached the instance and was too late or too much to be used, ``refused`` is what it
    does not take at all, ``lost`` is what the numbers of those that came show as missing.
    ``late_ms`` is the longest time, in milliseconds, from capture to arrival since the last report.
    ``unwritten`` is how many of those dropped a recorder's disk could not take.
    """

    published: Count = 0
    received: Count = 0
    dropped: Count = 0
    malformed: Count = 0
    rate_hz: NonNegative = 0.0
    lost: Count = 0
    late_ms: NonNegative | None = None
    refused: Count = 0
    unwritten: Count = 0

    def __post_init__(self) -> None:
        require_finite("rate", (self.rate_hz, self.late_ms or 0.0))


class Latency(Struct, frozen=True, kw_only=True):
    """From capture to now, over the last seconds, in milliseconds."""

    p50: float
    p99: float

    def __post_init__(self) -> None:
        require_finite("latency", (self.p50, self.p99))


class RecordingState(Struct, frozen=True, kw_only=True):
    """What a recorder does: whether it is ``paused``, and the name and size of the file that grows,
    if one does.

    The last ``ring_seconds`` are held in ``ring_bytes`` of memory, and ``clip`` is the name of the
    file that is made of them, while one is. All recordings of its folder take ``folder_bytes``,
    ``free_bytes`` of the disk are free, and ``deleted`` is how many recordings its quotas have
    deleted since it started. ``unmanaged`` of the recordings, of ``unmanaged_bytes``, no quota
    deletes, as no recorder of this release or a later one has written them; clips take
    ``clips_bytes`` beside them all. Where colour is to be H.264, ``colour`` is how many frames
    were, and how many were recorded as they came, by what kept them from it.
    """

    paused: bool = False
    file: Text | None = None
    file_bytes: Count = 0
    ring_seconds: NonNegative = 0.0
    ring_bytes: Count = 0
    clip: Text | None = None
    folder_bytes: Count = 0
    free_bytes: Count = 0
    deleted: Count = 0
    unmanaged: Count = 0
    unmanaged_bytes: Count = 0
    clips_bytes: Count = 0
    colour: Annotated[dict[Name, Count], Meta(max_length=16)] = {}

    def __post_init__(self) -> None:
        require_finite("time", (self.ring_seconds,))


class Health(Message, frozen=True, kw_only=True):
    """How an instance does, once a second.

    ``troubles`` is what is wrong now, ``last_error`` what went wrong last; ``loop_age_s`` is how
    long ago the instance's main loop last came round, in seconds. ``latency_ms`` is the age of what
    it has just published, or handled. ``effort`` is the share of its usual work that a tracker does
    in a frame, so that frames do not come faster than they are tracked. While ``shutter_closed``
    a camera captures nothing, because somebody wants it so; None where there is no shutter.
    ``recording`` is what a recorder does. While outcomes are ``paused`` nothing is measured,
    because somebody wants it so; None where nothing is measured anyway.
    """

    service: Name
    instance: Name
    state: ServiceState
    uptime_s: NonNegative
    resident_bytes: Count
    topics: Annotated[dict[str, TopicHealth], Meta(max_length=4096)] = {}
    latency_ms: Latency | None = None
    last_error: Text | None = None
    troubles: Annotated[tuple[Text, ...], Meta(max_length=64)] = ()
    loop_age_s: NonNegative = 0.0
    effort: Fraction | None = None
    shutter_closed: bool | None = None
    recording: RecordingState | None = None
    paused: bool | None = None

    def __post_init__(self) -> None:
        require_finite("time", (self.uptime_s, self.loop_age_s))
        require_finite("effort", (self.effort or 0.0,))
