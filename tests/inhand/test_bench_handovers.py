"""Numbers of people who hand something over, as `inhand bench handovers` tells them."""

from dataclasses import replace

import pytest
from inhand_lab.benchmarks.handover_ids import HandoverIds, check_handover
from rich.console import Console

from inhand.__main__ import main
from inhand.bench_handovers import handovers_table

RIGHT = HandoverIds(6100, 100, ({0: 100}, {1: 100}), 0, 0.018, 0.03, {"front": 2, "left": 3})


def test_two_people_keep_their_numbers_while_they_come_up_to_each_other() -> None:
    found = check_handover(1, cameras=2, frames=60)
    assert found.right
    assert found.unseen == 0
    assert found.frames == sum(found.numbers[0].values()) == 59
    assert 0.0 < found.mean_m < 0.04
    assert list(found.camera_numbers) == ["front", "left"]


@pytest.mark.parametrize(
    "wrong",
    [
        replace(RIGHT, numbers=({0: 60, 2: 40}, {1: 100})),
        replace(RIGHT, numbers=({0: 100}, {0: 100})),
        replace(RIGHT, numbers=({0: 100}, {})),
        replace(RIGHT, with_a_third=1),
    ],
)
def test_another_number_the_other_s_none_or_a_third_person_is_wrong(wrong: HandoverIds) -> None:
    assert RIGHT.right
    assert not wrong.right
    console = Console(width=100, record=True)
    console.print(handovers_table([RIGHT, wrong]))
    assert "right in 1 of 2" in console.export_text()


def test_trials_are_for_handovers_alone(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "rigs", "--trials", "1"]) == 2
    assert "--trials is for handovers" in capsys.readouterr().err
    assert main(["bench", "handovers", "--cameras", "5"]) == 2
    assert "--cameras is from 1 to 4, not 5" in capsys.readouterr().err
