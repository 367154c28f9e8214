"""Messages of a simulation: its camera, pixels, skeletons and true poses."""

import numpy as np
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_schemas.fields import Contact, JointState, Vector3
from inhand_schemas.messages import CameraInfo, ObjectPose, Person, Pose, RgbdFrame
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.wire.poses import pose_message

from inhand_lab.geometry.transforms import Transform, quaternions
from inhand_lab.objects.model import ObjectModel
from inhand_lab.sensing.skeleton_noise import SkeletonReading
from inhand_lab.world.simulation import SensedFrame, Simulation

JOINT_STATES: tuple[JointState, ...] = ("missing", "inferred", "tracked")
CONTACTS: tuple[Contact, ...] = ("resting", "right_hand", "left_hand", "both_hands", "worn")
"""The message's words for contacts, in the order of ContactKind."""


def camera_info(
    intrinsics: Intrinsics,
    frame_rate: float,
    time_ns: int = 0,
    rig_from_camera: Transform | None = None,
) -> CameraInfo:
    """The simulated camera's description, with where it stands in a rig of several."""
    placed = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    if rig_from_camera is not None:
        turn = quaternions(rig_from_camera.rotation[None])[0]
        placed = pose_message(rig_from_camera.translation, turn)
    return CameraInfo(
        sequence=0,
        time_ns=time_ns,
        width=intrinsics.width,
        height=intrinsics.height,
        fx=intrinsics.fx,
        fy=intrinsics.fy,
        cx=intrinsics.cx,
        cy=intrinsics.cy,
        frame_rate=frame_rate,
        rig_from_camera=placed,
        description="simulated",
    )


def person_message(simulation: Simulation, frame: int) -> Person:
    """The simulated skeleton tracker's person in one frame."""
    return read_person(simulation.reading, frame, 0)


def read_person(reading: SkeletonReading, frame: int, number: int) -> Person:
    """A person of that number as a skeleton tracker reads them in one frame."""
    states = tuple(JOINT_STATES[state] for state in reading.states[frame])
    return Person(
        id=number,
        joints=tuple(
            (0.0, 0.0, 0.0) if state == "missing" else (x, y, z)
            for state, (x, y, z) in zip(states, reading.joints[frame].tolist(), strict=True)
        ),
        states=states,
        confidences=tuple(reading.confidences[frame].tolist()),
    )


def pixels_message(seen: SensedFrame, *, sequence: int, time_ns: int) -> RgbdFrame:
    """A frame as a camera sends it."""
    return RgbdFrame(
        sequence=sequence,
        time_ns=time_ns,
        colour=encode_colour(seen.colour),
        depth=encode_depth(seen.depth),
    )


def label_message(
    simulation: Simulation,
    frame: int,
    *,
    sequence: int,
    time_ns: int,
    camera: str,
    visible_fraction: float | None = None,
) -> ObjectPose:
    """The true pose in one frame; the caller finds out how much of the object is visible."""
    return ObjectPose(
        sequence=sequence,
        time_ns=time_ns,
        object=simulation.object_model.name,
        camera=camera,
        state="tracked",
        confidence=1.0,
        person=0,
        camera_from_object=pose_message(
            simulation.translations[frame], simulation.rotations[frame]
        ),
        visible_fraction=visible_fraction,
        contact=CONTACTS[simulation.contact[frame]],
        person_joints=_triples(simulation.true_joints_in_camera[frame]),
    )


def shape_of(model: ObjectModel) -> ObjectShape:
    """The object as datasets keep it."""
    return ObjectShape(
        model.name,
        model.vertices,
        model.faces,
        model.marked_vertices,
        np.array(model.mirror_normal),
        model.symmetries,
    )


def _triples(joints: Array) -> tuple[Vector3, ...]:
    return tuple((x, y, z) for x, y, z in joints.tolist())
