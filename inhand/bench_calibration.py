"""``inhand bench calibration``: how far from the truth cameras are calibrated."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from inhand_lab.benchmarks.board_calibration import (
    DEFAULT_BOARD_BENCHMARK,
    CameraTrial,
    measure_board_calibration,
)
from inhand_lab.benchmarks.board_range import BoardRange, cases, measure_board_ranges
from inhand_lab.benchmarks.parameters import DEFAULT_PEOPLE_CALIBRATION_CHECK
from inhand_lab.benchmarks.people_calibration import (
    CameraErrors,
    RigErrors,
    measure_people_calibration,
)
from rich.console import Group, RenderableType
from rich.table import Table

from inhand.progress import progress_bars
from inhand.results import listing

ERRORS = ("place\nmm", "turn\n°", "clock\nms", "said: ±\nmm")
BOARD, RANGE, PEOPLE = "by a board", "from how far", "by people"


def check_calibration() -> tuple[RenderableType, dict[str, Any]]:
    """Calibrate rigs of the benchmarks' seeds both ways: the tables, and values for machines."""
    totals = {
        BOARD: len(DEFAULT_BOARD_BENCHMARK.seeds),
        RANGE: len(cases()),
        PEOPLE: len(DEFAULT_PEOPLE_CALIBRATION_CHECK.seeds),
    }
    with progress_bars(totals) as advance:
        trials = measure_board_calibration(lambda: advance(BOARD))
        ranges = measure_board_ranges(lambda: advance(RANGE))
        rigs = []
        for rig in measure_people_calibration():
            rigs.append(rig)
            advance(PEOPLE)
    people = [camera for rig in rigs for camera in rig.cameras]
    tables = Group(_board_table(trials), range_table(ranges), _people_table(people))
    return tables, {
        "board": [vars(one) for one in trials],
        "ranges": [vars(one) for one in ranges],
        "people": _values(rigs),
    }


def _board_table(trials: Sequence[CameraTrial]) -> Table:
    title = "cameras by a board, drawn views, against the reference camera"
    table = listing(("seed", "camera"), (*ERRORS, "in the 90 %\nregion"), title)
    for one in trials:
        table.add_row(
            str(one.seed),
            one.camera,
            f"{one.place_mm:.2f}",
            f"{one.turn_deg:.3f}",
            f"{abs(one.clock_ms):.1f}",
            f"{one.deviation_mm:.2f}",
            "yes" if one.inside else "no",
        )
    places, turns = [one.place_mm for one in trials], [one.turn_deg for one in trials]
    table.caption = (
        f"median {np.median(places):.2f} mm and {np.median(turns):.3f}°, "
        f"worst {max(places):.2f} mm and {max(turns):.3f}°"
    )
    return table


def range_table(ranges: Sequence[BoardRange]) -> Table:
    """From how far boards are found in nine of ten pictures."""
    title = "from how far a board that is held still is found, drawn views"
    table = listing(("lens", "paper", "light"), ("range\nm", "then wide\npx"), title)
    for one in ranges:
        table.add_row(
            one.lens,
            one.paper,
            one.light,
            "-" if one.range_m is None else f"{one.range_m:.1f}",
            "-" if one.width_px is None else f"{one.width_px:.0f}",
        )
    return table


def _people_table(cameras: Sequence[CameraErrors]) -> Table:
    title = "cameras by a person who walks about for a minute"
    table = listing(("seed", "camera"), ERRORS, title)
    for one in cameras:
        table.add_row(
            str(one.seed),
            one.name,
            f"{one.translation_mm:.1f}",
            f"{one.rotation_deg:.2f}",
            f"{one.clock_ms:.1f}",
            f"{one.translation_deviation_mm:.1f}",
        )
    places = [one.translation_mm for one in cameras]
    turns = [one.rotation_deg for one in cameras]
    table.caption = (
        f"median {np.median(places):.1f} mm and {np.median(turns):.2f}°, "
        f"worst {max(places):.1f} mm and {max(turns):.2f}°"
    )
    return table


def _values(rigs: Sequence[RigErrors]) -> list[dict[str, Any]]:
    return [{**vars(rig), "cameras": [vars(camera) for camera in rig.cameras]} for rig in rigs]
