"""Trains the support vector machine of Darby et al. 2012, section 3.1, with scikit-learn.

Probabilities are LIBSVM's: for every pair of classes a sigmoid on the decision values of five-fold
cross-validation (Platt 2000; Lin, Lin and Weng 2007).
"""

import numpy as np
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.recognition.pairwise_svm import PairwiseSvm
from sklearn.model_selection import StratifiedKFold
from sklearn.svm import SVC

MOST_POSES = 5000
"""Beyond so many, evenly spaced ones are taken: time grows with their square."""
COST = 1.0
FOLDS = 5
NEWTON_STEPS = 100


def train_svm(poses: Array, actions: Indices, seed: int = 0) -> PairwiseSvm:
    """A machine for body poses (N, 60) of actions (N,) numbered from 0, each with five or more."""
    chosen = np.linspace(0, len(poses) - 1, min(len(poses), MOST_POSES)).astype(np.int64)
    poses, actions = poses[chosen], actions[chosen]
    gamma = 1.0 / (poses.shape[1] * poses.var())
    decisions = np.empty((len(poses), _pairs(actions)))
    folds = StratifiedKFold(FOLDS, shuffle=True, random_state=seed)
    for kept, left_out in folds.split(poses, actions):
        machine = _fit(poses[kept], actions[kept], gamma)
        decisions[left_out] = machine.decisions(poses[left_out])
    final = _fit(poses, actions, gamma)
    first, second = np.triu_indices(int(actions.max()) + 1, 1)
    sigmoids = []
    for pair, (one, other) in enumerate(zip(first, second, strict=True)):
        ours = (actions == one) | (actions == other)
        sigmoids.append(fit_sigmoid(decisions[ours, pair], actions[ours] == one))
    return PairwiseSvm(final.vectors, final.coefficients, final.offsets, gamma, np.array(sigmoids))


def fit_sigmoid(decisions: Array, positive: Flags) -> tuple[float, float]:
    """A and B of 1 / (1 + exp(A f + B)) by Newton's method on Platt's smoothed targets."""
    ours, theirs = int(positive.sum()), int((~positive).sum())
    targets = np.where(positive, (ours + 1.0) / (ours + 2.0), 1.0 / (theirs + 2.0))
    parameters = np.array([0.0, np.log((theirs + 1.0) / (ours + 1.0))])
    inputs = np.column_stack((decisions, np.ones(len(decisions))))

    def loss(values: Array) -> float:
        exponents = inputs @ values
        return float((np.logaddexp(0.0, exponents) - (1.0 - targets) * exponents).sum())

    for _ in range(NEWTON_STEPS):
        chances = 1.0 / (1.0 + np.exp(np.clip(inputs @ parameters, -500.0, 500.0)))
        gradient = inputs.T @ (targets - chances)
        if np.abs(gradient).max() < 1e-5:
            break
        curvature = (inputs * (chances * (1.0 - chances))[:, None]).T @ inputs
        way = -np.linalg.solve(curvature + 1e-12 * np.eye(2), gradient)
        size, before = 1.0, loss(parameters)
        while loss(parameters + size * way) > before + 1e-4 * size * gradient @ way:
            size /= 2.0
            if size < 1e-10:
                return float(parameters[0]), float(parameters[1])
        parameters = parameters + size * way
    return float(parameters[0]), float(parameters[1])


def _fit(poses: Array, actions: Indices, gamma: float) -> PairwiseSvm:
    machine = SVC(C=COST, gamma=gamma, decision_function_shape="ovo").fit(poses, actions)
    owners = np.repeat(np.arange(len(machine.n_support_)), machine.n_support_)
    first, second = np.triu_indices(len(machine.n_support_), 1)
    # LIBSVM keeps for each vector its coefficients against the other classes, in their order.
    coefficients = np.zeros((len(owners), len(first)))
    for pair, (one, other) in enumerate(zip(first, second, strict=True)):
        ours, theirs = owners == one, owners == other
        coefficients[ours, pair] = machine.dual_coef_[other - 1, ours]
        coefficients[theirs, pair] = machine.dual_coef_[one, theirs]
    # Of two classes alone scikit-learn gives what speaks for the second.
    sign = -1.0 if len(machine.n_support_) == 2 else 1.0
    return PairwiseSvm(
        np.asarray(machine.support_vectors_),
        sign * coefficients,
        sign * np.asarray(machine.intercept_),
        gamma,
        np.zeros((len(first), 2)),
    )


def _pairs(actions: Indices) -> int:
    count = int(actions.max()) + 1
    return count * (count - 1) // 2
