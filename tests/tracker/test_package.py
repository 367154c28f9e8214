"""The package as a library: its example, and what an import of it costs."""

import doctest
import subprocess
import sys
from pathlib import Path

import inhand_tracker
import numpy as np
import pytest
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.model.model_file import save_model
from people import FRAME_NS, unseen_wave, wave_model


def test_the_docstring_s_example_runs_and_says_what_it_says(tmp_path: Path) -> None:
    save_model(wave_model(), tmp_path / "wedge.model")
    names = {
        "path": tmp_path / "wedge.model",
        "joints": unseen_wave(1)[0],
        "time_ns": FRAME_NS,
        "camera": Intrinsics(260.0, 260.0, 159.5, 119.5, 320, 240),
        "depth": np.full((240, 320), 3.5, np.float32),
        "colour": np.full((240, 320, 3), 110, np.uint8),
    }
    example = doctest.DocTestParser().get_doctest(
        inhand_tracker.__doc__ or "", names, "inhand_tracker", None, None
    )
    assert len(example.examples) == 4
    outcome = doctest.DocTestRunner().run(example)
    assert outcome.failed == 0


def test_every_exported_name_is_there_and_no_other() -> None:
    for name in inhand_tracker.__all__:
        assert getattr(inhand_tracker, name).__name__ == name
    with pytest.raises(AttributeError, match="no attribute 'Tracker'"):
        _ = inhand_tracker.Tracker


def test_an_import_of_the_package_imports_no_mathematics() -> None:
    code = "import sys, inhand_tracker; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
