"""What a person wants recorded, as ``inhand record`` takes it."""

from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.errors import InhandError


@dataclass(frozen=True)
class Wishes:
    """Who does what with which object (None: nothing that is tracked), before which camera.

    ``seconds`` is how long, 0 until it is stopped.
    """

    participant: str
    left_handed: bool
    interaction: str
    object_name: str | None
    camera: str
    countdown_s: float
    seconds: float


def record_arguments(wishes: Wishes, dataset: Path, config: Path | None) -> list[str]:
    """Return the verb with its arguments; raises InhandError where something must be filled in."""
    if not wishes.participant.strip():
        raise InhandError("write who is recorded (Participant) before the recording")
    if not wishes.interaction.strip():
        raise InhandError("write what is done (Interaction) before the recording")
    arguments = ["record", f"--dataset={dataset}", f"--camera={wishes.camera}"]
    arguments += [f"--participant={wishes.participant.strip()}"]
    arguments += [f"--interaction={wishes.interaction.strip()}"]
    arguments += ["--left-handed"] if wishes.left_handed else []
    arguments += [] if wishes.object_name is None else [f"--object={wishes.object_name}"]
    arguments += [f"--countdown={wishes.countdown_s:g}"]
    arguments += [f"--seconds={wishes.seconds:g}"] if wishes.seconds > 0.0 else []
    return arguments + ([] if config is None else [f"--config={config}"])
