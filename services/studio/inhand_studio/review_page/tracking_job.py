"""A tracker that runs over a recording in a process of its own, for as long as somebody waits."""

import os
import subprocess
import sys
import threading
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from inhand_lab.datasets.tracks import Track
from inhand_lab.workers import ONE_THREAD
from inhand_runtime.errors import InhandError
from inhand_tracker.geometry.arrays import Indices

NICENESS = 10
"""It gives way to a rig that tracks on the same machine."""


@dataclass(frozen=True)
class TrackingTask:
    """What is tracked with what; a ``camera`` is named where the recording has several."""

    recording: Path
    model: Path
    method: str
    camera: str
    left_handed: bool


@dataclass(frozen=True)
class TrackedPoses:
    """The poses of an object in the frames at ``times_ns`` (T,)."""

    object: str
    times_ns: Indices
    track: Track


class TrackingJob:
    """A process that tracks; ``share`` is how much of it is done."""

    def __init__(self, task: TrackingTask) -> None:
        """Start it."""
        self.task = task
        self.share = 0.0
        self._folder = TemporaryDirectory(prefix="inhand-review-")
        self._output = Path(self._folder.name) / "poses.npz"
        arguments = [str(task.recording), str(task.model), task.method, str(self._output)]
        arguments += ["--camera", task.camera, *(["--left-handed"] if task.left_handed else [])]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "inhand_studio.review_page.track_recording", *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env=os.environ | ONE_THREAD,
        )
        os.setpriority(os.PRIO_PROCESS, self._process.pid, NICENESS)
        self._errors: list[str] = []
        self._readers = [
            threading.Thread(target=self._read_progress, daemon=True),
            threading.Thread(target=self._read_errors, daemon=True),
        ]
        for reader in self._readers:
            reader.start()

    @property
    def running(self) -> bool:
        """Whether it has not ended yet."""
        return self._process.poll() is None

    def result(self) -> TrackedPoses:
        """Return the poses of a job that has ended; raises InhandError where it failed."""
        try:
            for reader in self._readers:
                reader.join()
            if self._process.returncode != 0:
                said = self._errors[-1] if self._errors else "it was ended from outside"
                raise InhandError(f"{self.task.method} could not track: {said}")
            with np.load(self._output) as arrays:
                return TrackedPoses(
                    str(arrays["object"]),
                    arrays["times_ns"],
                    Track(arrays["translations"], arrays["rotations"]),
                )
        finally:
            self._folder.cleanup()

    def cancel(self) -> None:
        """End it, and forget what it has done."""
        self._process.kill()
        self._process.wait()
        for reader in self._readers:
            reader.join()
        self._folder.cleanup()

    def _read_progress(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            for line in lines:
                done, of = line.split()
                self.share = int(done) / max(int(of), 1)

    def _read_errors(self) -> None:
        assert self._process.stderr is not None
        with self._process.stderr as lines:
            for line in lines:
                self._errors = [*self._errors[-20:], line.strip()]
