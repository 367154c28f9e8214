"""Every number of recognition that can be tuned.

`inhand recognise DATASET` shows what they are worth together: how often the right object is
recognised and how well it is placed; with `--false-objects`, how often one is recognised falsely.
Where nothing else is said a number was set by hand with these figures in view.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class ArmParameters:
    """Decides what the arms say of a body unlike the learned ones (arm_movement, arm_courses).

    Lengths are in those of an arm, axes to the left, up and ahead of the trunk. A pair of spreads
    is the standard deviation where a recording rests, and what each unit of its movement in
    ``lag`` observations adds, in squares. All were chosen together on simulated people and four of
    UTD-MHAD's eight, each of whom taught the others once
    (`inhand recognise --test-on --taught-by`).
    """

    rate_hz: float = 15.0
    """Number of observations of the arms a second."""
    lag: int = 3
    """Number of observations that a wrist's movement is taken over."""
    wrist_spread: tuple[float, float] = (0.083, 0.225)
    """Spread of other people's wrists about those of a recording."""
    moved_spread: tuple[float, float] = (0.026, 0.245)
    """Spread of other people's movements of wrists about those of a recording."""
    upper_spread: tuple[float, float] = (0.22, 0.0)
    """Spread of other people's directions of upper arms about those of a recording."""

    hanging_wrist: tuple[float, float, float] = (-0.45, -0.97, 0.0)
    """Usual place of a right wrist that hangs; a left one's is its mirror image."""
    hanging_wrist_spread: float = 0.25
    """Spread of wrists that hang."""
    hanging_upper: tuple[float, float, float] = (-0.12, -0.98, 0.0)
    """Usual direction of a right upper arm that hangs."""
    hanging_upper_spread: float = 0.057
    """Spread of upper arms that hang."""
    any_wrist: tuple[float, float, float] = (-0.35, -0.3, 0.35)
    """Usual place of a right wrist that does anything."""
    any_wrist_spread: float = 1.1
    """Spread of wrists that do anything."""
    any_upper: tuple[float, float, float] = (-0.3, -0.6, 0.2)
    """Usual direction of a right upper arm that does anything."""
    any_upper_spread: float = 0.26
    """Spread of upper arms that do anything."""
    slow_spread: float = 0.026
    """Spread of the movements of a wrist that rests."""
    fast_spread: float = 0.23
    """Spread of the movements of a wrist that is used."""

    kept: float = 0.977
    """Share of a score that is left after an observation."""
    waiting: float = 6.0
    """Score that it costs to stay at a place of a recording."""
    skipping: float = 0.11
    """Score that each place costs that is passed over."""
    still_worth: float = 0.12
    """Share of an observation's worth where nothing moves."""
    moved: float = 0.34
    """Movement of a wrist that adds 1 to that share."""
    remembered_s: float = 4.0
    """Seconds of movement that count where a body was like the learned ones before."""

    score: float = 109.0
    """Score of an action from which on the arms speak for it."""
    gain: float = 0.027
    """Log evidence for an action of each point of its score."""
    most_for: float = 2.1
    """Log evidence for an action in a frame, at the most."""
    most_against: float = 0.1
    """Log evidence against an action in a frame, at the most: who pauses goes on."""


