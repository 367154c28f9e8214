"""Redacts a recording of ``walked_past`` in sections of ten pictures, and is killed at a step:
``python killed_redaction.py IN OUT STEP NUMBER``; number 0 is none."""

import os
import signal
import sys
from collections import Counter
from pathlib import Path

from inhand_capture.faces.finder import FaceFinder
from walked_past import told_finder

from inhand.redaction.redacted import redact_recording

SECTION = 10
PLACES = [0.1 * number - 0.5 for number in range(SECTION)]
"""Where somebody is in the pictures of each section."""


def main(path: Path, output: Path, step: str, number: int) -> None:
    """Redact, and say how many sections were looked through, all steps, and what was hidden."""
    steps, made = Counter[str](), Counter[str]()
    new_finder = told_finder(PLACES)

    def counting_finder() -> FaceFinder:
        made["sections"] += 1
        return new_finder()

    def on_step(name: str, _total: int) -> None:
        steps[name] += 1
        if name == step and steps[name] == number:
            os.kill(os.getpid(), signal.SIGKILL)

    done = redact_recording([path], output, "people", counting_finder, on_step, SECTION)
    print(made["sections"], dict(steps), dict(done.counts))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], int(sys.argv[4]))
