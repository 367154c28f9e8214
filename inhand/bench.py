"""``inhand bench``: measure what things cost here, and check what they are worth."""

import argparse
import tempfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from statistics import median
from typing import Any

from inhand_capture.estimation.found_person import PoseNetwork
from inhand_capture.estimation.networks import open_network, require_network
from inhand_capture.estimation.weights import DEFAULT_NETWORK
from inhand_lab.benchmarks.ablation import Worth, ablate, varied
from inhand_lab.benchmarks.ablation_data import AblationData
from inhand_lab.benchmarks.checkout_comparison import (
    CaseComparison,
    compare_checkout,
    comparison_steps,
    packages_of,
)
from inhand_lab.benchmarks.constants import check_constants
from inhand_lab.benchmarks.estimated_skeletons import check_skeletons, check_steps
from inhand_lab.benchmarks.estimation_cost import measure_estimation
from inhand_lab.benchmarks.frame_cost import frame_steps, measure_frames
from inhand_lab.benchmarks.hub_cost import hub_steps, measure_hub
from inhand_lab.benchmarks.label_errors import check_labels, chosen_entries
from inhand_lab.benchmarks.likelihood_bias import measure_bias
from inhand_lab.benchmarks.likelihood_check import check_likelihood
from inhand_lab.benchmarks.object_accuracy import check_objects, object_steps
from inhand_lab.benchmarks.parameters import (
    DEFAULT_COMPARISON,
    DEFAULT_FRAME_COST,
    DEFAULT_HUB_COST,
    DEFAULT_RECORDER_COST,
    DEFAULT_TRAINING_COST,
    DEFAULT_TRANSPORT,
)
from inhand_lab.benchmarks.real_depth_lifting import check_real_lifting, real_recordings
from inhand_lab.benchmarks.tracker_speed import measure_tracker
from inhand_lab.benchmarks.training_cost import benchmark_training, training_steps
from inhand_lab.benchmarks.transport_delay import measure_transport
from inhand_lab.datasets.dataset import load_dataset
from inhand_lab.evaluation.folds import leave_one_out
from inhand_lab.workers import usable_cores
from inhand_lab.world.interactions import INTERACTIONS
from inhand_runtime.errors import SettingsError
from rich.console import Console, Group, RenderableType

from inhand.bench_handovers import DEFAULT_SEEDS as HANDOVER_SEEDS
from inhand.bench_handovers import add_handover_arguments, measure_handovers
from inhand.bench_hub import rigs_table, running_routers, security_table
from inhand.bench_label_tables import labels_table
from inhand.bench_recorder import (
    measure_recorder,
    recorder_steps,
    recorders_table,
    writers_table,
)
from inhand.bench_rigs import DEFAULT_SEEDS, add_rig_arguments, measure_rigs
from inhand.bench_skeleton_tables import actions_table, costs_table, joints_table, rules_table
from inhand.bench_tables import (
    ablation_table,
    bias_table,
    comparison_table,
    constants_table,
    fusion_table,
    likelihood_table,
    objects_table,
    stages_table,
    tracker_table,
    training_table,
    transport_table,
    watching_table,
    weighing_table,
)
from inhand.looking import positive_count, seed_number
from inhand.progress import progress_bar, progress_bars
from inhand.results import write_json

