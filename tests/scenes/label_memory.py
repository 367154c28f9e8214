"""Says how much memory `inhand label --assisted` takes at its peak, by how far keyframes are apart.

``python tests/scenes/label_memory.py --every 30 900``: a simulated recording of 901 frames, with
keyframes from the truth so many frames apart. To compare it with another checkout run that one's
Python with ``--inhand``.
"""

import argparse
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.labelling.keyframes import Keyframe, KeyframeFile, save_keyframes

FRAMES = 901
INTERACTION = "drinkFromMug"
CHILD = """
import resource, sys
from inhand.__main__ import main
code = main(sys.argv[1:])
print("peak", resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)
sys.exit(code)
"""


def main() -> None:
    """Simulate once, and label with each distance of keyframes."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--every", type=int, nargs="+", default=[30, 900])
    parser.add_argument("--inhand", default=sys.executable, help="a checkout's Python")
    chosen = parser.parse_args()
    with TemporaryDirectory() as temporary:
        settings = GenerationSettings((INTERACTION,), participants=1, seed=17, frames=FRAMES)
        dataset = generate(Path(temporary) / "people", settings, lambda: None)
        (entry,) = dataset.entries
        path, name = dataset.path(entry), str(entry.object)
        frames = load_frames(path, name)
        for every in chosen.every:
            keyframes = tuple(
                Keyframe(
                    frame=number,
                    time_ns=frames[number].time_ns,
                    camera_from_object=label.camera_from_object,
                )
                for number in range(0, FRAMES, every)
                if (label := frames[number].label) is not None
            )
            file, output = Path(temporary) / "keys.json", Path(temporary) / f"{every}.mcap"
            contents = KeyframeFile(
                recording=path.name, object=name, camera="camera", keyframes=keyframes
            )
            save_keyframes(file, contents)
            arguments = ["label", str(path), "--object", name, "--keyframes", str(file)]
            arguments += ["--assisted", "--replace", "-o", str(output)]
            done = subprocess.run(
                [chosen.inhand, "-c", CHILD, *arguments], check=True, capture_output=True, text=True
            )
            peak = done.stdout.split()[-1]
            print(f"keyframes {every} frames apart: {peak} MB", flush=True)


if __name__ == "__main__":
    main()
