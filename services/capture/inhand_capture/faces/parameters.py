"""Every number by which faces are hidden that can be tuned.

``python tests/scenes/hidden_faces.py`` shows what they do on simulated people.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class FaceParameters:
    """Decides what is taken for a face, how much of a picture it takes, and for how long."""

    face_score: float = 0.4
    """Score from which a box of the detector is a face. Its authors take 0.6; halves of drawn faces
    score 0.4 and more, and what is hidden for nothing is little."""
    least_brightness: float = 70.0
    """Mean brightness, of 255, to which a darker picture is brightened before it is looked
    at."""
    face_radius: float = 1.0
    """Radius of what is hidden about a detected face, in widths of its box, which reaches from the
    brows to the chin and from cheek to cheek."""
    same_face: float = 0.3
    """Shared over joint area of two boxes from which they are one face: the authors' number."""
    beyond: float = 0.25
    """How far a close look reaches beyond the end of a picture, in its shorter sides: there its
    mirror image makes half a face a whole one."""
    beside: float = 0.08
    """How far it reaches beyond the other two edges, in shorter sides."""
    head_radius_m: float = 0.22
    """Radius of what is hidden about the middle of a head, metres: nose and chin are 0.14 m from
    it, and a network errs by 0.05 m."""
    usual_shoulders_m: float = 0.36
    """Distance of a usual person's shoulders as networks see them, metres."""
    held_s: float = 1.0
    """Seconds for which a face that is not found again stays hidden."""
    growth_per_s: float = 1.0
    """Growth a second of what is hidden meanwhile, in radii, since the head may move: 0.22 m/s."""
    sure_from: int = 5
    """Number of pictures in which a face was found from which on its place grows while it is held:
    what was found more seldom may be none."""


DEFAULT_FACES = FaceParameters()
