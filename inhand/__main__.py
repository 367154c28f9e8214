"""``inhand VERB …``: finds the verb, runs it, and says in one line what failed."""

import argparse
import importlib
import importlib.metadata
import os
import sys
from collections.abc import Sequence
from keyword import iskeyword
from pathlib import Path
from typing import Any

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.exit_codes import DONE, FAILED, INTERRUPTED, WRONG_USAGE
from inhand_runtime.extras import missing_extra
from inhand_runtime.writable import require_writable_file, require_writable_folder

DAEMONS = {
    "capture": "publish frames and skeletons of one camera",
    "tracker": "follow the objects in people's hands",
    "recorder": "write everything that a rig publishes into recordings",
    "studio": "show a rig in the browser, teach it objects, and look at recordings",
    "outcomes": "say what was achieved with the objects, keep it, and tell the smart home",
    "hub": "let a site's hosts meet, each as its role allows: init, add, renew, revoke",
}
"""Verbs whose module has ``main(arguments) -> int``: the service parses for itself."""

VERBS = {
    "demo": "from nothing to tracked, recorded poses on this machine",
    "up": "run every process that the config names, supervised",
    "reload": "have a running `inhand up` take over its settings file, which has changed",
    "shutter": "close or open the cameras' shutters",
    "calibrate": "find where the cameras of a rig are, by a board or by people, and print boards",
    "control": "change a camera's exposure, focus or light while it runs",
    "replay": "publish a recording again",
    "playback": "pause, resume, step through and seek in a replay that runs",
    "simulate": "make a labelled dataset of simulated people",
    "import": "make a dataset of real data: utd-mhad, motion, ycb-video, bop",
    "object": "make a new object of a dataset, of a mesh, measures or depth: new",
    "record": "make a training recording of a running rig, and add it to a dataset",
    "label": "write an object's labels, from keyframes of it, beside a recording",
    "train": "learn a model from a labelled dataset",
    "evaluate": "measure methods on people that were not trained on",
    "recognise": "measure tracking where the object is not given, and recognition alone",
    "bench": "measure tracker, training, transport, hub, recorder, outcomes, skeletons, objects, "
    "labels, likelihood, constants, ablation, calibration, rigs, handovers",
    "models": "get the networks that find people in images: fetch",
    "recording": "info, verify, recover, repair, complete, convert, export, import and redact "
    "recordings",
    "topics": "list what a running site publishes",
    "echo": "print messages",
    "rate": "measure rates, gaps and sizes",
    "chaos": "inflict faults on a rig of this machine, and say what each costs",
    "doctor": "say what must be mended on this host before a rig runs",
    "install": "put systemd units, camera rules and sample settings into this system",
    "backup": "put a site's settings, models, objects and certificates into one file",
    "restore": "put back what a backup holds, whole or not at all",
    "metrics": "give the health of a rig to Prometheus, on this machine alone",
    "support": "write what a bug report needs into one file: no secrets, no pictures",
    "status": "list the live instances and their health",
}
"""Verbs whose module has ``add_arguments(parser)`` and ``run(arguments) -> int``."""


IN_ONE_THREAD = ("capture", "tracker")
"""Daemons in which NumPy computes in one thread, unless the user chose otherwise: a frame has small
matrices, and a second thread waits for a core on which another process works."""

WRITTEN_FILES = ("json", "output", "sheet", "picture", "board")
WRITTEN_FOLDERS = ("out", "report", "folder")
"""Names of the arguments that say where a verb writes."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one verb and return its exit code; only that verb's module is imported.

    Wrong usage ends the process with 2, as argparse does.
    """
    chosen = _parser().parse_args(arguments)
    try:
        return _run(chosen.verb, chosen.arguments)
    except InhandError as error:
        print(f"inhand {chosen.verb}: {error}", file=sys.stderr)
        return WRONG_USAGE if isinstance(error, SettingsError) else FAILED
    except ModuleNotFoundError as error:
        if (needs := missing_extra(error)) is None:
            raise
        print(f"inhand {chosen.verb}: {needs}", file=sys.stderr)
        return WRONG_USAGE
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE


def _run(verb: str, arguments: list[str]) -> int:
    if verb in IN_ONE_THREAD:
        # NumPy looks at it when it is imported.
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # A module cannot have a keyword's name.
    module = importlib.import_module(f"inhand.{verb}_" if iskeyword(verb) else f"inhand.{verb}")
    if verb in DAEMONS:
        return int(module.main(arguments))
    parser = argparse.ArgumentParser(prog=f"inhand {verb}", description=_sentence(module.__doc__))
    module.add_arguments(parser)
    chosen = parser.parse_args(arguments)
    _require_writable(chosen)
    return int(module.run(chosen))


def _require_writable(chosen: argparse.Namespace) -> None:
    """Raise SettingsError for a place that cannot be written, before the work of hours."""
    for names, require in (
        (WRITTEN_FILES, require_writable_file),
        (WRITTEN_FOLDERS, require_writable_folder),
    ):
        for name in names:
            path = getattr(chosen, name, None)
            if isinstance(path, Path):
                require(path)


def _sentence(docstring: str | None) -> str:
    return (docstring or "").partition(": ")[2].strip()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="inhand",
        description="Where the things in people's hands are: live 6-DoF object poses over Zenoh.",
        epilog="verbs:\n"
        + "".join(f"  {verb:10} {text}\n" for verb, text in (DAEMONS | VERBS).items())
        + "\n`inhand VERB --help` says what a verb takes.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="say the release, and end")
    parser.add_argument("verb", metavar="VERB", choices=(*DAEMONS, *VERBS), help="one of these:")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, metavar="…", help="the verb's own")
    return parser


class _Version(argparse.Action):
    """Looks the release up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        print(f"inhand {importlib.metadata.version('inhand')}")
        parser.exit()


if __name__ == "__main__":
    sys.exit(main())