OUTCOME_SEEDS = (9001, 9002, 9003)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "subject",
        choices=SUBJECTS,
        metavar="SUBJECT",
        help="; ".join(f"{subject}: {text}" for subject, text in SUBJECTS_HELP.items()),
    )
    parser.add_argument(
        "source",
        nargs="?",
        type=Path,
        metavar="SOURCE",
        help="for ablation, constants and labels: a dataset; for outcomes: a folder, in which what "
        "is missing is made; for likelihood, in place of rendered "
        "objects: a folder of YCB-Video, or of an excerpt; for skeletons, if at hand: a folder of "
        "UTD-MHAD with its depth",
    )
    parser.add_argument(
        "--vary",
        action="append",
        default=[],
        metavar="FIELD=VALUE",
        help="for ablation: a parameter of fusion with another value, in place of the parts taken "
        "out; may be repeated",
    )
    parser.add_argument(
        "--test-on",
        type=Path,
        metavar="DATASET",
        help="for ablation: test on another dataset, and leave nobody of the first one out",
    )
    parser.add_argument(
        "--plain",
        type=Path,
        metavar="DATASET",
        help="for ablation with --test-on: the people learned from without their variety, as a row "
        "of its own",
    )
    parser.add_argument(
        "--no-images", action="store_true", help="for ablation: from bodies alone, which is faster"
    )
    parser.add_argument(
        "--against",
        type=Path,
        metavar="CHECKOUT",
        help="for tracker: compare frames with those of another checkout's code, in turns",
    )
    parser.add_argument(
        "--seeds",
        type=seed_number,
        nargs="+",
        metavar="S",
        help="for outcomes, rigs and handovers: seeds of the people who are watched "
        f"(default: {' '.join(map(str, OUTCOME_SEEDS))}; for rigs: "
        f"{' '.join(map(str, DEFAULT_SEEDS))}; for handovers: "
        f"{' '.join(map(str, HANDOVER_SEEDS))})",
    )
    parser.add_argument(
        "--participants",
        type=positive_count,
        default=2,
        metavar="N",
        help="for outcomes: people of each seed (default: 2)",
    )
    parser.add_argument(
        "--estimated",
        action="store_true",
        help="for outcomes: the same again from skeletons that are estimated from the images",
    )
    parser.add_argument(
        "--idle-minutes",
        type=positive_count,
        metavar="N",
        help="for outcomes: so many minutes of people who use nothing as well, and people who use "
        "what nobody taught",
    )
    parser.add_argument(
        "--real",
        type=Path,
        nargs="+",
        default=[],
        metavar="FOLDER",
        help="for outcomes, with or without a SOURCE: folders with motion archives of golf swings, "
        "or with UTD-MHAD's skeletons, in which swings and strokes are counted; for handovers, in "
        "place of simulated ones: a folder with a handover that was measured",
    )
    add_rig_arguments(parser)
    add_handover_arguments(parser)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")


def run(arguments: argparse.Namespace) -> int:
    """Measure and show the table; raises InhandError."""
    named = arguments.source is not None
    if not named and arguments.subject in MEASURED_ON and not arguments.real:
        raise SettingsError(f"{arguments.subject} is measured on a SOURCE: name it")
    if named and arguments.subject not in MEASURED_ON + ALSO_MEASURED_ON:
        raise SettingsError(
            f"{arguments.subject} is measured on no SOURCE: leave it out; only "
            f"{', '.join(MEASURED_ON + ALSO_MEASURED_ON)} are"
        )
    for option, subjects in OPTIONS_OF.items():
        if getattr(arguments, option) and arguments.subject not in subjects:
            name = option.replace("_", "-")
            whose = " and ".join(subjects)
            raise SettingsError(f"--{name} is for {whose}, and for nothing else: leave it out")
    if arguments.estimated and not named:
        raise SettingsError("--estimated is measured on a SOURCE: name it")
    if arguments.plain and not arguments.test_on:
        raise SettingsError("--plain is learned from in place of what --test-on tests: name both")
    table, result = SUBJECTS[arguments.subject](arguments)
    Console().print(table)
    if arguments.json is not None:
        write_json(arguments.json, result)
    return 0


