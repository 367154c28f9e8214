"""The controls that write labels into a copy, and name it in the dataset."""

from pathlib import Path

import msgspec
from inhand_lab.labelling.scene import load_scene
from inhand_runtime.wording import counted

from inhand_studio.labelling_page.assistant import Eyes, assistance
from inhand_studio.labelling_page.background import Advance
from inhand_studio.labelling_page.desk import Desk
from inhand_studio.labelling_page.export import (
    Exported,
    export_labels,
    proposed_entry,
    require_named,
    write_entry,
)


class Exporting:
    """The controls of one desk that write its labels."""

    def __init__(self, desk: Desk, dataset: Path, eyes: Eyes) -> None:
        """Add the controls, with what the dataset says of the recording."""
        self._desk, self._dataset, self._eyes = desk, dataset, eyes
        self._entry = proposed_entry(dataset, desk.recording.path, desk.shape.name)
        gui = desk.visit.client.gui
        with gui.add_folder("Write labels"):
            self._interaction = gui.add_text("Interaction", self._entry.interaction)
            self._participant = gui.add_text("Participant", self._entry.participant)
            self._handedness = gui.add_dropdown(
                "Hand", ("right", "left"), initial_value=self._entry.handedness
            )
            self._assisted = gui.add_checkbox("Refined by the images", False)
            self._replace = gui.add_checkbox("Replace what is there", False)
            button = gui.add_button("Write labels")
            button.on_click(desk.visit.action(lambda _: self._export()))

    def _export(self) -> None:
        """Write the copy in the background, then its line of the dataset."""
        desk = self._desk
        desk.require_editable()
        entry = msgspec.structs.replace(
            self._entry,
            interaction=str(self._interaction.value).strip(),
            participant=str(self._participant.value).strip(),
            handedness=self._handedness.value,
        )
        require_named(entry)
        recording, contents = desk.recording, desk.kept.contents(desk.editing)
        assisted, replace = bool(self._assisted.value), bool(self._replace.value)
        found = desk.assistance

        def work(advance: Advance) -> Exported:
            scene = load_scene(recording.path, recording.camera)
            refined = found
            if assisted and (found is None or found.keyframes != contents.keyframes):
                refined = assistance(scene, contents.keyframes, self._eyes, advance)
            symmetries = desk.shape.symmetries
            chosen = refined if assisted else None
            written = export_labels(scene, contents, symmetries, chosen, replace=replace)
            write_entry(self._dataset, recording.path, entry)  # also where the tab is closed by now
            return written

        def done(written: Exported) -> None:
            lines = [
                f"**{written.path.name}**: {counted(written.posed, 'frame')} with a pose, "
                f"{written.absent} without the object; dataset.toml names it, and `inhand train` "
                "reads it.",
                *written.notes,
            ]
            desk.ask("\n\n".join(lines))

        desk.background.start("writing labels", work, done)
