"""A calibration that changes while a daemon works by it is said."""

import os
from pathlib import Path

from inhand_runtime.calibration_watch import LOOK_S, CalibrationWatch
from inhand_runtime.health import HealthBoard


def test_a_file_that_is_written_anew_or_gone_is_said_until_it_is_as_before(tmp_path: Path) -> None:
    path, health, seconds = tmp_path / "cameras.toml", HealthBoard("capture", "front"), [0.0]
    path.write_text("version = 1")
    watch = CalibrationWatch(path, health, lambda: seconds[0])

    def troubles() -> str:
        seconds[0] += LOOK_S
        watch.look()
        return " | ".join(health.report().troubles)

    assert troubles() == ""
    path.write_text("version = 1 # another one")
    assert "cameras.toml was written anew" in troubles()
    assert "`inhand reload` takes it over" in troubles()
    path.unlink()
    assert "cameras.toml cannot be read any more" in troubles()
    os.mkfifo(path)
    assert "cameras.toml cannot be read any more" in troubles()
    path.unlink()
    path.write_text("version = 1")
    assert troubles() == ""


def test_where_no_file_is_named_nothing_is_said() -> None:
    health = HealthBoard("capture", "front")
    CalibrationWatch(None, health, lambda: 0.0).look()
    assert health.report().troubles == ()
