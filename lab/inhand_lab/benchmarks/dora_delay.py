"""Measures the delay of a frame between two nodes of dora-rs, where that is installed."""

import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from inhand_runtime.errors import InhandError

from inhand_lab.benchmarks import dora_node
from inhand_lab.benchmarks.parameters import TransportParameters

DORA = "dora-rs (shared memory)"
LONGEST_S = 120.0
"""Seconds within which dora's processes end, at the most."""


def why_not_measured() -> str | None:
    """Say why dora-rs cannot be measured here; None where it can."""
    if find_spec("dora") is None or find_spec("pyarrow") is None:
        return "dora-rs is not installed: pip install dora-rs"
    if _program() is None:
        return "dora's program is not installed: pip install dora-rs-cli"
    return None


def measure_dora(
    payload: bytes, parameters: TransportParameters
) -> tuple[dict[int, int], dict[int, int]]:
    """Return when each frame was sent and when its bytes were there, in nanoseconds, by number.

    Raises InhandError where dora-rs fails.
    """
    with tempfile.TemporaryDirectory(prefix="inhand-bench-") as name:
        folder = Path(name)
        (folder / dora_node.FRAME).write_bytes(payload)
        exchange = {"frames": parameters.frames, "frame_rate": parameters.frame_rate}
        (folder / dora_node.EXCHANGE).write_text(json.dumps(exchange))
        (folder / "flow.yml").write_text(json.dumps(_flow(folder)))
        try:
            done = subprocess.run(
                [str(_program()), "run", "flow.yml"],
                cwd=folder,
                capture_output=True,
                text=True,
                check=False,
                timeout=LONGEST_S + parameters.frames / parameters.frame_rate,
            )
        except subprocess.TimeoutExpired:
            raise InhandError("dora-rs did not end: leave it out (pip uninstall dora-rs)") from None
        sent, came = (_times(folder / file) for file in (dora_node.SENT, dora_node.CAME))
        if done.returncode != 0 or sent is None or came is None:
            lines = (done.stderr or done.stdout).strip().splitlines() or [str(done.returncode)]
            raise InhandError(f"dora-rs cannot be measured: {lines[-1]}")
    return sent, came


def _flow(folder: Path) -> dict[str, object]:
    """Two nodes; JSON is YAML, too."""
    program = str(Path(dora_node.__file__))
    nodes = [
        {
            "id": role,
            "path": sys.executable,
            "args": shlex.join(["-P", program, role, str(folder)]),
        }
        for role in ("send", "receive")
    ]
    source = {"source": f"send/{dora_node.OUTPUT}", "queue_size": 10}
    return {
        "nodes": [
            nodes[0] | {"outputs": [dora_node.OUTPUT]},
            nodes[1] | {"inputs": {dora_node.INPUT: source}},
        ]
    }


def _program() -> str | None:
    """The program ``dora``: beside this Python, or on the path."""
    beside = str(Path(sys.executable).parent)
    return shutil.which("dora", path=os.pathsep.join((beside, os.environ.get("PATH", ""))))


def _times(file: Path) -> dict[int, int] | None:
    if not file.exists():
        return None
    return {int(number): ns for number, ns in json.loads(file.read_text()).items()}
