"""The machine gives what scikit-learn's LIBSVM gives."""

import numpy as np
import pytest
from inhand_lab.training.svm_training import fit_sigmoid, train_svm
from inhand_tracker.recognition.pairwise_svm import couple
from sklearn.svm import SVC


def blobs(classes: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    labels = np.arange(60 * classes) % classes
    points = random.normal(size=(len(labels), 6))
    points[np.arange(len(labels)), labels] += 2.0
    return points, labels


@pytest.mark.parametrize("classes", [2, 3, 5])
def test_decisions_are_those_of_libsvm(classes: int) -> None:
    points, labels = blobs(classes)
    ours = train_svm(points, labels)
    theirs = SVC(C=1.0, gamma=ours.gamma, decision_function_shape="ovo").fit(points, labels)
    expected = theirs.decision_function(points)
    if classes == 2:
        expected = -expected[:, None]  # scikit-learn's binary values speak for the second class
    np.testing.assert_allclose(ours.decisions(points), expected, atol=1e-9)


def test_probabilities_sum_to_one_and_follow_the_classes() -> None:
    points, labels = blobs(4)
    unseen, truth = blobs(4, seed=1)
    probabilities = train_svm(points, labels).probabilities(unseen)
    np.testing.assert_allclose(probabilities.sum(axis=1), 1.0)
    assert (probabilities >= 0.0).all()
    accuracy = (probabilities.argmax(axis=1) == truth).mean()
    assert accuracy > 0.7
    assert abs(probabilities.max(axis=1).mean() - accuracy) < 0.1


def test_coupling_recovers_probabilities_that_agree_with_all_pairs() -> None:
    true = np.array([0.6, 0.3, 0.1])
    pairwise = true[:, None] / (true[:, None] + true[None])
    np.fill_diagonal(pairwise, 0.0)
    np.testing.assert_allclose(couple(pairwise[None])[0], true, atol=0.01)


def test_a_sigmoid_fits_the_odds_of_its_data() -> None:
    random = np.random.default_rng(3)
    decisions = random.normal(size=20000)
    positive = random.random(20000) < 1.0 / (1.0 + np.exp(-2.0 * decisions + 0.5))
    slope, shift = fit_sigmoid(decisions, positive)
    assert (slope, shift) == (pytest.approx(-2.0, abs=0.1), pytest.approx(0.5, abs=0.1))
