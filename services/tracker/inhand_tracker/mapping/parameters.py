"""Every number of the mapping that can be tuned: where learning stops to be exact, and how it
goes on. `inhand bench training` shows what each costs and finds (docs/training.md)."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MappingParameters:
    """How clusters, radii and nearest body poses are found among many frames."""

    longest_stretch: int = 2048
    """Number of frames, at the most, in which a frame's cluster is looked for: 68 s at 30 Hz; the
    paper's sequences have 360."""

    exact_frames: int = 20_000
    """Number of training frames up to which radii come from all of them."""
    groups: int = 8
    """Number of groups that participants are dealt into beyond that."""
    group_probes: int = 4
    """Number of lists that a search in a group looks through."""

    list_length: int = 500
    """Number of body poses in a list of the search, about."""
    probes: int = 64
    """Number of lists that a search looks through: of a million body poses, 64 of the 2,000 lists
    hold the nearest one practically always."""
    training_poses_per_list: int = 40
    """Number of body poses that a list's centre is found from."""
    training_rounds: int = 5
    """Number of rounds in which the lists' centres are found."""


DEFAULT_MAPPING = MappingParameters()
