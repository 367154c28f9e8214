"""A simulation told in messages."""

import numpy as np
from inhand_schemas.messages import CameraInfo, JointState, ObjectPose, Person
from inhand_tracker.conversion import pose_message
from inhand_tracker.shape import ObjectShape, Symmetry

from inhand_lab.objects.model import ObjectModel
from inhand_lab.rasteriser import Intrinsics
from inhand_lab.world import Simulation

JOINT_STATES: tuple[JointState, ...] = ("missing", "inferred", "tracked")


def camera_info(intrinsics: Intrinsics, frame_rate: float, time_ns: int = 0) -> CameraInfo:
    """How the simulated camera sees."""
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
        description="simulated",
    )


def person_message(simulation: Simulation, frame: int) -> Person:
    """What the simulated skeleton tracker says of one frame."""
    states = tuple(JOINT_STATES[state] for state in simulation.joint_states[frame])
    return Person(
        id=0,
        joints=tuple(
            (0.0, 0.0, 0.0) if state == "missing" else (x, y, z)
            for state, (x, y, z) in zip(
                states, simulation.joints_in_camera[frame].tolist(), strict=True
            )
        ),
        states=states,
        confidences=tuple(simulation.joint_confidences[frame].tolist()),
    )


def label_message(
    simulation: Simulation, frame: int, *, sequence: int, time_ns: int, camera: str
) -> ObjectPose:
    """The object's true pose in one frame."""
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
    )


def shape_of(model: ObjectModel) -> ObjectShape:
    """The object as datasets keep it."""
    return ObjectShape(
        model.name,
        model.vertices,
        model.faces,
        model.marked_vertices,
        np.array(model.mirror_normal),
        tuple(Symmetry(axis) for axis in model.symmetries),
    )
