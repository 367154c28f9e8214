"""Lifts a real Kinect's joints back from its own depth: UTD-MHAD, which has no colour."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_capture.estimation.body_lengths import BodyLengths
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.estimation.lifting import DepthPicture, Lifter
from inhand_capture.estimation.limbs import DERIVED
from inhand_runtime.pinhole import Pinhole
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array

from inhand_lab.benchmarks.joint_distances import JointDistances, by_joint, summed_up
from inhand_lab.benchmarks.lifting_rules import RULES
from inhand_lab.benchmarks.parameters import DEFAULT_SKELETON_CHECK, SkeletonCheckParameters
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.importers.utd_mhad import (
    CY,
    DEPTH_SUFFIX,
    FOCAL_LENGTH,
    HEIGHT,
    MIRRORED_CX,
    SKELETON_SUFFIX,
    WIDTH,
    read_depth,
    read_trial,
)

LENS = Pinhole(FOCAL_LENGTH, FOCAL_LENGTH, WIDTH - 1 - MIRRORED_CX, CY, WIDTH, HEIGHT)
OWN_RULE = "surfaces and lengths, followed"
_KNOWN = np.array([joint not in DERIVED for joint in Joint])


@dataclass(frozen=True)
class RealLifting:
    """How far joints that were projected and lifted back are from Kinect's, by rule, and by joint
    for capture's own."""

    recordings: int
    rules: dict[str, JointDistances]
    joints: dict[str, JointDistances]


def real_recordings(folder: Path) -> list[Path]:
    """Return the depth files of a folder; raises DatasetError where there are none."""
    files = sorted(folder.glob(f"*{DEPTH_SUFFIX}"))
    if not files:
        raise DatasetError(f"{folder} holds no *{DEPTH_SUFFIX}: name a folder of UTD-MHAD")
    return files


def check_real_lifting(
    files: list[Path],
    on_recording: Callable[[], None],
    parameters: SkeletonCheckParameters = DEFAULT_SKELETON_CHECK,
) -> RealLifting:
    """Lift the joints of these recordings; no network says how deep they are."""
    by_rule: dict[str, list[Array]] = {}
    for file in files:
        trial = read_trial(file.with_name(file.name.replace(DEPTH_SUFFIX, SKELETON_SUFFIX)))
        lifter, body, before = Lifter(LENS), BodyLengths(), np.full((len(Joint), 3), np.nan)
        frames = zip(trial.joints_in_camera, read_depth(file), strict=False)
        for joints, depth in list(frames)[:: parameters.real_step]:
            person, picture = projected(joints), DepthPicture(depth, 0.001)
            placed = {name: rule(person, picture, LENS) for name, rule in RULES.items()}
            placed[OWN_RULE] = np.full((len(Joint), 3), np.nan)
            if (surfaces := lifter.read(person, picture)) is not None:
                lifted = lifter.lift(person, surfaces, body, before)
                if lifted is not None:
                    body.add(lifted.seen, lifted.states)
                    before = placed[OWN_RULE] = lifted.seen
            for name, there in placed.items():
                distances = np.linalg.norm(there - joints, axis=1)[_KNOWN]
                by_rule.setdefault(name, []).append(distances)
        on_recording()
    rules = {name: summed_up(np.array(found)) for name, found in by_rule.items()}
    whole = np.full((len(by_rule[OWN_RULE]), len(Joint)), np.nan)
    whole[:, _KNOWN] = by_rule[OWN_RULE]
    return RealLifting(len(files), rules, by_joint(list(whole)))


def projected(joints: Array) -> FoundPerson:
    """Return what a network without depth would say that sees joints (20, 3) exactly."""
    pixels = joints[:, :2] / joints[:, 2:] * [LENS.fx, LENS.fy] + [LENS.cx, LENS.cy]
    pixels = np.where(_KNOWN[:, None], pixels, np.nan)
    unknown = np.full(len(joints), np.nan)
    return FoundPerson(pixels, unknown, np.where(np.isfinite(pixels[:, 0]), 1.0, 0.0))
