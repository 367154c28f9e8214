"""Tables of the looks, as somebody reads them on a terminal of 80 columns."""

import io

import pytest
from inhand_runtime.inbox import Received
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, LABEL, POSE, RGBD, SKELETONS
from rich.console import Console, RenderableType
from running_rig import RunningRig

from inhand.rate import NO_DELAY, Meter, rates_table
from inhand.topics import topics_table

SITE = Site("a_long_realm", "a_rig_with_a_name")
NAME = "camera_above_the_kitchen_table_in_the_second_room"
NOW_NS = 1_700_000_000_000_000_000
MINUTE_NS = 60_000_000_000


def shown(table: RenderableType) -> str:
    """The cells of the first column and all other text, as one text without breaks."""
    text = io.StringIO()
    Console(file=text, width=80, height=50).print(table)
    lines = text.getvalue().splitlines()
    assert max(map(len, lines)) <= 80
    assert "…" not in text.getvalue()
    columns = zip(
        *(line.strip("┃│").replace("┃", "│").split("│") for line in lines if "│" in line),
        strict=False,
    )
    return " ".join("".join(cell.strip() for cell in column) for column in columns)


def meter(delay_ns: int = 5_000_000) -> Meter:
    measured = Meter()
    for number in range(3):
        now_ns = NOW_NS + number * 33_000_000
        skeletons = Skeletons(sequence=number, time_ns=now_ns - delay_ns)
        measured.add(
            Received(
                SKELETONS.key(SITE, NAME), SKELETONS.encode(skeletons), SKELETONS.encoding, now_ns
            )
        )
    return measured


def test_rate_shows_every_key_whole() -> None:
    text = shown(rates_table(meter().rates()))
    assert f"skeletons/{NAME}" in text


def test_topics_shows_every_key_and_remark_whole() -> None:
    key = SKELETONS.key(SITE, NAME)
    foreign = key.replace("@v1", "@v2")
    row = {"key": key, "type": "Skeletons", "messages": 4, "remark": None}
    text = shown(topics_table(SITE, [row, row | {"key": foreign, "remark": "update"}]))
    assert f"skeletons/{NAME}" in text
    assert foreign in text


def test_the_delay_of_a_kept_value_is_not_shown() -> None:
    measured = Meter()
    info = CameraInfo(
        sequence=0, time_ns=NOW_NS - 3 * MINUTE_NS, width=64, height=48, fx=50, fy=50, cx=32, cy=24
    )
    key = INFO.key(SITE, "front")
    measured.add(Received(key, INFO.encode(info), INFO.encoding, NOW_NS))
    assert measured.rates()[key]["delay_ms"] is None
    assert f"{NO_DELAY}: a kept value" in "".join(shown_lines(rates_table(measured.rates())))


@pytest.mark.parametrize(
    ("delay_ns", "delay_ms"), [(5_000_000, 5.0), (2 * MINUTE_NS, None), (-2 * MINUTE_NS, None)]
)
def test_times_of_a_replay_are_no_delay(delay_ns: int, delay_ms: float | None) -> None:
    (rate,) = meter(delay_ns).rates().values()
    assert rate["delay_ms"] == delay_ms


def test_numbers_that_trackers_leave_out_or_cameras_share_are_no_losses() -> None:
    measured = Meter()
    for number in (0, 5):
        key, frame = RGBD.key(SITE, "x"), RgbdFrame(sequence=number, time_ns=NOW_NS)
        measured.add(Received(key, RGBD.encode(frame), RGBD.encoding, NOW_NS))
        pose = ObjectPose(
            sequence=number, time_ns=NOW_NS, object="mug", camera="x", state="lost", confidence=0.0
        )
        for topic in (POSE, LABEL):
            key = topic.key(SITE, "mug")
            measured.add(Received(key, topic.encode(pose), topic.encoding, NOW_NS))
    lost = {key.split("/")[3]: rate["lost"] for key, rate in measured.rates().items()}
    assert lost == {"pose": 0, "label": 0, "rgbd": 4}


def shown_lines(table: RenderableType) -> list[str]:
    text = io.StringIO()
    Console(file=text, width=80, height=50).print(table)
    return text.getvalue().splitlines()


@pytest.mark.long
def test_a_silent_site_leaves_no_table_in_a_pipe(rig: RunningRig) -> None:
    looked = rig.done("rate", "--config", rig.config, "--seconds", "0.5")
    assert looked.popen.returncode == 1
    assert looked.stdout == ""
    assert looked.stderr.startswith("inhand rate: nothing answered")
