"""Makes a new object beside the dataset, and moves it in when a person has seen it."""

import tempfile
from pathlib import Path

from inhand_lab.new_objects.object_folder import new_folder
from inhand_runtime.errors import InhandError
from inhand_runtime.exit_codes import DONE
from inhand_tracker.shape.shape import ObjectShape, load_shape

from inhand_studio.objects_page.wishes import Wishes, object_arguments
from inhand_studio.verb import Verb

TOLD_OTHERWISE = ("┏", "┃", "┡", "│", "└", "saved ")
"""What lines begin with that the page says in its own words: those of the verb's table, and where
it was made."""
ON_THE_PAGE = {
    "inhand object: ": "",
    "--unit": "Unit",
    "--size CM": "Longest side",
    "--size": "Longest side",
    "--up": "Points up",
}
"""How the page calls what the verb calls by its options."""


class Making:
    """Runs ``inhand object new`` in a folder of its own within the dataset."""

    def __init__(self, dataset: Path) -> None:
        """Take the dataset's folder, which is made where it is not there; raises InhandError."""
        self._dataset = dataset
        try:
            dataset.mkdir(parents=True, exist_ok=True)
            self._made = tempfile.TemporaryDirectory(dir=dataset, prefix=".new-object-")
        except OSError as error:
            raise InhandError(f"cannot write to {dataset}: {error.strerror}") from None
        self._verb: Verb | None = None
        self._tries = 0
        self._folder: Path | None = None

    @property
    def running(self) -> bool:
        """Whether it is being made."""
        return self._verb is not None and self._verb.running

    @property
    def said(self) -> list[str]:
        """What the verb said, in the words of the page."""
        lines = () if self._verb is None else self._verb.lines
        told = (line for line in lines if line.strip() and not line.startswith(TOLD_OTHERWISE))
        return [self._in_words_of_the_page(line) for line in told]

    @property
    def failed(self) -> bool:
        """Whether it came to nothing."""
        return self._verb is not None and self._verb.code not in (None, DONE)

    def _in_words_of_the_page(self, line: str) -> str:
        for option, name in ON_THE_PAGE.items():
            line = line.replace(option, name)
        return line.replace(f"{self._made.name}/", "")

    def keep_upload(self, name: str, content: bytes) -> Path:
        """Write an uploaded file, and return where; raises InhandError."""
        suffix = "".join(letter for letter in Path(name).suffix.lower() if letter.isalnum())
        path = Path(self._made.name) / f"uploaded.{suffix}"
        try:
            path.write_bytes(content)
        except OSError as error:
            raise InhandError(f"cannot keep {name}: {error.strerror}; make room") from None
        return path

    def begin(self, wishes: Wishes) -> None:
        """Make an object; raises InhandError where one is being made, or something is missing."""
        if self.running:
            raise InhandError("an object is being made: wait for it")
        name, within = wishes.name.strip(), Path(self._made.name) / str(self._tries)
        arguments = object_arguments(wishes, within)
        new_folder(self._dataset, name)
        self._tries += 1
        self._verb = Verb(arguments)
        self._folder = within / "objects" / name

    def result(self) -> ObjectShape | None:
        """Return what was made, None where nothing was or it is not done yet."""
        if self._folder is None or self.running or self.failed:
            return None
        return load_shape(self._folder)

    def save(self) -> Path:
        """Move what was made into the dataset; raises InhandError."""
        if self._folder is None or self.running or self.failed:
            raise InhandError("make the object first, and look at it")
        folder = new_folder(self._dataset, self._folder.name)
        try:
            folder.parent.mkdir(exist_ok=True)
            self._folder.rename(folder)
        except OSError as error:
            raise InhandError(f"cannot write {folder}: {error.strerror}") from None
        self._folder = None
        return folder

    def close(self) -> None:
        """End what runs, and remove what was not saved."""
        if self._verb is not None:
            self._verb.end()
        self._made.cleanup()
