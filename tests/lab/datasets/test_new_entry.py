"""Entries that are added to a dataset's file."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from inhand_lab.datasets.dataset import DatasetEntry, DatasetError, load_dataset
from inhand_lab.datasets.new_entry import add_entry, put_entry


def _entry(folder: Path, number: int) -> DatasetEntry:
    (folder / "recordings").mkdir(exist_ok=True)
    file = f"recordings/{number}.mcap"
    (folder / file).touch()
    return DatasetEntry(file=file, interaction='say "hé"', participant=f"P {number}", object="mug")


def test_the_first_entry_begins_a_dataset_and_the_next_keeps_what_a_person_wrote(
    tmp_path: Path,
) -> None:
    first, second = _entry(tmp_path, 1), _entry(tmp_path, 2)
    add_entry(tmp_path, first)
    path = tmp_path / "dataset.toml"
    path.write_text(path.read_text() + "# by the window\n")
    add_entry(tmp_path, second)
    assert load_dataset(tmp_path).entries == (first, second)
    assert "# by the window\n" in path.read_text()
    assert sorted(one.name for one in tmp_path.iterdir()) == ["dataset.toml", "recordings"]


def test_of_many_who_add_at_once_each_entry_is_there(tmp_path: Path) -> None:
    entries = [_entry(tmp_path, number) for number in range(20)]
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda entry: add_entry(tmp_path, entry), entries))
    assert {entry.file for entry in load_dataset(tmp_path).entries} == {one.file for one in entries}


def test_a_file_that_takes_no_entry_at_its_end_stays_as_it_is_and_the_entry_is_said(
    tmp_path: Path,
) -> None:
    path = tmp_path / "dataset.toml"
    text = 'format = "inhand-dataset"\nversion = 1\nrecordings = []\n'
    path.write_text(text)
    with pytest.raises(DatasetError, match=r'file = "recordings/1.mcap"'):
        add_entry(tmp_path, _entry(tmp_path, 1))
    assert path.read_text() == text


@pytest.mark.long
def test_on_a_full_disk_the_file_stays_as_it_is(tmp_path: Path) -> None:
    add_entry(tmp_path, _entry(tmp_path, 1))
    path = tmp_path / "dataset.toml"
    before = path.read_text()
    _entry(tmp_path, 2)
    script = (
        "import resource, signal, sys; from pathlib import Path\n"
        "from inhand_lab.datasets.dataset import DatasetEntry\n"
        "from inhand_lab.datasets.new_entry import add_entry, put_entry\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))\n"
        "add_entry(Path(sys.argv[1]), DatasetEntry(file='recordings/2.mcap', interaction='i',"
        " participant='p'))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, str(tmp_path)], capture_output=True, text=True
    )
    assert "DatasetError: cannot write" in done.stderr
    assert path.read_text() == before
    assert not list(tmp_path.glob("*.part"))


def test_an_entry_takes_the_place_of_its_original_and_all_else_stays(tmp_path: Path) -> None:
    (tmp_path / "recordings").mkdir()
    for name in ("a", "b", "c"):
        (tmp_path / f"recordings/{name}.mcap").touch()
    before = (
        'format = "inhand-dataset"\nversion = 1\n\n# about a\n[[recordings]]\n'
        'file = "recordings/a.mcap"  # the first\ninteraction = "i"\nparticipant = "p"\n\n'
        '# about c\n[[recordings]]\nfile = "recordings/c.mcap"\ninteraction = "i"\n'
        'participant = "q"\nobject = "cup"\n'
    )
    (tmp_path / "dataset.toml").write_text(before)
    entry = DatasetEntry(file="recordings/b.mcap", interaction="i", participant="p", object="mug")
    put_entry(tmp_path, entry, ("recordings/a.mcap", "recordings/c.mcap"))
    files = [one.file for one in load_dataset(tmp_path).entries]
    assert files == ["recordings/b.mcap", "recordings/c.mcap"]
    text = (tmp_path / "dataset.toml").read_text()
    assert "# about a\n[[recordings]]" in text
    assert text.endswith(before[before.index("# about c") :])
    put_entry(tmp_path, entry, ("recordings/b.mcap",))
    assert (tmp_path / "dataset.toml").read_text() == text
