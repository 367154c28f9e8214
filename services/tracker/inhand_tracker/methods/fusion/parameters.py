"""Every number of fusion that can be tuned.

The same numbers serve every object and every interaction. They were chosen on simulated people;
what one of them is worth on a dataset shows `inhand bench ablation DATASET --vary FIELD=VALUE`.
"""

from dataclasses import dataclass, replace

from inhand_tracker.prior.parameters import DEFAULT_PRIOR, PriorParameters
from inhand_tracker.sight.parameters import DEFAULT_SIGHT, SightParameters


@dataclass(frozen=True)
class FusionParameters:
    """How fusion believes, searches an image, and states what it found."""

    prior: PriorParameters = DEFAULT_PRIOR
    """How the body's predictions are combined."""
    sight: SightParameters = DEFAULT_SIGHT
    """How images are read, and how poses are weighed by them and refined."""

    # What is believed before an image is seen (belief).
    carries: bool = True
    """Whether what was seen before is carried over. False only to show what that is worth."""
    leaves: bool = True
    """Whether an object may have been left where it was. False only to show what that is worth."""
    stays_share: float = 0.6
    """Probability that the pose differs from the prior's as it did a frame before."""
    afresh_share: float = 0.2
    """Probability that the pose differs from the prior's in a new way."""
    left_share: float = 0.2
    """Probability that the object stays where it was, whatever the body does."""
    doubt: float = 4.0
    """Factor on the prior's covariance where it speaks against what was believed."""
    left_deviation_m: float = 0.01
    """Standard deviation, in metres, of a frame's movement of an object that was left, or of the
    camera."""
    left_deviation_rad: float = 0.05
    """Standard deviation, in radians, of a frame's turn of an object that was left, or of the
    camera."""
    goes_on_share: float = 0.3
    """Probability, beside those three, that the object goes on as it went, where a posture is
    strange: joints lag and leap more than an object does."""
    goes_on_deviation_m: float = 0.02
    """Standard deviation, in metres, of a frame's change of an object's movement."""
    goes_on_deviation_rad: float = 0.1
    """Standard deviation, in radians, of a frame's change of an object's turning."""
    quickening: float = 2.0
    """Number of times as far as in the frame before that an object goes at the most, from frame to
    frame: of a body that leaps farther, a joint is wrong."""
    leap_m_per_s: float = 3.0
    """Metres a second, beside those, by which what a body makes likely goes at the most."""
    leap_doubt: float = 0.7
    """Probability that a body that leaps is wrong, and the object stays or goes on as it went."""
    leap_lasts_s: float = 0.5
    """Seconds for which such a body may stay wrong."""
    leap_apart_m: float = 0.1
    """Metres from where the object is believed to be within which such a body is right again."""
    wrong_body_share: float = 1e-3
    """Probability at the least, where several cameras' images are searched, that an object goes on
    from where it was believed to be, however unlikely a body makes that. With 1e-5 glasses on a
    head were followed as well, with 1e-8 no longer."""
    forgetting_s: float = 0.3
    """Seconds for which an image makes sure of a pose: one frame errs as the next does."""

    # How an image is searched (search, posterior).
    hypotheses: int = 120
    """Number of hypotheses; cost grows with it (`inhand bench tracker`)."""
    carried_tried_share: float = 0.17
    """Share of the hypotheses at the least, where several cameras' images are searched, that are
    tried about where an object goes on from where it was believed to be: about the means alone, a
    search comes off what moves, step by step. 0.3 was no better."""
    fewest_hypotheses: int = 25
    """Number of hypotheses that are tried with however little effort."""
    refines: bool = True
    """Whether the best hypotheses are refined. False only to show what that is worth."""
    refined_hypotheses: int = 1
    """Number of hypotheses, best first, that are refined, beside the mean of each part believed."""
    least_refined_weight: float = 0.02
    """Weight of a part of the belief below which its mean is not refined."""
    image_temper: float = 0.8
    """Share of an image's log-likelihood that counts: one frame's errors are the next one's too."""
    refinement_temper: float = 0.15
    """Share of the image's information that refinement keeps; neighbouring pixels are not
    independent."""
    least_sharpness: float = 1e-3
    """Sharpness below which no image is taken to be, so that none is divided by nothing."""
    blurred_pixels: float = 40.0
    """Pixels that an object goes from frame to frame where its image counts half: its outline is a
    smear. Decided on real bodies (`inhand simulate --bodies`), where a fast club misled."""
    late_doubt: float = 0.3
    """Share of the way that an object goes between two cameras' images by which it may be
    elsewhere than it is expected to go."""
    late_pixels: float = 3.0
    """Pixels of such doubt by which an image counts half."""
    place_pixels: float = 8.0
    """Pixels by which an object is off in an image, as its camera's place is not sure, where it
    counts half."""
    pull_reach_m: float = 0.015
    """Standard deviation, in metres, of where an image alone has an object from where all have, but
    for its camera's place."""
    pull_reach_rad: float = 0.1
    """The same of how it is turned, in radians."""
    pull_log_likelihood: float = 8.0
    """Log-likelihood ratio by which an image must support what it alone has."""
    looks_to_place: int = 3
    """Number of moments of which one teaches where cameras are."""
    region_margin: float = 1.3
    """Radius, in the object's radii, of what is prepared of an image around each hypothesis."""
    most_pixels: int = 30_000
    """Number of pixels of that part above which several become one, unless the object alone takes
    up half of them: where it may be anywhere, a coarse look finds it."""
    same_mode_m: float = 0.01
    """Metres within which two refined poses are the same one, if they agree in rotation."""
    same_mode_rad: float = 0.1
    """Radians within which two refined poses are the same one, if they agree in translation."""

    # What an image teaches (search).
    looks_to_learn: int = 8
    """Number of images of which one teaches colours."""
    around_rate: float = 0.5
    """Share of that image in the learned colours of the surroundings."""
    learning_rate: float = 0.1
    """Share of that image in the learned colours of the object."""
    learning_log_likelihood: float = 3.0
    """Log-likelihood ratio by which an image must support an estimate to teach its colours."""

    # What is stated (tracker).
    seen_covariance_scale: float = 0.7
    """Factor on the covariance of an estimate that used an image: Laplace's approximation is too
    wide. The share of truths within the 90 % region shows it (`inhand evaluate`)."""
    confidence_samples: int = 256
    """Number of poses drawn from an estimate to find its confidence."""

    # How an image is searched where a posture is strange, and the body says little; or where no
    # pose was found that the image supports.
    unconvincing_log_likelihood: float = 16.0
    """Log-likelihood ratio below which an image does not support any pose that was found."""
    least_narrowed_sharpness: float = 0.3
    """Sharpness below which no image does, wherever it is searched."""
    narrowing_rounds: int = 3
    """Number of rounds in which more hypotheses scatter about the best ones so far (narrowing)."""
    narrowing_share: float = 0.4
    """Share of the deviations of what is believed by which those of the first round scatter; those
    of each further one scatter by half as much."""
    narrowed_hypotheses: int = 120
    """Number of hypotheses in each of these rounds."""
    narrowed_best: int = 20
    """Number of hypotheses, the best ones so far, that those of a round scatter about."""
    narrowed_refined: int = 4
    """Number of hypotheses, best first, that are refined after these rounds."""
    narrowed_off_m: float = 0.05
    """Metres, at the most, that a pose is off then: it lies closer to the truth than what is
    believed is wide, and from far away refinement finds other things than the object."""
    narrowed_off_rad: float = 0.25
    """Radians, at the most, that a pose is off then."""

    def with_effort(self, effort: float) -> "FusionParameters":
        """Return the parameters of a search of which only a share of the work may be done."""
        if effort >= 1.0:
            return self
        fewest = min(self.fewest_hypotheses, self.hypotheses)
        return replace(
            self,
            hypotheses=max(fewest, round(effort * self.hypotheses)),
            refined_hypotheses=max(1, round(effort * self.refined_hypotheses)),
            narrowed_hypotheses=max(1, round(effort * self.narrowed_hypotheses)),
            narrowed_refined=max(1, round(effort * self.narrowed_refined)),
        )


DEFAULT_FUSION = FusionParameters()
