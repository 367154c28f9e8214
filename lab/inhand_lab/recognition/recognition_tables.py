"""Tables of recognition, beside the published one."""

from collections.abc import Sequence
from typing import Any

from inhand_lab.recognition.false_objects import FalseObjects
from inhand_lab.recognition.movement_on_others import KnownFrames, together
from inhand_lab.recognition.recognition_protocol import CASCADES
from inhand_lab.report.grid import NOTHING, Grid

PUBLISHED = {
    "pourCream": (47, 83, 136),
    "answerPhone": (19, 92, 215),
    "drinkFromMug": (16, 89, 198),
    "recordVideo": (27, 86, 307),
    "liftWeights": (18, 93, 212),
    "playFlute": (12, 90, 247),
    "hitTennisBall": (60, 58, 157),
    "hammerNail": (46, 63, 220),
    "paintWall": (38, 63, 151),
    "putOnGlasses": (11, 88, 286),
    "shakeVinegar": (19, 78, 259),
    "magnifyText": (19, 50, 255),
    "putOnShoe": (134, 46, 92),
    "sweepFloor": (33, 96, 175),
    "hitGolfBall": (49, 98, 162),
}
"""Darby et al. 2012, table 1: pixels, precision in percent, pixels of the best adaptive tracker."""
PUBLISHED_MEANS = ("37 (78)", "205")
"""The means of that table: pixels with precision, pixels of the best adaptive tracker."""

MEASURES = {
    "box_error_pixels": "box error, pixels",
    "known_percent": "known, % of frames",
    "precision_percent": "precision of these, %",
    "vertex_error_cm": "vertex error where right, cm",
}


def recognition_grids(result: dict[str, Any]) -> list[Grid]:
    """Return two tables: errors in pixels with precisions, and the cascades' other measures."""
    return [_error_grid(result["methods"]), _measure_grid(result["methods"])]


def _error_grid(methods: dict[str, Any]) -> Grid:
    interactions = next(iter(methods.values()))["interactions"]
    rows = []
    for name in interactions:
        cells = [_cell(method["interactions"][name]) for method in methods.values()]
        pixels, precision, adaptive = PUBLISHED.get(name, (NOTHING,) * 3)
        rows.append((name, *cells, f"{pixels} ({precision})", str(adaptive)))
    means = ("mean", *(_cell(method) for method in methods.values()), *PUBLISHED_MEANS)
    return Grid(
        "box centres: error in pixels at a person of 400 (precision, %)",
        ("interaction", *methods, "P12", "P12's adaptive"),
        tuple(rows),
        (means,),
    )


def _measure_grid(methods: dict[str, Any]) -> Grid:
    ours = {name: method for name, method in methods.items() if name in CASCADES}
    rows = [
        (title, *(_number(method[key]) for method in ours.values()))
        for key, title in MEASURES.items()
        if ours
    ]
    return Grid("means over interactions", ("measure", *ours), tuple(rows))


def light_grid(results: dict[str, dict[str, Any]]) -> Grid:
    """Return a table of how often the right object is known in each light, by the light's name."""
    columns = {
        f"{name}, {light}": method
        for light, result in results.items()
        for name, method in result["methods"].items()
        if name in CASCADES
    }
    interactions = next(iter(columns.values()))["interactions"]
    rows = [
        (
            interaction,
            *(_number(m["interactions"][interaction]["right_percent"]) for m in columns.values()),
        )
        for interaction in interactions
    ]
    means = ("mean", *(_number(method["right_percent"]) for method in columns.values()))
    return Grid(
        "the right object known, % of frames", ("interaction", *columns), tuple(rows), (means,)
    )


def false_object_grid(counted: FalseObjects) -> Grid:
    """Return a table of false objects by people who use nothing, or do what was not taught."""
    rows = [
        (f"{kind}: {name}", "with images" if images else "skeletons alone", f"{100.0 * share:.1f}")
        for kind, shares, images in (
            ("nothing in use", counted.idle, counted.images),
            ("other dataset", counted.others, counted.others_images),
            ("left out of training", counted.never_trained, counted.images),
        )
        for name, share in shares.items()
    ]
    return Grid("a false object, % of frames", ("people", "seen", "%"), tuple(rows))


def _cell(row: dict[str, Any]) -> str:
    precision = row["precision_percent"]
    return _number(row["box_error_pixels"]) + ("" if precision is None else f" ({precision:.0f})")


def _number(value: float | None) -> str:
    return NOTHING if value is None else f"{value:.1f}"


def known_frames_grid(counts: Sequence[KnownFrames]) -> Grid:
    """Lay out what is known of people of another dataset, and false objects."""
    rows = []
    for kind in dict.fromkeys(count.kind for count in counts):
        some = [count for count in counts if count.kind == kind]
        rows += [(kind, count.action, *_percents(count)) for count in some]
        if len(some) > 1:
            rows.append((kind, "all", *_percents(together(some))))
    names = ("people's action is", "", "right", "wrong", "known before moving")
    return Grid("known, % of frames, by movement alone", names, tuple(rows))


def _percents(count: KnownFrames) -> tuple[str, ...]:
    return tuple(f"{value:.1f}" for value in count.percent)
