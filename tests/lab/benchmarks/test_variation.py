"""Parameters of fusion that are changed by name."""

from dataclasses import replace
from pathlib import Path

import pytest
from inhand_lab.benchmarks.variation import parameter_names, vary
from inhand_runtime.errors import SettingsError
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION

from inhand.__main__ import main


@pytest.mark.parametrize(
    ("setting", "changed", "usual"),
    [
        ("image_temper=1", replace(DEFAULT_FUSION, image_temper=1.0), "image_temper=0.8"),
        ("hypotheses = 50", replace(DEFAULT_FUSION, hypotheses=50), "hypotheses=120"),
        ("leaves=False", replace(DEFAULT_FUSION, leaves=False), "leaves=true"),
        (
            "prior.distrust=0.2",
            replace(DEFAULT_FUSION, prior=replace(DEFAULT_FUSION.prior, distrust=0.2)),
            "prior.distrust=0.1",
        ),
    ],
)
def test_one_parameter_has_another_value(setting: str, changed: object, usual: str) -> None:
    assert vary(setting) == (changed, usual)


@pytest.mark.parametrize("name", list(parameter_names()))
def test_every_parameter_can_be_varied(name: str) -> None:
    value: object = DEFAULT_FUSION
    for step in name.split("."):
        value = getattr(value, step)
    other = {True: "false", False: "true"}[value] if isinstance(value, bool) else "7"
    parameters, _ = vary(f"{name}={other}")
    assert parameters != DEFAULT_FUSION


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("image_temper", "--vary image_temper: write FIELD=VALUE, as image_temper=0.5"),
        ("temper=1", "fusion has no parameter 'temper'; it has: prior.distrust, "),
        ("prior=1", "fusion has no parameter 'prior'; it has: "),
        ("image_temper=warm", "--vary image_temper=warm: 'warm' is no positive number"),
        ("image_temper=-1", "'-1' is no positive number"),
        ("image_temper=nan", "'nan' is no positive number"),
        ("image_temper=", "'' is no positive number"),
        ("looks_to_learn=1.5", "'1.5' is no positive whole number"),
        ("hypotheses=0", "'0' is no positive whole number"),
        ("carries=maybe", "'maybe' is neither true nor false"),
    ],
)
def test_what_cannot_be_varied_is_refused_in_one_line(setting: str, message: str) -> None:
    with pytest.raises(SettingsError) as refused:
        vary(setting)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_command_with_a_wrong_setting_ends_before_anything_is_loaded(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", "ablation", str(tmp_path / "none"), "--vary", "temper=1"]) == 2
    assert "fusion has no parameter 'temper'" in capsys.readouterr().err
    assert main(["bench", "training", "--vary", "image_temper=1"]) == 2
    assert "--vary is for ablation" in capsys.readouterr().err
