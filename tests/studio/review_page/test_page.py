"""The review page of a studio, looked at in Chromium."""

from pathlib import Path

import pytest
from browser import chromium, tab
from drinkers import mug_model
from inhand_lab.datasets.dataset import Dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_schemas.keys import parse_key
from inhand_schemas.messages import ObjectPose, Pose
from inhand_schemas.topics import LABEL, POSE
from inhand_studio.server import serving
from inhand_studio.studio import Studio
from inhand_studio.visit import Visit
from inhand_tracker.model.model_file import save_model
from msgspec.structs import replace
from playwright.sync_api import expect

FRAMES = 60
WORST, WORST_M, USUAL_M = 40, 0.2, 0.05


def _with_estimates(dataset: Dataset) -> Path:
    """Copy its recording, with poses that are off by 5 cm, and in one frame by 20 cm."""
    source = dataset.path(dataset.entries[0])
    path = source.with_name("tracked.mcap")
    with RecordingWriter(path) as writer:
        for one in read_recording(source):
            times = {"received_ns": one.received_ns, "captured_ns": one.captured_ns}
            writer.write(one.key, one.payload, **times, sequence=one.sequence)
            if one.topic is LABEL:
                label = one.message()
                assert isinstance(label, ObjectPose)
                key = POSE.key(parse_key(one.key).site, one.name)
                payload = POSE.encode(_shifted(label))
                writer.write(key, payload, **times, sequence=one.sequence)
    return path


def _shifted(label: ObjectPose) -> ObjectPose:
    assert label.camera_from_object is not None
    x, y, z = label.camera_from_object.translation
    by = WORST_M if label.sequence == WORST else USUAL_M
    pose = Pose((x + by, y, z), label.camera_from_object.rotation)
    return replace(label, camera_from_object=pose, state="tracked", confidence=0.5)


@pytest.mark.long
def test_errors_are_seen_pressed_and_played_and_another_tracker_is_put_beside(
    tmp_path: Path,
) -> None:
    settings = GenerationSettings(["drinkFromMug"], 1, 5, FRAMES, images=False)
    dataset = generate(tmp_path / "dataset", settings, lambda: None)
    save_model(mug_model(), dataset.folder / "mug.model")
    studio = Studio(dataset.folder, recording=_with_estimates(dataset))
    pages = {"Review": "inhand_studio.review_page.page"}
    with (
        serving("127.0.0.1", 0, lambda one: Visit(one, studio, pages, "Review")) as port,
        chromium() as browser,
        tab(browser, f"http://127.0.0.1:{port}") as page,
    ):
        page.get_by_text("median 5.0 cm").wait_for()
        page.get_by_role("button", name="worst").click()
        page.get_by_text(f"Frame {WORST} of {FRAMES}").wait_for()
        page.get_by_text("20.0 cm", exact=True).wait_for()
        expect(page.locator(".mantine-NumberInput-input")).to_have_value(str(WORST))

        plot = page.locator("svg[data-plot]")
        box = plot.bounding_box()
        assert box is not None
        page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 20)
        page.get_by_text(f"Frame {round(0.5 * (FRAMES - 1))} of {FRAMES}").wait_for()
        page.mouse.click(300, 780)
        page.keyboard.press("End")
        page.get_by_text(f"Frame {FRAMES - 1} of {FRAMES}").wait_for()
        page.get_by_role("button", name="Play").click()
        page.get_by_text(f"Frame {FRAMES - 1} of {FRAMES}").wait_for(state="detached")
        page.get_by_text(f"Frame {FRAMES - 1} of {FRAMES}").wait_for()

        page.get_by_text("Track it anew").click()
        page.get_by_role("button", name="Track", exact=True).click()
        page.get_by_text("1: fusion with mug.model").wait_for()

        page.locator(".mantine-TextInput-input:visible").first.fill("nowhere.mcap")
        page.get_by_role("button", name="Open the path").click()
        page.get_by_text("nowhere.mcap does not exist: check the path").wait_for()
