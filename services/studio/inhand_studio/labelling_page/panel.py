"""The controls of one recording and object on the labelling page."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import viser
from inhand_lab.labelling.equal_poses import Pose
from inhand_tracker.body.anchors import ANCHORS

from inhand_studio.controls import put
from inhand_studio.labelling_page import keys
from inhand_studio.labelling_page.placing import from_degrees, to_degrees
from inhand_studio.labelling_page.stage import LOOKS
from inhand_studio.visit import Action, Visit

CAMERA_FRAME = "camera"
OBJECT_FRAME = "object"

Act = Callable[[], None]


class Panel:
    """The controls; ``acts`` are what they do, by the names of ``keys`` and the panel's own."""

    def __init__(self, visit: Visit, frames: int, acts: Mapping[str, Act]) -> None:
        self._gui = visit.client.gui
        self._visit = visit
        self._acts = acts
        self.status = self._gui.add_markdown("")
        self.said = self._gui.add_markdown("")
        self._progress = self._gui.add_progress_bar(0.0, visible=False)
        self._cancel = self._button("Cancel", "cancel")
        self._cancel.visible = False
        self._take_over = self._button("Take over", "take_over")
        self._add_timeline(frames)
        self._add_pose()
        self._add_keyframes()
        self._add_help()
        with self._gui.add_folder("Keys", expand_by_default=False):
            self._gui.add_markdown(keys.described())
        for key in keys.KEYS:
            visit.command(key.about, key.key, self._acting(key.name), key.modifier)

    @property
    def frame(self) -> int:
        """The frame that the slider is at."""
        return int(self._slider.value)

    @property
    def axes(self) -> str:
        """Along whose axes the object is moved: the camera's, its own, or a body part's."""
        return str(self._axes.value)

    @property
    def part(self) -> str | None:
        """The body part that keyframes are relative to; None for the camera."""
        return None if self._part.value == CAMERA_FRAME else str(self._part.value)

    @property
    def typed(self) -> Pose:
        """The pose that its numbers say."""
        place, turns = (np.array(one.value, float) for one in (self._place, self._turns))
        return 0.01 * place, from_degrees(turns)

    @property
    def shows_labels(self) -> bool:
        """Whether labels that the recording holds already are to be shown."""
        return bool(self._labels.value)

    def show_frame(self, frame: int) -> None:
        """Put the slider to a frame."""
        put(self._slider, frame)

    def show_pose(self, pose: Pose | None) -> None:
        """Show a pose in numbers."""
        if pose is not None:
            put(self._place, tuple(np.round(100.0 * pose[0], 2).tolist()))
            put(self._turns, tuple(np.round(to_degrees(pose[1]), 2).tolist()))

    def show_strip(self, drawing: str) -> None:
        """Show a drawing of the recording below the slider."""
        self._strip.content = drawing

    def show_part(self, part: str | None) -> None:
        """Show what keyframes are relative to."""
        put(self._part, part or CAMERA_FRAME)

    def show_claimed(self, claimed: bool) -> None:
        """Let things be edited, or offer to take over."""
        self._take_over.visible = not claimed

    def show_progress(self, doing: str | None, share: float) -> None:
        """Show how much of what runs in the background is done, with a button that ends it."""
        running = doing is not None
        self._progress.visible = self._cancel.visible = running
        if running:
            put(self._progress, round(100.0 * share, 1))
            self._cancel.label = f"Cancel {doing}"

    def show_playing(self, playing: bool) -> None:
        self._play.label = "Stop" if playing else "Play"

    def _add_timeline(self, frames: int) -> None:
        last = max(frames - 1, 1)
        self._slider = self._gui.add_slider("Frame", 0, last, 1, 0)
        self._slider.on_update(self._by_browser("scrub"))
        self._strip = self._gui.add_html("")
        steps = {
            "|<": "previous_keyframe",
            "-10": "back_ten",
            "-1": "back",
            "+1": "on",
            "+10": "on_ten",
            ">|": "next_keyframe",
        }
        group = self._gui.add_button_group("Step", tuple(steps))
        group.on_click(self._visit.action(lambda event: self._acts[steps[event.target.value]]()))
        self._play = self._button("Play", "play")
        look = self._gui.add_button_group("Look at", LOOKS)
        names = dict(zip(LOOKS, ("look_colour", "look_depth", "look_3d"), strict=True))
        look.on_click(self._visit.action(lambda event: self._acts[names[event.target.value]]()))
        self._button("Zoom", "zoom")
        self._labels = self._gui.add_checkbox("Show labels that are there", False)
        self._labels.on_update(self._by_browser("redraw"))

    def _add_pose(self) -> None:
        axes = (OBJECT_FRAME, CAMERA_FRAME, *ANCHORS)
        self._axes = self._gui.add_dropdown("Move along", axes, initial_value=CAMERA_FRAME)
        self._axes.on_update(self._by_browser("redraw"))
        # A form: each key that is hit in a number changes what is shown, and Enter the keyframe.
        form = self._gui.add_form("Pose in the camera's frame (Enter sets it)")
        form.on_submit(self._acting("type_pose"))
        with form:
            self._place = self._gui.add_vector3("Place (cm)", (0.0, 0.0, 0.0), step=0.01)
            self._place.on_update(self._by_browser("preview"))
            self._turns = self._gui.add_vector3("Turns (°)", (0.0, 0.0, 0.0), step=0.01)
            self._turns.on_update(self._by_browser("preview"))

    def _add_keyframes(self) -> None:
        with self._gui.add_folder("Keyframes"):
            self._part = self._gui.add_dropdown(
                "Relative to", (CAMERA_FRAME, *ANCHORS), initial_value=CAMERA_FRAME
            )
            self._part.on_update(self._by_browser("choose_part"))
            for label, name in (
                ("Set keyframe", "set_keyframe"),
                ("Delete keyframe", "delete_keyframe"),
                ("Absent", "mark_absent"),
                ("Copy previous", "copy_previous"),
                ("Undo", "undo"),
                ("Redo", "redo"),
            ):
                self._button(label, name)

    def _add_help(self) -> None:
        with self._gui.add_folder("Help"):
            for label, name in (
                ("Place by one click", "start_placing"),
                ("Start by three clicks", "start_clicks"),
                ("Bring to the image", "snap"),
                ("Take the tracker's estimate", "estimate"),
                ("Refine between keyframes", "assist"),
                ("Go to the worst frame", "worst"),
            ):
                self._button(label, name)

    def _button(self, label: str, name: str) -> viser.GuiButtonHandle:
        button = self._gui.add_button(label)
        button.on_click(self._acting(name))
        return button

    def _acting(self, name: str) -> Action:
        return self._visit.action(lambda _: self._acts[name]())

    def _by_browser(self, name: str) -> Action:
        """Do something when a person changes a control, and not when the page itself does."""
        act = self._acting(name)

        def changed(event: Any) -> None:
            if event.client is not None:
                act(event)

        return changed
