"""Files that were damaged at random are judged, and nothing false is saved from them."""

from pathlib import Path

from damaged_recordings import damage


def test_random_damage_is_judged_and_no_false_message_is_saved(tmp_path: Path) -> None:
    verdicts = damage(tmp_path, files=40, seed=7)
    assert sum(verdicts.values()) == 80
    assert min(verdicts[one] for one in ("all recovered", "a part recovered")) > 0
