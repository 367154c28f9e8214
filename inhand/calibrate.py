"""``inhand calibrate``: find where the cameras of a rig are, by a board or by people.

It prints the board, looks at a rig that runs or at recordings, and says later whether the cameras
still agree.
"""

import argparse
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE, FAILED
from inhand_runtime.rig_calibration import (
    RigCalibration,
    read_rig_calibration,
    require_place_for_calibration,
    write_rig_calibration,
)
from inhand_runtime.settings import load_rig_file

from inhand.looking import add_looking_arguments, positive_number
from inhand.results import write_json

PAPERS = ("a4", "letter", "a3")
SECONDS = 60.0
SETTINGS = Path("SETTINGS")
"""Stands for the calibration that the rig's settings name."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "recordings",
        nargs="*",
        type=Path,
        metavar="RECORDING",
        help="calibrate by these in place of the rig that runs",
    )
    add_looking_arguments(parser, SECONDS, "to look at the rig")
    parser.add_argument(
        "-o", dest="output", type=Path, metavar="FILE", help="write the calibration there (TOML)"
    )
    parser.add_argument(
        "--people",
        action="store_true",
        help="without a board: by a person who walks about where the cameras see them",
    )
    parser.add_argument(
        "--clocks-within",
        type=positive_number,
        metavar="S",
        help="for --people: clocks are known to be within so many seconds of each other; walking "
        "to and fro is enough then (default: any offset is looked for)",
    )
    parser.add_argument("--board", type=Path, metavar="FILE", help="make a board to print (PDF)")
    parser.add_argument(
        "--paper", choices=PAPERS, default="a4", help="for --board: its paper (default: a4)"
    )
    parser.add_argument(
        "--line-mm",
        type=positive_number,
        metavar="MM",
        help="how long the line on the printed board is, as measured (default: as it should be)",
    )
    parser.add_argument(
        "--pattern",
        metavar="BOARD",
        help="a ChArUco board of your own: COLUMNSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY, such as "
        "8x6:40:30:5x5_100",
    )
    parser.add_argument(
        "--floor",
        action="store_true",
        help="the board lies on the floor, face up, where it stands still at last",
    )
    parser.add_argument(
        "--origin",
        metavar="CAMERA|board",
        help="where the rig's frame has its origin (default: on the floor, if one is seen)",
    )
    parser.add_argument(
        "--check",
        nargs="?",
        type=Path,
        const=SETTINGS,
        metavar="FILE",
        help="say how far cameras disagree now with this calibration (default: the one that the "
        "settings name)",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result for machines")


def run(arguments: argparse.Namespace) -> int:
    """Print a board, calibrate or check; exit code 1 where cameras disagree, or one could not be
    compared. Raises InhandError."""
    _require_sense(arguments)
    if arguments.board is not None:
        return _print_board(arguments)
    if arguments.check is not None:
        return _check(arguments)
    require_place_for_calibration(arguments.output)
    calibration, result = _by_people(arguments) if arguments.people else _by_board(arguments)
    write_rig_calibration(arguments.output, calibration)
    print(f"written: {arguments.output}; name it in the settings of each camera,")
    print(f'  [capture.{next(iter(calibration.cameras))}] calibration = "{arguments.output.name}"')
    print("then `inhand reload`, also where it is named already: what runs has the former one")
    if arguments.json is not None:
        write_json(arguments.json, result)
    return DONE


def _require_sense(arguments: argparse.Namespace) -> None:
    """Raise SettingsError for options that do not belong together."""
    if arguments.board is not None:
        if arguments.recordings or arguments.output or arguments.check or arguments.people:
            raise SettingsError("--board makes a board to print, and nothing else: leave the rest")
        return
    if arguments.check is None and arguments.output is None:
        raise SettingsError("name the file for the calibration: -o cameras.toml")
    if arguments.people:
        for option in ("pattern", "line_mm", "floor"):
            if getattr(arguments, option):
                name = option.replace("_", "-")
                raise SettingsError(f"--{name} is for boards, not for --people: leave it out")
        if arguments.origin == "board":
            raise SettingsError("--people sees no board: name a camera as --origin")
    elif arguments.clocks_within:
        raise SettingsError("--clocks-within is for --people: leave it out")
    if arguments.clocks_within and arguments.check is not None:
        raise SettingsError("--clocks-within is for calibrating, not for --check: leave it out")
    if arguments.pattern and arguments.line_mm:
        raise SettingsError("--line-mm is for boards that we print: say your board's true sides")
    if arguments.floor and arguments.origin not in (None, "board"):
        raise SettingsError("--floor puts the origin on the floor: leave --origin out")


def _print_board(arguments: argparse.Namespace) -> int:
    from inhand_calibration.from_board.board import printed_board
    from inhand_calibration.from_board.sheet import LINE_MM, write_sheet

    board = printed_board(arguments.paper)
    write_sheet(arguments.board, board, arguments.paper)
    print(f"{arguments.board}: {board.name}, to print at 100 % on {arguments.paper} paper")
    print(f"measure its line: where it is not {LINE_MM:.0f} mm long, calibrate with --line-mm")
    return DONE


def _by_board(arguments: argparse.Namespace) -> tuple[RigCalibration, dict[str, Any]]:
    from inhand_calibration.from_board.calibration import calibrate_from_board

    from inhand.calibrate_looking import board_sights, sized_sights
    from inhand.calibrate_words import board_values, print_board_calibration

    sights = board_sights(arguments)
    for note in sights.notes():
        print(note)
    calibration = calibrate_from_board(
        sized_sights(sights, arguments.line_mm),
        datetime.now(UTC),
        sights.points(),
        arguments.origin,
        board_on_floor=arguments.floor,
    )
    print_board_calibration(calibration)
    return calibration.rig, board_values(calibration)


def _by_people(arguments: argparse.Namespace) -> tuple[RigCalibration, dict[str, Any]]:
    from inhand_calibration.from_people.calibration import calibrate_from_people

    from inhand.calibrate_looking import people_seen
    from inhand.calibrate_words import people_values, print_people_calibration

    cameras = people_seen(arguments)
    names = [camera.name for camera in cameras]
    reference = arguments.origin or max(cameras, key=lambda camera: len(camera.times_ns)).name
    if reference not in names:
        raise SettingsError(f"there is no camera {reference}; there are: {', '.join(names)}")
    within_s = np.inf if arguments.clocks_within is None else arguments.clocks_within
    calibration = calibrate_from_people(cameras, reference, clocks_within_s=within_s)
    print_people_calibration(calibration)
    return calibration.rig_calibration(datetime.now(UTC)), people_values(calibration)


def _check(arguments: argparse.Namespace) -> int:
    from inhand.calibrate_words import (
        print_board_disagreement,
        print_not_compared,
        print_people_disagreement,
    )

    path = _calibration_in_use(arguments)
    calibration = read_rig_calibration(path)
    if arguments.people:
        from inhand_calibration.from_people.disagreement import find_disagreement

        from inhand.calibrate_looking import people_seen

        found = find_disagreement(people_seen(arguments), calibration)
        result, agree = print_people_disagreement(found, path), not found.sentences
        compared = {name for pair in found.pairs for name in (pair.first, pair.second)}
    else:
        from inhand_calibration.from_board.disagreement import find_board_disagreement

        from inhand.calibrate_looking import board_sights, sized_sights

        sights = board_sights(arguments)
        pairs = find_board_disagreement(sized_sights(sights, arguments.line_mm), calibration)
        result = print_board_disagreement(pairs, path)
        agree = not any(pair.moved or pair.clock_changed for pair in pairs)
        compared = {name for pair in pairs for name in (pair.first, pair.second)}
    left_out = [name for name in calibration.cameras if name not in compared]
    print_not_compared(left_out, path)
    result["not_compared"] = left_out
    if arguments.json is not None:
        write_json(arguments.json, result)
    return DONE if agree and not left_out else FAILED


def _calibration_in_use(arguments: argparse.Namespace) -> Path:
    """Return the calibration to be checked; raises SettingsError where none is named."""
    if arguments.check != SETTINGS:
        return Path(arguments.check)
    rig_file = load_rig_file(arguments.config)
    folder = Path() if arguments.config is None else arguments.config.parent
    named: set[Path] = {
        folder / table["calibration"]
        for table in (*rig_file.capture.values(), *rig_file.tracker.values())
        if isinstance(table.get("calibration"), str)
    }
    if len({path.resolve() for path in named}) != 1:
        raise SettingsError(
            ("several calibrations are" if named else "no calibration is")
            + " named in the settings: name one with --check FILE"
        )
    return named.pop()
