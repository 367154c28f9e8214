"""Tables of what ``inhand bench`` measured."""

from collections.abc import Callable, Sequence
from statistics import median

from inhand_lab.benchmarks.ablation import Worth
from inhand_lab.benchmarks.checkout_comparison import CaseComparison
from inhand_lab.benchmarks.constants import ConstantCheck
from inhand_lab.benchmarks.frame_cost import FrameCosts
from inhand_lab.benchmarks.likelihood_bias import Bias, ObjectBias
from inhand_lab.benchmarks.likelihood_check import ObjectCheck
from inhand_lab.benchmarks.object_accuracy import ObjectAccuracy
from inhand_lab.benchmarks.tracker_speed import TrackerSpeed
from inhand_lab.benchmarks.training_cost import TrainingCost
from inhand_lab.benchmarks.transport_delay import TransportDelays
from inhand_runtime.wording import counted
from rich.table import Table

_TRAINING_ROWS: dict[str, Callable[[TrainingCost], float]] = {
    "training, s": lambda cost: cost.learning.training_s,
    "training, CPU s": lambda cost: cost.learning.training_cpu_s,
    "peak memory, MB": lambda cost: cost.learning.peak_memory_mb,
    "model, MB": lambda cost: cost.learning.model_mb,
    "saving, s": lambda cost: cost.learning.save_s,
    "loading, s": lambda cost: cost.asking.load_s,
    "making the index, s": lambda cost: cost.asking.index_s,
    "nearest pose, ms, p50": lambda cost: cost.asking.nearest_ms.p50,
    "nearest pose, ms, p99": lambda cost: cost.asking.nearest_ms.p99,
    "its cluster, ms, p50": lambda cost: cost.asking.cluster_ms.p50,
    "its cluster, ms, p99": lambda cost: cost.asking.cluster_ms.p99,
    "linear search, ms, p50": lambda cost: cost.asking.linear_ms,
}


def tracker_table(speed: TrackerSpeed) -> Table:
    """Rates, and how many times the naive evaluation's."""
    table = Table("on one core", "", title=f"weighing poses by {speed.points} points")
    table.add_row("by edges, a second", f"{speed.edge_hypotheses_per_second:,.0f}")
    table.add_row("by everything, a second", f"{speed.full_hypotheses_per_second:,.0f}")
    table.add_row("by edges, times NumPy one by one", f"{speed.naive_ratio:.0f}")
    return table


def weighing_table(speed: TrackerSpeed) -> Table:
    """What a frame costs by hypotheses and threads, with NumPy's edges alone beside it."""
    table = Table(title="a frame in which poses are weighed by every term, ms")
    table.add_column("hypotheses", justify="right")
    threads = list(dict.fromkeys(cost.threads for cost in speed.weighing))
    for count in threads:
        table.add_column(counted(count, "thread"), justify="right")
    table.add_column("NumPy, edges alone, one by one", justify="right")
    for hypotheses in dict.fromkeys(cost.hypotheses for cost in speed.weighing):
        costs = [cost for cost in speed.weighing if cost.hypotheses == hypotheses]
        cells = [f"{cost.ms:.1f}" for cost in costs]
        table.add_row(f"{hypotheses:,}", *cells, f"{costs[0].naive_ms:,.0f}")
    return table


def fusion_table(speed: TrackerSpeed) -> Table:
    """What a frame of fusion costs by the size of its training."""
    table = Table(title="processor time of fusion by what its prior was learned from")
    for name in ("labelled frames", "learning, s", "frame without image, ms", "with image, ms"):
        table.add_column(name, justify="right")
    for cost in speed.fusion:
        table.add_row(
            f"{cost.frames:,}",
            f"{cost.learning_s:.1f}",
            f"{cost.unseen_ms:.1f}",
            f"{cost.seen_ms:.1f}",
        )
    return table


