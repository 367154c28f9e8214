"""Trains the support vector machine of Darby et al. 2012, section 3.1, with scikit-learn.

Probabilities are LIBSVM's: for every pair of classes a sigmoid on the decision values of five-fold
cross-validation (Platt 2000; Lin, Lin and Weng 2007).
"""

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.recognition.pairwise_svm import PairwiseSvm

from inhand_lab.training.parameters import DEFAULT_TRAINING, TrainingParameters

# The tolerances of Lin, Lin and Weng 2007, algorithm 1.
GRADIENT_TOLERANCE = 1e-5
"""Length of the gradient below which a sigmoid fits."""
RIDGE = 1e-12
"""Added to the curvature, so that it can be inverted."""
DECREASE = 1e-4
"""Share of the decrease that the gradient promises which a step must give."""
SHORTEST_STEP = 1e-10
"""Share of a Newton step below which there is no better sigmoid."""
LARGEST_EXPONENT = 500.0
"""Bound on exponents, so that none overflows."""


def train_svm(
    poses: Array, actions: Indices, parameters: TrainingParameters = DEFAULT_TRAINING
) -> PairwiseSvm:
    """Train on body poses (N, 60) of actions (N,) numbered from 0, each with five or more.

    Of one action alone there is no machine: every pose is of it.
    """
    if not actions.any():
        return PairwiseSvm(
            np.empty((0, poses.shape[1])), np.empty((0, 0)), np.empty(0), 1.0, np.empty((0, 2))
        )
    chosen = np.linspace(0, len(poses) - 1, min(len(poses), parameters.svm_poses)).astype(np.int64)
    poses, actions = poses[chosen], actions[chosen]
    gamma = 1.0 / (poses.shape[1] * poses.var())
    machine = _fit(poses, actions, gamma, parameters.svm_cost)
    decisions = _unseen_decisions(poses, actions, gamma, parameters)
    sigmoids = []
    for pair, (one, other) in enumerate(_pairs(int(actions.max()) + 1)):
        concerned = (actions == one) | (actions == other)
        positive = actions[concerned] == one
        sigmoids.append(fit_sigmoid(decisions[concerned, pair], positive, parameters.sigmoid_steps))
    return PairwiseSvm(
        machine.vectors, machine.coefficients, machine.offsets, gamma, np.array(sigmoids)
    )


def fit_sigmoid(
    decisions: Array, positive: Flags, steps: int = DEFAULT_TRAINING.sigmoid_steps
) -> tuple[float, float]:
    """Fit A and B of 1 / (1 + exp(A f + B)) by Newton's method on Platt's smoothed targets."""
    ours, theirs = int(positive.sum()), int((~positive).sum())
    targets = np.where(positive, (ours + 1.0) / (ours + 2.0), 1.0 / (theirs + 2.0))
    inputs = np.column_stack((decisions, np.ones(len(decisions))))

    def loss(values: Array) -> float:
        exponents = inputs @ values
        return float((np.logaddexp(0.0, exponents) - (1.0 - targets) * exponents).sum())

    sigmoid = np.array([0.0, np.log((theirs + 1.0) / (ours + 1.0))])
    for _ in range(steps):
        exponents = np.clip(inputs @ sigmoid, -LARGEST_EXPONENT, LARGEST_EXPONENT)
        chances = 1.0 / (1.0 + np.exp(exponents))
        gradient = inputs.T @ (targets - chances)
        if np.abs(gradient).max() < GRADIENT_TOLERANCE:
            break
        curvature = (inputs * (chances * (1.0 - chances))[:, None]).T @ inputs
        way = -np.linalg.solve(curvature + RIDGE * np.eye(2), gradient)
        size, before = 1.0, loss(sigmoid)
        while loss(sigmoid + size * way) > before + DECREASE * size * gradient @ way:
            size /= 2.0
            if size < SHORTEST_STEP:
                return float(sigmoid[0]), float(sigmoid[1])
        sigmoid = sigmoid + size * way
    return float(sigmoid[0]), float(sigmoid[1])


def _unseen_decisions(
    poses: Array, actions: Indices, gamma: float, parameters: TrainingParameters
) -> Array:
    """Decision values (N, pairs) of every pose by a machine that was trained without it."""
    from sklearn.model_selection import StratifiedKFold

    decisions = np.empty((len(poses), len(_pairs(int(actions.max()) + 1))))
    folds = StratifiedKFold(parameters.svm_folds, shuffle=True, random_state=parameters.svm_seed)
    for kept, left_out in folds.split(poses, actions):
        machine = _fit(poses[kept], actions[kept], gamma, parameters.svm_cost)
        decisions[left_out] = machine.decisions(poses[left_out])
    return decisions


def _fit(poses: Array, actions: Indices, gamma: float, cost: float) -> PairwiseSvm:
    """Fit a machine without sigmoids."""
    # scikit-learn is loaded only where a recogniser is learned.
    from sklearn.svm import SVC

    machine = SVC(C=cost, gamma=gamma, decision_function_shape="ovo").fit(poses, actions)
    classes = len(machine.n_support_)
    owners = np.repeat(np.arange(classes), machine.n_support_)
    pairs = _pairs(classes)
    # LIBSVM keeps for each vector its coefficients against the other classes, in their order.
    coefficients = np.zeros((len(owners), len(pairs)))
    for pair, (one, other) in enumerate(pairs):
        ours, theirs = owners == one, owners == other
        coefficients[ours, pair] = machine.dual_coef_[other - 1, ours]
        coefficients[theirs, pair] = machine.dual_coef_[one, theirs]
    # Of two classes alone scikit-learn gives what speaks for the second.
    sign = -1.0 if classes == 2 else 1.0
    return PairwiseSvm(
        np.asarray(machine.support_vectors_),
        sign * coefficients,
        sign * np.asarray(machine.intercept_),
        gamma,
        np.zeros((len(pairs), 2)),
    )


def _pairs(classes: int) -> list[tuple[int, int]]:
    """Return every pair of classes, in LIBSVM's order."""
    first, second = np.triu_indices(classes, 1)
    return list(zip(first.tolist(), second.tolist(), strict=True))
