"""What a studio hears of a rig's cameras, and that nothing comes that nobody looks at."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from examples import EXAMPLES, TIME_NS
from inhand_runtime.daemon import running_daemon
from inhand_runtime.pixels import encode_colour
from inhand_runtime.settings import load_settings
from inhand_schemas.messages import CameraInfo, Message, RgbdFrame
from inhand_schemas.topics import INFO, POSE, PREVIEW, RGBD, SKELETONS, Topic
from inhand_studio.rig import Rig
from inhand_studio.settings import StudioSettings
from running_rig import RunningRig, eventually
from wire import Wire

CAMERA = "kitchen"
STREAMS: tuple[Topic[Any], ...] = (SKELETONS, RGBD, PREVIEW)


def _example(kind: type[Message]) -> Message:
    return next(one for one in EXAMPLES if isinstance(one, kind))


@contextmanager
def _rig(config: Path) -> Iterator[tuple[Rig, Callable[[Callable[[], Any]], Any]]]:
    """A rig, and a wait for something during which it hears."""
    with running_daemon("studio", load_settings(config, "studio", StudioSettings)) as daemon:
        heard = Rig(daemon)

        def comes(condition: Callable[[], Any]) -> Any:
            def once() -> Any:
                while (sample := daemon.receive(0.0)) is not None:
                    heard.take(sample)
                return condition()

            return eventually("what the rig hears", once)

        yield heard, comes


@pytest.mark.long
def test_a_camera_sends_while_somebody_looks_at_it_and_once_for_all(
    rig: RunningRig, wire: Wire
) -> None:
    publishers = {topic: wire.publisher(topic, CAMERA) for topic in STREAMS}

    def wanted() -> list[str]:
        return [topic.stream for topic, one in publishers.items() if one.wanted()]

    def names_a_bad_key() -> bool:
        # Said again until it is heard: a key that no publisher announced has no last value.
        wire.session.put(INFO.key(wire.site, CAMERA).replace(CAMERA, "No-Name"), b"?")
        return any("No-Name" in text for text in heard._daemon.health.report().troubles)

    info = wire.publisher(INFO, CAMERA)
    with _rig(rig.config) as (heard, comes):
        info.put(_example(CameraInfo))  # type: ignore[arg-type]
        comes(lambda: CAMERA in heard.cameras())
        comes(names_a_bad_key)
        assert wanted() == []
        with heard.looking(CAMERA, "frames"), heard.looking(CAMERA, "frames"):
            comes(lambda: wanted() == [SKELETONS.stream, RGBD.stream])
            colour = encode_colour(np.full((2, 2, 3), 200, np.uint8))
            publishers[RGBD].put(RgbdFrame(sequence=7, time_ns=TIME_NS, colour=colour))
            wire.publisher(POSE, "mug").put(_example(POSE.message_type))  # type: ignore[arg-type]
            comes(lambda: len(heard.heard(CAMERA, "frames").pictures) == 1)
            comes(lambda: len(heard.heard(CAMERA, "frames").poses) == 1)
            with heard.looking(CAMERA, "previews"):
                comes(lambda: len(wanted()) == 3)
            comes(lambda: PREVIEW.stream not in wanted())
        comes(lambda: wanted() == [])
        assert heard.heard(CAMERA, "frames").pictures == ()

        # Whoever looks again later has lost nothing meanwhile.
        with heard.looking(CAMERA, "frames"):
            comes(lambda: RGBD.stream in wanted())
            publishers[RGBD].put(RgbdFrame(sequence=99, time_ns=TIME_NS, colour=colour))
            comes(lambda: len(heard.heard(CAMERA, "frames").pictures) == 1)
        assert not any(one.lost for one in heard._daemon.health.report().topics.values())
