"""Simulated people as if they had been recorded, whose true bodies are known."""

from inhand_lab.driven.recorded_body import RecordedBody
from inhand_lab.world.simulation import Simulation, simulate

SECONDS = 4


def source(interaction: str = "sweepFloor", participant: int = 1) -> Simulation:
    """Somebody to be recorded, whose true body is known; not the beginning, where they wait."""
    return simulate(interaction, participant, seed=3)


def recorded(simulation: Simulation, **changes: object) -> RecordedBody:
    """The measured skeleton of some seconds of it."""
    shown = slice(90, 90 + 30 * SECONDS)
    fields = {
        "joints": simulation.joints_in_camera[shown],
        "states": simulation.joint_states[shown],
        "confidences": simulation.joint_confidences[shown],
        "frame_rate": 30.0,
        "handedness": simulation.person.handedness,
        "participant": 0,
        "recording": 0,
    }
    return RecordedBody(**(fields | changes))  # type: ignore[arg-type]