def stages_table(costs: FrameCosts) -> Table:
    """A row a stage of a frame of one object."""
    table = Table(title="a frame of one object by its stages, µs of one core (medians)")
    table.add_column("stage")
    table.add_column("with an image", justify="right")
    table.add_column("without", justify="right")
    for stage, seen_us in costs.seen.stages_us.items():
        table.add_row(stage, f"{seen_us:,.0f}", f"{costs.unseen.stages_us[stage]:,.0f}")
    table.add_section()
    table.add_row("whole", f"{costs.seen.whole_us:,.0f}", f"{costs.unseen.whole_us:,.0f}")
    return table


def watching_table(costs: FrameCosts) -> Table:
    """A row a number of people, a column a number of objects."""
    rate = costs.frame_rate
    table = Table(title=f"a frame with images, ms of one core (cores in use at {rate:.0f} Hz)")
    table.add_column("people", justify="right")
    for count in dict.fromkeys(cost.objects for cost in costs.watching):
        name = f"{counted(count, 'object')} each"
        table.add_column(name, justify="right")
    for people in dict.fromkeys(cost.people for cost in costs.watching):
        cells = [f"{c.ms:.1f} ({c.cores:.2f})" for c in costs.watching if c.people == people]
        table.add_row(str(people), *cells)
    return table


def comparison_table(cases: Sequence[CaseComparison], checkout: str) -> Table:
    """A row a case: medians over the turns, and the least and greatest ratio of a turn."""
    table = Table(title="a frame of fusion on one core, ms of processor time")
    table.add_column("case")
    for name in ("here", checkout, "times longer", "in turns"):
        table.add_column(name, justify="right", overflow="fold")
    for one in cases:
        table.add_row(
            one.case,
            f"{median(one.here_ms):.2f}",
            f"{median(one.there_ms):.2f}",
            f"{median(one.ratios):.2f}",
            f"{min(one.ratios):.2f} to {max(one.ratios):.2f}",
        )
    return table


def transport_table(delays: TransportDelays) -> Table:
    """A row a way, beside Zenoh by itself."""
    notes = ["ours leaves shared memory off: without enough locked memory Zenoh loses frames in it"]
    if delays.without_dora is not None:
        notes.append(f"dora-rs was left out: {delays.without_dora}")
    table = Table(
        title=f"a frame of {delays.frame_bytes / 1e3:,.0f} kB to another process, "
        "from put to callback",
        caption="; ".join(notes),
    )
    table.add_column("way")
    for name in ("frames", "lost", "p50, ms", "p99, ms", "times Zenoh's p50", "in pairs"):
        table.add_column(name, justify="right")
    for one in delays.ways:
        figures = (one.p50_ms, one.p99_ms, one.ratio)
        cells = ["–" if figure is None else f"{figure:.2f}" for figure in figures]
        if len(set(one.ratios)) > 1:
            cells.append(f"{min(one.ratios):.2f} to {max(one.ratios):.2f}")
        table.add_row(one.way, f"{one.sent:,}", f"{one.lost:,}", *cells)
    return table


def training_table(costs: list[TrainingCost]) -> Table:
    """A column a size; in brackets, how many times the first one's."""
    table = Table("", title="training on simulated people (times the first column's)")
    for cost in costs:
        table.add_column(counted(cost.learning.frames, "frame"), justify="right")
    for name, value in _TRAINING_ROWS.items():
        first = value(costs[0])
        table.add_row(name, *(f"{_short(value(c))} ({_short(value(c) / first)})" for c in costs))
    table.add_section()
    asked = [cost.asking for cost in costs]
    table.add_row("nearest pose found", *(f"{one.found:.0%}" for one in asked))
    table.add_row(
        "nearest pose, times faster than linear search",
        *(_short(one.linear_ms / one.nearest_ms.p50) for one in asked),
    )
    return table


