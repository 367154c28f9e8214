"""Procedures: what instances of a service can be asked to do, with request and reply in one object.

A request goes to all instances of the service; each that it concerns replies for itself.
"""

from typing import Annotated, Any

from msgspec import Meta, Struct

from inhand_schemas.fields import Count, Fraction, Name, Nanoseconds, Text
from inhand_schemas.messages import Pose, RecordingState
from inhand_schemas.playback import PLAYBACK
from inhand_schemas.procedure import Procedure

MOST_HYPOTHESES = 1000
"""Number of hypotheses of an object that a reply holds at the most: the likeliest."""


class ShutterRequest(Struct, frozen=True, kw_only=True):
    """Close or open the shutter of one camera, or of all."""

    closed: bool
    camera: Name | None = None


class ShutterReply(Struct, frozen=True, kw_only=True):
    """How a camera's shutter is from now on; ``problem`` is why it will not stay so."""

    camera: Name
    closed: bool
    problem: Text | None = None


class ControlRequest(Struct, frozen=True, kw_only=True):
    """Change settings of a camera that runs, by the names of its source's options; nil makes one
    automatic."""

    camera: Name
    options: Annotated[dict[Name, int | float | None], Meta(max_length=64)]


class ControlReply(Struct, frozen=True, kw_only=True):
    """That a camera has done so, or why it has not."""

    camera: Name
    problem: Text | None = None


class ReloadRequest(Struct, frozen=True, kw_only=True):
    """Load the models that its settings name anew, of one tracker or of all."""

    tracker: Name | None = None


class ReloadReply(Struct, frozen=True, kw_only=True):
    """Which objects a tracker follows from now on; ``problem`` is why it stays with what it had."""

    tracker: Name
    objects: Annotated[tuple[Name, ...], Meta(max_length=1024)]
    problem: Text | None = None


class HypothesesRequest(Struct, frozen=True, kw_only=True):
    """Tell what the next frame's poses are chosen from, of one tracker or of all."""

    tracker: Name | None = None


class ObjectHypotheses(Struct, frozen=True, kw_only=True):
    """Poses of an object that were considered in one frame, each camera_from_object.

    ``weights`` are those of ``poses``, which are empty where no image was looked at;
    ``predictions`` are what parts of the body say, each by itself.
    """

    object: Name
    person: Count | None = None
    poses: Annotated[tuple[Pose, ...], Meta(max_length=MOST_HYPOTHESES)]
    weights: Annotated[tuple[Fraction, ...], Meta(max_length=MOST_HYPOTHESES)]
    predictions: Annotated[dict[Text, Pose], Meta(max_length=64)]

    def __post_init__(self) -> None:
        if len(self.poses) != len(self.weights):
            raise ValueError("there are not as many weights as poses")


class HypothesesReply(Struct, frozen=True, kw_only=True):
    """What a tracker considered in the frame of ``camera`` that was captured at ``time_ns``."""

    tracker: Name
    camera: Name
    sequence: Count
    time_ns: Nanoseconds
    objects: Annotated[tuple[ObjectHypotheses, ...], Meta(max_length=1024)]


class RecorderRequest(Struct, frozen=True, kw_only=True):
    """Do what the verb says, of one recorder or of all.

    Requests with one ``id`` are one: who asks again, because not all have answered, has nothing
    done twice.
    """

    id: Text
    recorder: Name | None = None


class KindsOfLoss(Struct, frozen=True, kw_only=True):
    """How many messages of a key are missing in recordings, since the recorder started: never came
    (``transport``), came too fast (``queue``), or the ``disk`` could not take them."""

    transport: Count = 0
    queue: Count = 0
    disk: Count = 0


class RecorderReply(Struct, frozen=True, kw_only=True):
    """What a recorder does from now on; ``finished`` is the name of the file that a pause or a
    split has made whole, and ``problem`` is why a request was not done. ``losses`` are by key, of
    those that have any."""

    recorder: Name
    recording: RecordingState
    losses: Annotated[dict[str, KindsOfLoss], Meta(max_length=4096)] = {}
    finished: Text | None = None
    problem: Text | None = None


class OutcomesRequest(Struct, frozen=True, kw_only=True):
    """Measure nothing until asked to go on, or go on, as the verb says, of one daemon of outcomes
    or of all."""

    outcomes: Name | None = None


class OutcomesReply(Struct, frozen=True, kw_only=True):
    """Whether a daemon of outcomes is paused from now on; ``problem`` is why a restart may forget
    it."""

    outcomes: Name
    paused: bool
    problem: Text | None = None


SHUTTER = Procedure("capture", "shutter", ShutterRequest, ShutterReply, "camera")
CONTROL = Procedure("capture", "control", ControlRequest, ControlReply, "camera")
HYPOTHESES = Procedure("tracker", "hypotheses", HypothesesRequest, HypothesesReply, "tracker")
RELOAD = Procedure("tracker", "reload", ReloadRequest, ReloadReply, "tracker")

PAUSE = Procedure("recorder", "pause", RecorderRequest, RecorderReply, "recorder")
RESUME = Procedure("recorder", "resume", RecorderRequest, RecorderReply, "recorder")
SPLIT = Procedure("recorder", "split", RecorderRequest, RecorderReply, "recorder")
SNAPSHOT = Procedure("recorder", "snapshot", RecorderRequest, RecorderReply, "recorder")
STATUS = Procedure("recorder", "status", RecorderRequest, RecorderReply, "recorder")

PAUSE_MEASURING = Procedure("outcomes", "pause", OutcomesRequest, OutcomesReply, "outcomes")
RESUME_MEASURING = Procedure("outcomes", "resume", OutcomesRequest, OutcomesReply, "outcomes")

RECORDER_PROCEDURES = (PAUSE, RESUME, SPLIT, SNAPSHOT, STATUS)
PROCEDURES: tuple[Procedure[Any, Any], ...] = (
    SHUTTER,
    CONTROL,
    PLAYBACK,
    HYPOTHESES,
    RELOAD,
    *RECORDER_PROCEDURES,
    PAUSE_MEASURING,
    RESUME_MEASURING,
)