@dataclass(frozen=True)
class RecognitionParameters:
    """Decides when movement and images make an action recognised, and which objects are tracked."""

    recognised_probability: float = 0.5
    """Probability from which an action is recognised (Darby et al. 2012, section 5)."""
    doubted_probability: float = 0.2
    """Probability down to which the action that was recognised last may well go on: in the midst of
    the fastest swings of people who were not learned from it falls to 0.4."""

    # What is read of a movement (movement_window). A recogniser is trained with these numbers:
    # with others, train it again.
    rate_hz: float = 30.0
    """Frames a second at which movement is read, and all numbers of frames below are meant."""
    windows: tuple[int, ...] = (15, 45, 90)
    """Numbers of frames that means, spreads and speeds are taken over."""
    lags: tuple[int, ...] = (5, 10, 20)
    """Numbers of frames back to the poses that the present one is compared with."""
    speed_lag: int = 2
    """Number of frames between the poses that give a speed."""

    # What a movement is evidence of (movement_classes). `--false-objects` on a dataset without
    # images shows the doubts; they were chosen there, on two people left out of six.
    caution: float = 1.0
    """Log evidence for no action in every frame: a false object is worse than one found later."""
    caution_without_image: float = 2.0
    """Log evidence for no action, beside ``caution``, in every frame without an image."""
    strangeness: float = 8.0
    """Log evidence against every action of a movement that is e times as far from all classes as
    people's movements are."""
    doubt_with_image: float = 10.0
    """Log evidence against an action of a movement at e times its reach, with an image."""
    doubt_without_image: float = 20.0
    """Log evidence against an action of a movement at e times its reach, without an image, which
    would show whether there is an object."""

    # When the arms speak (movement_classes); what they say is in ``arms``. Chosen with it.
    home_ends: float = 0.4
    """Logarithm of how far, in people's limits, a movement is from all classes, from which on the
    arms speak as well; of other simulated people's taught movements 98 % are nearer."""
    far_from_home: float = 0.7
    """The logarithm from which on the arms speak alone; another sensor's people are farther from
    soon after they begin to move, even where their joints are moved to the canonical body's."""
    arms: ArmParameters = ArmParameters()

    # How evidence adds up over time (class_filter).
    stays: float = 0.997
    """Probability that an action, or none, goes on in the next frame (Darby et al. 2012, section
    5: a change is as rare as a pose 3 σ away)."""
    none_at_first: float = 0.9
    """Probability that no action goes on when a person comes into view."""
    to_none: float = 0.5
    """Share of the changes from an action that lead to none."""
    longest_step_s: float = 1.0
    """Seconds between frames, at the most, that evidence and changes count for."""
    looks_at_once: float = 2.5
    """Number of looks' worth of evidence that the last looks at images are together, beside what
    adds up over time."""
    against_at_once: float = 0.5
    """Share of a movement's log evidence against an action that counts at once beside it, where
    images are looked at; chosen on people of seed 91."""

    # What images are evidence of (presence).
    usual_support_present: float = 24.0
    """Mean support (log-likelihood ratio) of an object that is there, where none was learned:
    that of most objects of simulated people."""
    usual_support_absent: float = 6.0
    """Mean support of an object that is not there, where none was learned; found alike."""
    usual_support_spread: float = 8.0
    """Standard deviation of an object's support, where none was learned; found alike."""
    usual_part_spreads: tuple[float, float, float, float] = (2.4, 4.6, 0.7, 1.5)
    """Standard deviations of the parts of an object's own support (edges, region, interior,
    depth), where none was learned: those of most objects of simulated people."""
    most_against: float = 6.0
    """Log evidence against an object, at the most, of the last looks."""
    trust: float = 1.0
    """Log evidence for an object that every look has beforehand: most looks fall short of those
    of training, on simulated people."""
    part_temper: float = 0.5
    """Share that counts of what each part says by falling short: parts fall short together."""
    recoloured_spread: float = 0.7
    """Standard deviation of what newly learned colours say of the object itself, in those of the
    interior's support; found on simulated people."""
    looks_s: float = 2.0
    """Seconds after which a look counts for a third as much in the mean of looks: one frame errs
    as the next does."""
    forgotten_s: float = 4.0
    """Seconds after which what was seen of an object says a third as much."""

    # Which objects are tracked (cascade).
    unseen_ns: int = 1_000_000_000
    """Nanoseconds without a look at any object after which movement alone decides, and has to say
    more."""
    followed: int = 2
    """Number of actions, likeliest first, whose objects are tracked at the most, beside the one
    that was used last; cost grows with it."""
    worth_following: float = 0.2
    """Share of the probability of all actions from which a second action's object is tracked."""
    turn_frames: int = 3
    """Number of successive frames that another object is looked for, beside the followed ones."""
    sure_probability: float = 0.9
    """Probability from which an action is sure, and other objects are looked for less often."""
    sure_turns: int = 8
    """Number of turns of which one is used to look for others, while an action is sure."""


DEFAULT_RECOGNITION = RecognitionParameters()