def _tracker(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    if arguments.against is not None:
        return _compared(arguments.against)
    speed = measure_tracker()
    with progress_bars(frame_steps(DEFAULT_FRAME_COST)) as advance:
        costs = measure_frames(advance, DEFAULT_FRAME_COST)
    tables = (
        tracker_table(speed),
        weighing_table(speed),
        fusion_table(speed),
        stages_table(costs),
        watching_table(costs),
    )
    return Group(*tables), {**asdict(speed), "frames": asdict(costs)}


def _compared(checkout: Path) -> tuple[RenderableType, dict[str, Any]]:
    packages_of(checkout)  # a wrong folder is refused before anything is simulated
    with progress_bars(comparison_steps(DEFAULT_COMPARISON)) as advance:
        cases = compare_checkout(checkout, advance, DEFAULT_COMPARISON)
    return comparison_table(cases, str(checkout)), {"cases": [_comparison_row(c) for c in cases]}


def _comparison_row(case: CaseComparison) -> dict[str, Any]:
    return {**asdict(case), "ratios": case.ratios, "median_ratio": median(case.ratios)}


def _likelihood(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    if arguments.source is None:
        with progress_bar("rendering", len(INTERACTIONS)) as advance:
            biases = measure_bias(list(INTERACTIONS), advance)
        return bias_table(biases), {"objects": [asdict(bias) for bias in biases]}
    checks = check_likelihood(arguments.source)
    return likelihood_table(checks), {"objects": [asdict(check) for check in checks]}


def _objects(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    with progress_bar("measuring", object_steps()) as advance:
        checks = check_objects(advance)
    return objects_table(checks), {"objects": [asdict(check) for check in checks]}


def _ablation(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    varied(arguments.vary)  # a wrong setting is refused before anything is loaded
    tested, plain = (
        None if folder is None else load_dataset(folder)
        for folder in (arguments.test_on, arguments.plain)
    )
    dataset = load_dataset(arguments.source)
    data = AblationData(dataset, tested, plain, images=not arguments.no_images)
    with progress_bar("evaluating", len(data.folds())) as advance:
        worths = ablate(data, usable_cores(), advance, arguments.vary)
    return ablation_table(worths), {"variants": [_ablation_row(worth) for worth in worths]}


def _constants(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    dataset = load_dataset(arguments.source)
    with progress_bar("evaluating", len(leave_one_out(dataset))) as advance:
        checks = check_constants(dataset, usable_cores(), advance)
    return constants_table(checks), {"numbers": [asdict(check) for check in checks]}


def _ablation_row(worth: Worth) -> dict[str, Any]:
    variant = worth.variant
    instead = {"instead": variant.instead} if variant.instead else {}
    return {
        "part": variant.part,
        "without": variant.without,
        **instead,
        "vertex_error_cm": worth.vertex_error_cm,
        "within_90_percent_region_percent": worth.region_percent,
    }


def _training(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    with progress_bars(training_steps(DEFAULT_TRAINING_COST.sizes)) as advance:
        costs = list(benchmark_training(DEFAULT_TRAINING_COST.sizes, usable_cores(), advance))
    sizes = [{**asdict(cost.learning), **asdict(cost.asking)} for cost in costs]
    return training_table(costs), {"sizes": sizes}


def _transport(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    delays = measure_transport(DEFAULT_TRANSPORT)
    return transport_table(delays), asdict(delays)


def _hub(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    parameters = DEFAULT_HUB_COST
    with (
        tempfile.TemporaryDirectory(prefix="inhand_bench_") as name,
        running_routers(Path(name), max(parameters.rig_counts)) as routers,
        progress_bar("measuring", hub_steps(parameters)) as advance,
    ):
        costs = measure_hub(routers, advance, parameters)
    security = [{**asdict(one), "ratio": one.ratio} for one in costs.security]
    return Group(rigs_table(costs), security_table(costs)), {**asdict(costs), "security": security}


def _recorder(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    with progress_bar("measuring", recorder_steps(DEFAULT_RECORDER_COST)) as advance:
        costs = measure_recorder(advance, DEFAULT_RECORDER_COST)
    return Group(writers_table(costs), recorders_table(costs)), asdict(costs)


def _labels(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    dataset = load_dataset(arguments.source)
    recordings = sum(map(len, chosen_entries(dataset).values()))
    with progress_bar("labelling", recordings) as advance:
        checks = list(check_labels(dataset, advance))
    return labels_table(checks), {"interactions": [asdict(check) for check in checks]}


def _skeletons(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    files = [] if arguments.source is None else real_recordings(arguments.source)

    def new_network() -> PoseNetwork:
        return open_network(DEFAULT_NETWORK)

    require_network(DEFAULT_NETWORK)
    with progress_bar("estimating", check_steps()) as advance:
        check = check_skeletons(new_network, advance)
    costs = measure_estimation(new_network)
    simulated = "on simulated people"
    tables = [actions_table(check), rules_table(simulated, check.rules)]
    tables.append(joints_table(simulated, check.joints))
    result: dict[str, Any] = asdict(check)
    if files:
        with progress_bar("lifting", len(files)) as advance:
            real = check_real_lifting(files, advance)
        recorded = f"on {real.recordings} real recordings"
        tables += [rules_table(recorded, real.rules), joints_table(recorded, real.joints)]
        result["real"] = asdict(real)
    return Group(*tables, costs_table(costs)), {**result, "costs": [asdict(cost) for cost in costs]}


def _outcomes(arguments: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    from inhand.bench_outcome_tables import all_tables
    from inhand.bench_outcomes import check_outcomes, steps
    from inhand.bench_outcomes_false import check_false, false_table
    from inhand.bench_outcomes_real import check_real_swings, golf_table, tennis_table

    tables: list[RenderableType] = []
    result: dict[str, Any] = {}
    if arguments.real:
        real = check_real_swings(arguments.real)
        tables += [golf_table(real.golf)] if real.golf else []
        tables += [tennis_table(real.tennis)] if real.tennis else []
        result["real"] = asdict(real)
    if arguments.source is not None:
        if arguments.estimated:
            require_network(DEFAULT_NETWORK)
        chosen = (arguments.source, arguments.seeds or OUTCOME_SEEDS, arguments.participants)
        for estimated in (False, True)[: 1 + arguments.estimated]:
            with progress_bar("comparing", steps(*chosen[1:])) as advance:
                check = check_outcomes(*chosen, advance, estimated=estimated)
            tables += all_tables(check)
            result |= {"estimated": asdict(check)} if estimated else asdict(check)
        if arguments.idle_minutes is not None:
            found = check_false(arguments.source, arguments.idle_minutes, *chosen[1:])
            tables.append(false_table(found))
            result["false"] = [asdict(one) for one in found]
    return Group(*tables), result


def _calibration(_: argparse.Namespace) -> tuple[RenderableType, dict[str, Any]]:
    from inhand.bench_calibration import check_calibration

    return check_calibration()


SUBJECTS_HELP = {
    "ablation": "the error of fusion without each of its parts",
    "calibration": "how far cameras of a rig are from the truth, by a board and by people",
    "constants": "its error with each number halved and doubled",
    "handovers": "whether two people who hand something over and pass keep their numbers; or where "
    "a prior has a real thing that passes on",
    "hub": "what a hub costs by the number of rigs, and its encryption and rules in delay",
    "labels": "how far labels between keyframes are from the truth",
    "likelihood": "where its optimum is beside the truth, on rendered objects; or how true poses "
    "score, and refine, on real frames of YCB-Video",
    "objects": "new objects, by measures and by the camera, beside the true meshes",
    "outcomes": "what is said to be achieved beside what truly was, of simulated people who are "
    "tracked from images",
    "recorder": "writing recordings beside other writers, and what a recorder takes",
    "rigs": "the error of several cameras together beside that of each alone, and when one fails",
    "skeletons": "skeletons from images: found people, joints' errors, and what a frame costs",
    "tracker": "poses weighed in a second, and what a frame costs, by itself or against other code",
    "training": "time and memory of training by its size",
    "transport": "the delay of a frame to another process, beside Zenoh's own and dora-rs's",
}

OPTIONS_OF = {
    "vary": ("ablation",),
    "test_on": ("ablation",),
    "plain": ("ablation",),
    "no_images": ("ablation",),
    "against": ("tracker",),
    "estimated": ("outcomes",),
    "idle_minutes": ("outcomes",),
    "real": ("outcomes", "handovers"),
    "trials": ("handovers",),
}
"""The subjects of each option that is not for all."""

MEASURED_ON = ("ablation", "constants", "labels", "outcomes")
ALSO_MEASURED_ON = ("likelihood", "skeletons")

SUBJECTS: dict[str, Callable[[Any], tuple[RenderableType, dict[str, Any]]]] = {
    "ablation": _ablation,
    "calibration": _calibration,
    "constants": _constants,
    "handovers": measure_handovers,
    "hub": _hub,
    "labels": _labels,
    "likelihood": _likelihood,
    "objects": _objects,
    "outcomes": _outcomes,
    "recorder": _recorder,
    "rigs": measure_rigs,
    "skeletons": _skeletons,
    "tracker": _tracker,
    "training": _training,
    "transport": _transport,
}
