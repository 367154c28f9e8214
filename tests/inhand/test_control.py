"""A camera that is changed while it runs."""

import pytest
from running_rig import RunningRig, eventually


@pytest.mark.long
def test_a_source_that_cannot_be_changed_says_so_and_one_that_is_not_there_does_not_answer(
    rig: RunningRig,
) -> None:
    rig.configure('[capture.front]\nsource = "simulator"\nwait_for_reader_s = 0\n')
    missed = rig.done("control", "front", "iso=400", "--config", rig.config, "--seconds", "0.5")
    assert missed.popen.returncode == 1
    assert "front does not answer" in missed.stderr
    daemon = rig.inhand("capture", "--config", rig.config)
    daemon.said("is up")

    def refusal() -> str:
        refused = rig.done("control", "front", "iso=400", "--config", rig.config)
        assert refused.popen.returncode == 1
        return refused.stderr

    eventually("an open source", lambda: "nothing of this source can be changed" in refusal())
    assert daemon.stop() == 0


@pytest.mark.long
@pytest.mark.parametrize("setting", ["iso", "iso=", "iso=much", "=3"])
def test_a_setting_that_is_none_is_refused(rig: RunningRig, setting: str) -> None:
    done = rig.done("control", "front", setting)
    assert done.popen.returncode == 2
    assert "OPTION=VALUE" in done.stderr or "neither a number" in done.stderr