def likelihood_table(checks: list[ObjectCheck]) -> Table:
    """A row an object."""
    table = Table(
        title="from 3 cm and 10° off, refined (medians), in real frames",
        caption="rank: of the true pose's likelihood, among 10,000 poses scattered by 5 cm and "
        "20°; box and cup (without a handle) are fitted to the surface that is seen",
    )
    for name in ("object", "shape", "frames", "mm", "90 %", "degrees", "90 %", "rank"):
        table.add_column(name, justify="left" if name in ("object", "shape") else "right")
    for check in checks:
        table.add_row(
            check.name,
            check.shape,
            str(check.frames),
            f"{check.translation_mm:.1f}",
            f"{check.translation_90_mm:.1f}",
            f"{check.rotation_deg:.1f}",
            f"{check.rotation_90_deg:.1f}",
            f"{check.rank:.2%} (≤ {check.worst_rank:.2%})",
        )
    return table


def bias_table(biases: Sequence[ObjectBias]) -> Table:
    """A row an object; the columns are refinement, the whole likelihood, and its terms."""
    table = Table(
        title="where the optimum is beside the truth, mm: across the ray, and along it",
        caption="objects at 1.5 to 4 m before rooms, rendered without noise; refined: where "
        "refinement ends, the mean; else the greatest mean log-likelihood (-: none within reach)",
    )
    table.add_column("object", overflow="fold")
    for name in ("refined", "likelihood", *biases[0].terms):
        table.add_column(name, justify="right")
    for one in biases:
        columns = (one.refined, one.likelihood, *one.terms.values())
        table.add_row(one.name, *map(_bias_cell, columns))
    return table


def _bias_cell(bias: Bias) -> str:
    cells = (f"{bias.across_mm:.1f}", f"{bias.along_mm:+.1f}")
    return " ".join("-" if "nan" in cell else cell for cell in cells)


def objects_table(checks: Sequence[ObjectAccuracy]) -> Table:
    """A row an object."""
    table = Table(
        title="new objects beside the true mesh: mean surface distance, mm",
        caption="by measures: of a ruler, to the millimetre; by the camera: where it stands, from "
        "15 frames of a simulated Kinect's depth; stated: the residual that the fit states",
    )
    table.add_column("object", overflow="fold")
    for name in ("by measures", "by the camera", "worst", "stated", "fitted"):
        table.add_column(name, justify="right")
    table.add_column("as a")
    for check in checks:
        fitted = check.by_camera_mm
        scenes = len(fitted) + len(check.refusals)
        table.add_row(
            check.name,
            f"{check.by_measures_mm:.1f}",
            f"{check.camera_median_mm:.1f}" if fitted else "-",
            f"{max(fitted):.1f}" if fitted else "-",
            f"{median(check.stated_mm):.1f}" if fitted else "-",
            f"{len(fitted)} of {scenes}",
            ", ".join(dict.fromkeys(check.kinds)) or "refused",
        )
    return table


def ablation_table(worths: Sequence[Worth]) -> Table:
    """Each variant's error, how many times the whole method's, and how often its 90 % region holds
    the truth."""
    table = Table(
        "of",
        "without",
        "error, cm",
        "ratio",
        "region, %",
        title="fusion, a part taken out: vertex error, and truth in its 90 % region",
    )
    whole = worths[0].vertex_error_cm
    for worth in worths:
        error, variant = worth.vertex_error_cm, worth.variant
        _, separator, value = variant.instead.partition("=")
        instead = f" (instead {value.strip()})" if separator else ""
        table.add_row(
            variant.part,
            variant.without + instead,
            f"{error:.2f}",
            f"{error / whole:.2f}",
            f"{worth.region_percent:.0f}",
        )
    return table


def constants_table(checks: Sequence[ConstantCheck]) -> Table:
    """A row a number, and how many times the usual error that errs which is halved or doubled."""
    table = Table(
        "number",
        "usual",
        "lower",
        "ratio",
        "higher",
        "ratio",
        title="fusion's numbers, each changed by itself: vertex error, times the usual one",
    )
    for check in checks:
        table.add_row(
            check.name,
            f"{check.usual:g}",
            f"{check.lower:g}",
            f"{check.lower_ratio:.3f}",
            f"{check.higher:g}",
            f"{check.higher_ratio:.3f}",
        )
    return table


def _short(value: float) -> str:
    return f"{value:,.0f}" if value >= 100.0 else f"{value:.2g}"
