"""Keyframes on the disk: each change is written at once, by whoever has the claim."""

from pathlib import Path

import msgspec
from inhand_lab.labelling.keyframes import (
    KeyframeFile,
    LabellingError,
    load_keyframes,
    save_keyframes,
)

from inhand_studio.labelling_page.claim import Claim, claim
from inhand_studio.labelling_page.editing import Editing, opened, saved


def keyframes_path(recording: Path, object_name: str, camera: str | None = None) -> Path:
    """Return where keyframes of an object are kept: beside the recording.

    The camera is named where the recording is of several.
    """
    stem = recording.name.removesuffix(".part").removesuffix(".mcap")
    parts = [stem, object_name, *([] if camera is None else [camera]), "keyframes", "json"]
    return recording.with_name(".".join(parts))


class KeptKeyframes:
    """The file of keyframes of one object; ``claimed`` is whether this one writes it."""

    def __init__(self, path: Path, empty: KeyframeFile) -> None:
        """Claim a file, or read it alone where somebody else has it; ``empty`` is what a new one
        says. Raises LabellingError."""
        self.path = path
        self._empty = empty
        self._claim: Claim | None = claim(path)
        self.trouble: str | None = None

    @property
    def claimed(self) -> bool:
        return self._claim is not None and self._claim.mine

    def load(self) -> Editing:
        """Read what is on the disk; raises LabellingError, also for another object's keyframes."""
        if not self.path.exists():
            return Editing()
        contents = load_keyframes(self.path)
        wanted = self._empty
        if (contents.object, contents.camera) != (wanted.object, wanted.camera):
            raise LabellingError(
                f"{self.path} holds keyframes of {contents.object} in camera {contents.camera}, "
                f"and not of {wanted.object} in {wanted.camera}: move it away"
            )
        return opened(contents.keyframes)

    def take_over(self) -> None:
        """Write it from now on; whoever did before sees it. Raises LabellingError."""
        self.close()
        self._claim = claim(self.path, take_over=True)

    def save(self, editing: Editing) -> Editing:
        """Write what is not on the disk yet, and note that it is.

        What cannot be written stays unsaved, and ``trouble`` says why. Raises LabellingError where
        somebody else has the claim.
        """
        if not editing.unsaved:
            return editing
        if self._claim is None:
            raise LabellingError("another tab or studio labels this object here: take over first")
        with self._claim.held():
            try:
                save_keyframes(self.path, self.contents(editing))
            except LabellingError as error:
                self.trouble = str(error)
                return editing
        self.trouble = None
        return saved(editing, editing.keyframes)

    def contents(self, editing: Editing) -> KeyframeFile:
        """Return what the file is to say."""
        return msgspec.structs.replace(self._empty, keyframes=editing.keyframes)

    def close(self) -> None:
        """Let others write it."""
        if self._claim is not None:
            self._claim.release()
            self._claim = None
