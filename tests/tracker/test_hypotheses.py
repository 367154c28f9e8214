"""A tracker that is asked what the poses of its next frame are chosen from."""

from pathlib import Path

import pytest
from inhand_runtime.questions import ask
from inhand_schemas.procedures import HYPOTHESES, HypothesesReply, HypothesesRequest
from inhand_tracker.model.model_file import save_model
from people import wave_model
from running_rig import RunningRig, eventually
from wire import Wire

WAIT_S = 5.0


def _asked(wire: Wire, name: str | None = None) -> list[HypothesesReply]:
    request = HYPOTHESES.encode(HypothesesRequest(tracker=name))
    pattern = HYPOTHESES.pattern(wire.site)
    return [HYPOTHESES.reply(*one) for one in ask(wire.session, pattern, request, WAIT_S)]


@pytest.mark.long
def test_a_tracker_tells_its_hypotheses_of_a_frame_and_nothing_while_none_comes(
    rig: RunningRig, wire: Wire, tmp_path: Path
) -> None:
    file = tmp_path / "thing.model"
    save_model(wave_model(), file)
    rig.configure(
        '[capture.front]\nsource = "simulator"\n'
        f'[tracker.thing]\ncamera = "front"\nmodel = "{file}"\n'
    )
    tracker = rig.inhand("tracker", "--config", rig.config)
    tracker.said("thing is up")
    assert _asked(wire) == []
    rig.inhand("capture", "--config", rig.config).said("is up")

    (reply,) = eventually("hypotheses", lambda: _told(_asked(wire, "thing")))
    assert (reply.tracker, reply.camera) == ("thing", "front")
    (wedge,) = reply.objects
    assert wedge.object == "wedge"
    assert len(wedge.poses) > 20
    assert sum(wedge.weights) == pytest.approx(1.0)
    assert "right hand" in wedge.predictions
    assert _asked(wire, "other") == []
    assert tracker.stop() == 0
    assert "Traceback" not in tracker.stderr


def _told(replies: list[HypothesesReply]) -> list[HypothesesReply]:
    """Replies of frames whose image was looked at."""
    return [one for one in replies if one.objects and one.objects[0].poses]
