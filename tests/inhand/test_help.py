"""What the help says of verbs agrees with what they do."""

import pytest

from inhand.__main__ import VERBS, main
from inhand.bench import SUBJECTS, SUBJECTS_HELP


def test_the_help_of_bench_names_every_subject(capsys: pytest.CaptureFixture[str]) -> None:
    assert list(SUBJECTS_HELP) == list(SUBJECTS)
    assert all(subject in VERBS["bench"] for subject in SUBJECTS)
    with pytest.raises(SystemExit):
        main(["bench", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    assert all(f"{subject}: {words}" in text for subject, words in SUBJECTS_HELP.items())
