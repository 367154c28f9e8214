"""What `inhand calibrate` found, as tables for people and as values for machines."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from inhand_calibration.arrays import Array
from inhand_calibration.from_board.calibration import BoardCalibration
from inhand_calibration.from_board.disagreement import BoardDisagreement, bumped
from inhand_calibration.from_people.calibration import PeopleCalibration
from inhand_calibration.from_people.disagreement import Disagreement
from inhand_runtime.wording import counted
from inhand_schemas.messages import Pose

from inhand.looking import output
from inhand.results import listing


def print_board_calibration(calibration: BoardCalibration) -> None:
    """Show where cameras are, how sure that is, and what is wrong."""
    solution = calibration.solution
    table = listing(
        ("camera", "intrinsics"),
        ("x\nm", "y\nm", "z\nm", "±\nmm", "±\n°", "clock\nms", "±\nms", "error\npx", "sights"),
        "where the cameras are",
    )
    for index, name in enumerate(solution.names):
        check = calibration.intrinsics[name]
        wrong = any(one.camera == name for one in calibration.lenses)
        place = calibration.rig.cameras[name].rig_from_camera.translation
        known = np.isfinite(solution.offset_deviations_s[index])
        table.add_row(
            name,
            "wrong" if wrong else check.verdict,
            *(f"{one:.3f}" for one in place),
            *_deviations(calibration.covariances[name]),
            f"{1e3 * solution.offsets_s[index]:.1f}" if known else "-",
            f"{1e3 * solution.offset_deviations_s[index]:.1f}" if known else "-",
            f"{solution.errors_px[index]:.2f}",
            f"{len(solution.cameras[index].sights):,}",
        )
    table.caption = f"± of each, against {solution.names[0]}; the frame: {calibration.frame.words}"
    output().print(table)
    for (one, two), count in solution.together().items():
        print(f"{one} and {two} saw the board together in {counted(count, 'place')}")
    _print_warnings(calibration.warnings)


def board_values(calibration: BoardCalibration) -> dict[str, Any]:
    """The same for machines."""
    solution = calibration.solution
    return {
        "frame": calibration.frame.words,
        "z_is_up": calibration.frame.z_is_up,
        "cameras": {
            name: {
                **_pose_values(
                    calibration.rig.cameras[name].rig_from_camera, calibration.covariances[name]
                ),
                "clock_offset_ns": calibration.rig.cameras[name].clock_offset_ns,
                "error_px": float(solution.errors_px[index]),
                "intrinsics": calibration.intrinsics[name].verdict,
            }
            for index, name in enumerate(solution.names)
        },
        "together": {" ".join(pair): count for pair, count in solution.together().items()},
        "warnings": list(calibration.warnings),
    }


def print_people_calibration(calibration: PeopleCalibration) -> None:
    """Show where people have the cameras."""
    table = listing(
        ("camera",),
        ("x\nm", "y\nm", "z\nm", "±\nmm", "±\n°", "clock\nms", "±\nms", "joints off\ncm"),
        "where the cameras are",
    )
    for name, camera in calibration.cameras.items():
        table.add_row(
            name,
            *(f"{one:.3f}" for one in camera.rig_from_camera.translation),
            *_deviations(camera.covariance),
            f"{camera.clock_offset_ns / 1e6:.1f}",
            f"{camera.clock_deviation_ns / 1e6:.1f}",
            f"{100.0 * camera.residual_m:.1f}",
        )
    table.caption = f"± of each, against {calibration.reference}; the frame: {calibration.frame}"
    output().print(table)
    _print_warnings(calibration.warnings)


def people_values(calibration: PeopleCalibration) -> dict[str, Any]:
    """The same for machines."""
    return {
        "frame": calibration.frame,
        "z_is_up": calibration.floor is not None,
        "cameras": {
            name: {
                **_pose_values(camera.rig_from_camera, camera.covariance),
                "clock_offset_ns": camera.clock_offset_ns,
            }
            for name, camera in calibration.cameras.items()
        },
        "warnings": list(calibration.warnings),
    }


def print_board_disagreement(pairs: Sequence[BoardDisagreement], path: Path) -> dict[str, Any]:
    """Show how far cameras disagree, and return it for machines."""
    table = listing(
        ("cameras", "verdict"),
        ("off by\nmm", "±\nmm", "turned\n°", "±\n°", "clock\nms", "places"),
        f"against {path}",
    )
    for pair in pairs:
        wrong = " and ".join(
            what
            for what, is_so in (("moved", pair.moved), ("other time", pair.clock_changed))
            if is_so
        )
        table.add_row(
            f"{pair.first}, {pair.second}",
            wrong or "agree",
            f"{1e3 * pair.moved_m:.1f}",
            f"{1e3 * pair.moved_deviation_m:.1f}",
            f"{np.degrees(pair.turned_rad):.2f}",
            f"{np.degrees(pair.turned_deviation_rad):.2f}",
            "-" if pair.clock_s is None else f"{1e3 * pair.clock_s:.1f}",
            str(pair.moments),
        )
    output().print(table)
    culprits = bumped(pairs)
    for name in culprits:
        print(f"WRONG: {name} was moved: run `inhand calibrate` again")
    if not culprits and any(pair.moved for pair in pairs):
        print("WRONG: cameras were moved: run `inhand calibrate` again")
    return {"pairs": [asdict(pair) for pair in pairs], "bumped": list(culprits)}


def print_people_disagreement(found: Disagreement, path: Path) -> dict[str, Any]:
    """Show how far cameras disagree on people, and return it for machines."""
    for sentence in found.sentences:
        print(f"WRONG: {sentence}")
    if not found.sentences and found.pairs:
        print(f"the cameras that were compared agree with {path} on people")
    return {
        "pairs": [asdict(pair) for pair in found.pairs],
        "bumped": list(found.bumped),
        "reset": list(found.reset),
    }


def print_not_compared(names: Sequence[str], path: Path) -> None:
    """Show which cameras of a calibration could not be compared with any other."""
    for name in names:
        print(
            f"NOT CHECKED: {name} did not see the same as another camera of {path} for long "
            "enough: is it running, the right way up, and do you walk where two look?"
        )


def _deviations(covariance: Array) -> tuple[str, str]:
    """Deviation of a camera's place, mm, and of its rotation, degrees, over all axes."""
    place, turn = np.trace(covariance[:3, :3]), np.trace(covariance[3:, 3:])
    return f"{1e3 * np.sqrt(place):.1f}", f"{np.degrees(np.sqrt(turn)):.3f}"


def _pose_values(pose: Pose, covariance: Array) -> Mapping[str, Any]:
    return {
        "translation": list(pose.translation),
        "rotation": list(pose.rotation),
        "covariance": covariance.ravel().tolist(),
    }


def _print_warnings(warnings: Sequence[str]) -> None:
    for warning in warnings:
        print(f"WARNING: {warning}")
