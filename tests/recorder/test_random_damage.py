"""Files that were damaged at random are judged, and nothing false is saved from them."""

import json
import subprocess
import sys
from pathlib import Path

SCENE = Path(__file__).parents[1] / "scenes" / "damaged_recordings.py"


def test_random_damage_is_judged_and_no_false_message_is_saved() -> None:
    # In a process of its own, whose memory it bounds.
    command = [sys.executable, str(SCENE), "--files", "40", "--seed", "7"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    verdicts = json.loads(done.stdout)
    assert verdicts["all recovered"] + verdicts["a part recovered"] > 70
