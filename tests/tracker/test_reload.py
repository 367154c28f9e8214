"""A tracker that loads its models anew while it runs."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from inhand_runtime.questions import ask
from inhand_schemas.procedures import RELOAD, ReloadReply, ReloadRequest
from inhand_tracker.model.model_file import save_model
from people import wave_model
from running_rig import RunningRig, eventually
from wire import Wire


def _asked(wire: Wire, name: str | None = None) -> list[ReloadReply]:
    request = RELOAD.encode(ReloadRequest(tracker=name))
    pattern = RELOAD.pattern(wire.site)
    return [RELOAD.reply(*one) for one in ask(wire.session, pattern, request, 20.0)]


@pytest.mark.long
def test_a_tracker_follows_its_new_model_and_keeps_the_old_one_where_the_new_is_no_model(
    rig: RunningRig, wire: Wire, tmp_path: Path
) -> None:
    file, model = tmp_path / "thing.model", wave_model()
    save_model(model, file)
    rig.configure(f'[tracker.thing]\nmodel = "{file}"\n')
    tracker = rig.inhand("tracker", "--config", rig.config)
    tracker.said("thing is up")
    assert eventually("an answer", lambda: _asked(wire))[0].objects == ("wedge",)
    assert _asked(wire, "other") == []

    save_model(replace(model, shape=replace(model.shape, name="jug")), file)
    assert _asked(wire, "thing") == [ReloadReply(tracker="thing", objects=("jug",))]
    shutil.copyfile(rig.config, file)
    (reply,) = _asked(wire)
    assert reply.objects == ("jug",)
    assert reply.problem is not None
    assert str(file) in reply.problem
    assert tracker.stop() == 0
    assert "Traceback" not in tracker.stderr
