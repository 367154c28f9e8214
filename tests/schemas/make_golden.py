"""Writes the golden files that are missing; one that is there is never changed.

Golden bytes are what old recordings hold, so they must decode for ever.
"""

from pathlib import Path

import msgspec
from examples import GOLDEN_MESSAGES

GOLDEN = Path(__file__).parent / "golden"


def main(folder: Path) -> None:
    """Write the missing files of each example into ``folder``, and say so."""
    folder.mkdir(exist_ok=True)
    for stem, message in GOLDEN_MESSAGES.items():
        readable = msgspec.json.format(msgspec.json.encode(message), indent=2) + b"\n"
        for suffix, data in ((".msgpack", msgspec.msgpack.encode(message)), (".json", readable)):
            path = folder / (stem + suffix)
            try:
                with path.open("xb") as file:
                    file.write(data)
            except FileExistsError:
                print(f"{path.name} stays as it is")
            else:
                print(f"{path.name} is written")


if __name__ == "__main__":
    main(GOLDEN)
