"""What cannot be written fails before the work, whichever verb writes it."""

import argparse
import importlib
from keyword import iskeyword
from pathlib import Path

import pytest

from inhand.__main__ import VERBS, WRITTEN_FILES, WRITTEN_FOLDERS, main
from inhand.results import write_json


@pytest.mark.parametrize(
    "arguments",
    [
        ["train", "{dataset}", "-o", "/proc/nowhere/a.model"],
        ["simulate", "/proc/nowhere/people"],
        ["simulate", "--sheet", "/proc/nowhere/sheet.png"],
        ["import", "motion", "{dataset}", "/proc/nowhere/people"],
        ["evaluate", "{dataset}", "--json", "/proc/nowhere/result.json"],
        ["evaluate", "{dataset}", "--report", "/proc/nowhere/report"],
        ["bench", "tracker", "--json", "/proc/nowhere/result.json"],
        ["demo", "--folder", "/proc/nowhere/demo"],
        ["recording", "recover", "{dataset}/a.mcap", "-o", "/proc/nowhere/b.mcap"],
        ["rate", "--json", "{dataset}"],
    ],
)
def test_what_cannot_be_written_is_refused_before_the_work(
    arguments: list[str],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def worked(_: argparse.Namespace) -> int:
        raise AssertionError("must not begin")

    verb = arguments[0]
    module = importlib.import_module(f"inhand.{verb}_" if iskeyword(verb) else f"inhand.{verb}")
    monkeypatch.setattr(module, "run", worked)
    assert main([text.format(dataset=tmp_path) for text in arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"inhand {verb}: cannot write ")


@pytest.mark.parametrize("verb", VERBS)
def test_no_argument_that_names_a_place_to_write_goes_unchecked(verb: str) -> None:
    """Arguments with a path are read, or their names are among those that are checked."""
    read = {
        *("config", "dataset", "test_on", "bodies", "data", "models", "recording", "files"),
        *(
            "info",
            "sources",
            "source",
            "contrib",
            "others",
            "against",
            "mesh",
            "keyframes",
            "objects",
        ),
        *("check", "hosts", "real", "recordings"),
        *("start", "plain", "objects"),
        # --print writes nothing there, and what does has a line of its own (test_install).
        "root",
    }
    module = importlib.import_module(f"inhand.{verb}_" if iskeyword(verb) else f"inhand.{verb}")
    parser = argparse.ArgumentParser()
    module.add_arguments(parser)
    paths = {action.dest for action in _actions(parser) if action.type is Path}
    assert paths <= {*read, *WRITTEN_FILES, *WRITTEN_FOLDERS}


def _actions(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    actions = list(parser._actions)
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for inner in action.choices.values():
                actions += _actions(inner)
    return actions


def test_a_result_makes_its_folder(tmp_path: Path) -> None:
    write_json(tmp_path / "new/result.json", {"a": 1})
    assert (tmp_path / "new/result.json").read_text() == '{\n  "a": 1\n}\n'
