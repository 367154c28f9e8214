"""What can be known before a start is checked before a start, by every way to start."""

import os
from pathlib import Path

import pytest
from played import entries, write
from running_rig import RunningRig

RECORDER = '[recorder.disk]\nfolder = "disk"\n'
SIMULATOR = '[capture.front]\nsource = "simulator"\n[capture.front.options]\n'
REPLAY = '[capture.front]\nsource = "replay"\n[capture.front.options]\n'

WRONG = {
    "option": (SIMULATOR + "sed = 1", "rig.toml:7: unknown setting capture.front.options.sed"),
    "interaction": (
        SIMULATOR + 'interaction = "drinkFromMugg"',
        "rig.toml:7: setting capture.front.options.interaction: nobody knows 'drinkFromMugg' "
        "(did you mean drinkFromMug?)",
    ),
    "recording": (REPLAY + 'file = "none.mcap"', "none.mcap does not exist: check the path"),
    "cut": (REPLAY + 'file = "cut.mcap"', "cut.mcap was cut off: `inhand recording recover"),
    "camera": (
        SIMULATOR + '[tracker.mug]\ncamera = "frnt"\nmodel = "x"',
        "there is no table [capture.frnt] (did you mean front?)",
    ),
    "missing": ('[tracker.mug]\nmodel = "none.model"', "none.model does not exist: check the path"),
    "foreign": ('[tracker.mug]\nmodel = "rig.toml"', "rig.toml is no Inhand model"),
    "none": ("[tracker.mug]", "[tracker.mug] names no model"),
}


@pytest.mark.long
@pytest.mark.parametrize("case", WRONG)
def test_the_same_line_and_code_by_check_config_up_and_the_daemon(
    rig: RunningRig, case: str
) -> None:
    settings, line = WRONG[case]
    whole = write(rig.folder / "whole.mcap", entries(3))
    (rig.folder / "cut.mcap").write_bytes(whole.read_bytes()[:2000])
    rig.configure(f"{RECORDER}\n{settings}")
    service = "tracker" if "[tracker" in settings else "capture"
    started = {
        "check": rig.inhand(service, "--config", rig.config, "--check-config"),
        "daemon": rig.inhand(service, "--config", rig.config),
        "up": rig.inhand("up", "--config", rig.config),
    }
    for way, process in started.items():
        assert process.wait() == 2, way
        assert line in process.stderr, way
        assert "is up" not in process.stderr, way
        assert "Traceback" not in process.stderr, way
    assert "has wrong settings (see above): nothing was started" in started["up"].stderr
    assert not (rig.folder / "disk").exists()


@pytest.mark.long
def test_a_rig_that_is_right_is_valid_as_a_whole_from_any_folder(rig: RunningRig) -> None:
    write(rig.folder / "whole.mcap", entries(3))
    rig.configure(f'{RECORDER}\n{REPLAY}file = "whole.mcap"\n')
    checked = rig.done(
        "up", "--config", os.path.relpath(rig.config, Path(__file__).parents[2]), "--check-config"
    )
    assert checked.popen.returncode == 0, checked.stderr
    assert checked.stdout == "capture front, recorder disk: the settings are valid\n"
    assert not (rig.folder / "disk").exists()
