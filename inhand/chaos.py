"""``inhand chaos``: inflict faults on a rig of this machine, and say what each costs."""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from inhand_lab.chaos.account import Unrecorded, recorded_skeletons, unrecorded
from inhand_lab.chaos.faults import FAULTS
from inhand_lab.chaos.parameters import DEFAULT_CHAOS
from inhand_lab.chaos.rig import INHAND, ChaosRig, one_host, two_hosts
from inhand_lab.chaos.soak import MEASURES, Life, grown, soak
from inhand_lab.chaos.trials import Trial, inflict
from inhand_lab.demonstration.parameters import DEFAULT_DEMONSTRATION
from inhand_lab.demonstration.preparation import train_demonstration
from inhand_runtime.errors import SettingsError
from inhand_runtime.exit_codes import DONE, FAILED

from inhand.looking import output, positive_count
from inhand.progress import progress_bar
from inhand.results import listing, write_json


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The verb's arguments."""
    parser.add_argument(
        "--faults",
        nargs="+",
        metavar="FAULT",
        default=list(FAULTS),
        help=f"which, in this order, of: {', '.join(FAULTS)} (default: all)",
    )
    parser.add_argument(
        "--messages",
        type=positive_count,
        metavar="N",
        default=DEFAULT_CHAOS.flood_messages,
        help="number of messages of each flood (default: %(default)s)",
    )
    parser.add_argument(
        "--soak",
        type=positive_count,
        metavar="MINUTES",
        help="in place of that: a site with a hub for so long, with one of the faults each minute; "
        "says whether its processes grow",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the result")


def run(arguments: argparse.Namespace) -> int:
    """Exit code 1 where a promise is broken."""
    if unknown := [name for name in arguments.faults if name not in FAULTS]:
        raise SettingsError(f"there is no fault {unknown[0]!r}; there are: {', '.join(FAULTS)}")
    with tempfile.TemporaryDirectory(prefix="inhand_chaos_") as name:
        folder = Path(name)
        people = DEFAULT_DEMONSTRATION.trained_participants
        with progress_bar("simulating people to learn from", people) as advance:
            _, model = train_demonstration(folder, DEFAULT_CHAOS.interaction, advance)
        if arguments.soak is not None:
            return _soak(arguments, folder, model)
        rows = [
            row
            for name, rig, of_site in (("peers", one_host, False), ("site", two_hosts, True))
            for row in _inflict_on(
                rig(_made(folder / name), model),
                [one for one in arguments.faults if FAULTS[one].of_site == of_site],
                arguments.messages,
            )
        ]
    output().print(_table(rows))
    broken = [
        f"{trial.name}: {line}" for trial, kept in rows for line in (*_broken(trial), *_lost(kept))
    ]
    if arguments.json is not None:
        write_json(arguments.json, {"faults": {t.name: _result(t, kept) for t, kept in rows}})
    return _judged(broken)


def _soak(arguments: argparse.Namespace, folder: Path, model: Path) -> int:
    """Run a site for long, and say how its processes and its poses fared."""
    split = f"split_bytes = {json.dumps(DEFAULT_CHAOS.recording_bytes)}"
    with (
        two_hosts(_made(folder / "site"), model, recorder=split) as started,
        progress_bar("minutes", arguments.soak) as advance,
    ):
        rig = replace(started, messages=arguments.messages)
        trials, lives = soak(rig, arguments.soak, arguments.faults, lambda: _told(rig), advance)
    output().print(_lives_table(lives))
    output().print(_trials_table(trials))
    broken = [f"{trial.name}: {line}" for trial in trials for line in _broken(trial)]
    broken += [line for life in lives for line in grown(life)]
    if arguments.json is not None:
        faults = [{"fault": one.name, **_cost(one)} for one in trials]
        write_json(
            arguments.json, {"processes": [asdict(life) for life in lives], "faults": faults}
        )
    return _judged(broken)


def _judged(broken: Sequence[str]) -> int:
    for line in broken:
        print(f"inhand chaos: {line}", file=sys.stderr)
    return FAILED if broken else DONE


def _inflict_on(
    running: AbstractContextManager[ChaosRig], names: Sequence[str], messages: int
) -> list[tuple[Trial, Unrecorded]]:
    """Inflict faults on a rig, one after the other, and look into its recordings."""
    if not names:
        return []
    trials = []
    with running as started, progress_bar("inflicting faults", len(names)) as advance:
        rig = replace(started, messages=messages)
        for name in names:
            trials.append(inflict(name, FAULTS[name], rig, lambda: _told(rig)))
            advance()
    recorded = recorded_skeletons(rig.recordings)
    return [(trial, unrecorded(trial, recorded)) for trial in trials]


def _made(folder: Path) -> Path:
    folder.mkdir()
    return folder


def _told(rig: ChaosRig) -> list[str]:
    """What ``inhand status`` calls wrong now."""
    path = rig.folder / "status.json"
    command = [*INHAND, "status", "--config", str(rig.config), "--json", str(path)]
    path.unlink(missing_ok=True)
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if not path.exists():  # it could not look, and says why
        return [done.stderr.strip()]
    told: list[str] = json.loads(path.read_text(encoding="utf-8"))["problems"]
    return told


def _lost(kept: Unrecorded) -> list[str]:
    if kept.before_s <= DEFAULT_CHAOS.unrecorded_before_s:
        return []
    return [f"of the {kept.before_s:.1f} s before, something was not recorded"]


def _broken(trial: Trial) -> list[str]:
    """The promises that a trial broke, a line each."""
    lines = [f"the {service} ended, which was not its fault" for service in trial.died]
    poses, promised = trial.poses, DEFAULT_CHAOS
    if poses.back_s is None or poses.back_s > promised.back_within_s:
        lines.append(f"poses were back after {_seconds(poses.back_s)}")
    if poses.normal_s is None or poses.normal_s > promised.age_normal_within_s:
        lines.append(f"poses were as old as usual after {_seconds(poses.normal_s)}")
    if trial.grown_mb > promised.most_grown_mb:
        lines.append(f"a process has grown by {trial.grown_mb:.0f} MB")
    return lines


def _lives_table(lives: Sequence[Life]) -> Any:
    """A row for each process that lived longest of its service."""
    table = listing(
        ("process",),
        ("minutes", *(f"{measure}{more}" for measure in MEASURES for more in ("", " an hour"))),
    )
    for life in lives:
        cells = []
        for course in life.courses.values():
            cells += [f"{course.last:.0f}", f"{course.per_hour:+.1f}"]
        table.add_row(life.name, f"{life.minutes:.1f}", *cells)
    return table


def _trials_table(trials: Sequence[Trial]) -> Any:
    """A row for each fault, with the slowest of its times."""
    table = listing(("fault",), ("times", "back, s", "age usual, s", "MB more"))
    for name in dict.fromkeys(trial.name for trial in trials):
        same = [trial for trial in trials if trial.name == name]
        table.add_row(
            FAULTS[name].what,
            str(len(same)),
            _slowest([one.poses.back_s for one in same]),
            _slowest([one.poses.normal_s for one in same]),
            f"{max(one.grown_mb for one in same):.0f}",
        )
    return table


def _slowest(seconds: Sequence[float | None]) -> str:
    known = [one for one in seconds if one is not None]
    return "never" if len(known) < len(seconds) else f"{max(known):.1f}"


def _table(rows: Sequence[tuple[Trial, Unrecorded]]) -> Any:
    table = listing(
        ("fault", "`inhand status` meanwhile"),
        ("silent, s", "back, s", "age usual, s", "frames", "without pose", "unrecorded", "MB more"),
    )
    for trial, kept in rows:
        table.add_row(
            FAULTS[trial.name].what,
            _summary(trial.told),
            f"{trial.poses.silent_s:.1f}",
            _seconds(trial.poses.back_s),
            _seconds(trial.poses.normal_s),
            str(len(trial.skeletons.came)),
            str(trial.without_pose),
            str(kept.skeletons),
            f"{trial.grown_mb:.0f}",
        )
    return table


def _summary(told: Sequence[str]) -> str:
    """The first thing that was told, and how many more."""
    if not told:
        return "nothing"
    return told[0] if len(told) == 1 else f"{told[0]}; and {len(told) - 1} more"


def _seconds(value: float | None) -> str:
    return "never" if value is None else f"{value:.1f}"


def _result(trial: Trial, kept: Unrecorded) -> dict[str, Any]:
    return {
        **_cost(trial),
        "unrecorded": kept.skeletons,
        "unrecorded_before_s": kept.before_s,
    }


def _cost(trial: Trial) -> dict[str, Any]:
    return {
        **asdict(trial.poses),
        "frames": len(trial.skeletons.came),
        "without_pose": trial.without_pose,
        "inflicting_s": trial.span.end - trial.span.begin,
        "grown_mb": trial.grown_mb,
        "malformed": trial.malformed,
        "told": trial.told,
        "died": trial.died,
    }
