"""Tables of what ``inhand bench skeletons`` measured."""

from collections.abc import Mapping, Sequence

from inhand_lab.benchmarks.estimated_skeletons import SkeletonCheck
from inhand_lab.benchmarks.estimation_cost import EstimationCost
from inhand_lab.benchmarks.joint_distances import JointDistances
from rich.table import Table

from inhand.results import listing

DISTANCES = ("cm", "mean", "90 %", "> 10 cm", "> 20 cm")
"""What is told of distances: their median first."""


def actions_table(check: SkeletonCheck) -> Table:
    """A row an interaction: who was found, and how far their joints are off."""
    title = "skeletons from images of simulated people"
    table = listing(("interaction",), ("found", "exchanged", "ids", *DISTANCES), title)
    for action in check.actions:
        table.add_row(
            action.interaction,
            f"{action.found:.1%}",
            f"{action.exchanged:.1%}",
            f"{action.ids:.1f}",
            *_cells(action.distances),
        )
    return table


def rules_table(where: str, rules: Mapping[str, JointDistances]) -> Table:
    """A row a rule that lifts joints."""
    columns = (*DISTANCES, "none", "> 10 or none")
    table = listing(("rule",), columns, f"lifting joints from depth, {where}")
    for rule, distances in rules.items():
        measured = 1.0 - distances.missing
        wrong = distances.missing + measured * distances.over_10_cm
        table.add_row(rule, *_cells(distances), f"{distances.missing:.1%}", f"{wrong:.1%}")
    return table


def joints_table(where: str, joints: Mapping[str, JointDistances]) -> Table:
    """A row a joint that was lifted."""
    table = listing(("joint",), DISTANCES, f"by joint, {where}")
    for joint, distances in joints.items():
        if distances.missing < 1.0:
            table.add_row(joint, *_cells(distances))
    return table


def costs_table(costs: Sequence[EstimationCost]) -> Table:
    """A row a size of picture."""
    table = Table("picture", title="a frame with one person, ms of one core (cores at 30 Hz)")
    for name in ("network", "lifting and following", "whole", "decoding a JPEG"):
        table.add_column(name, justify="right")
    for cost in costs:
        table.add_row(
            f"{cost.width} × {cost.height}",
            f"{cost.network_ms:.1f}",
            f"{cost.lifting_ms:.1f}",
            f"{cost.whole_ms:.1f} ({0.03 * cost.whole_ms:.2f})",
            f"{cost.decoding_ms:.1f}",
        )
    return table


def _cells(distances: JointDistances) -> tuple[str, str, str, str, str]:
    """The cells of one row."""
    return (
        f"{distances.median_cm:.1f}",
        f"{distances.mean_cm:.1f}",
        f"{distances.p90_cm:.1f}",
        f"{distances.over_10_cm:.1%}",
        f"{distances.over_20_cm:.1%}",
    )
