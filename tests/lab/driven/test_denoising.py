"""The body that is found behind a tracker's joints."""

import numpy as np
from inhand_lab.driven.denoising import bone_lengths, denoise, smooth_path
from inhand_schemas.joints import MIRRORED_JOINTS, PARENTS, Joint
from performers import angles_at
from recorded_bodies import recorded, source


def test_denoised_bones_have_one_length_on_both_sides() -> None:
    joints = denoise(recorded(source()).joints, 30.0)
    lengths = np.linalg.norm(joints[:, 1:] - joints[:, PARENTS[1:]], axis=2)
    assert np.ptp(lengths, axis=0).max() < 1e-9
    assert np.allclose(lengths[0], lengths[0, np.array(MIRRORED_JOINTS[1:]) - 1])


def test_denoised_elbows_keep_within_their_limit() -> None:
    body = recorded(source())
    folded = body.joints.copy()
    folded[:, Joint.WRIST_RIGHT] = folded[:, Joint.SHOULDER_RIGHT] + [0.0, 0.0, 0.02]
    joints = denoise(folded, 30.0)
    arm = Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT
    assert angles_at(joints, *arm).min() > 29.9


def test_denoising_brings_fast_noise_nearer_to_the_truth() -> None:
    truth = source().true_joints_in_camera
    noisy = truth + np.random.default_rng(0).normal(0.0, 0.02, truth.shape)
    before, after = (np.linalg.norm(each - truth, axis=2) for each in (noisy, denoise(noisy, 30.0)))
    assert np.median(after) < 0.6 * np.median(before)


def test_a_wrist_that_leaves_its_arm_for_a_moment_is_brought_back() -> None:
    truth = source().true_joints_in_camera[:120]
    measured = truth.copy()
    measured[50:54, Joint.WRIST_RIGHT] += [0.3, 0.2, 0.0]
    error = np.linalg.norm(denoise(measured, 30.0) - truth, axis=2)[:, Joint.WRIST_RIGHT]
    assert error[45:60].max() < 0.08


def test_a_gap_is_bridged() -> None:
    truth = source().true_joints_in_camera[:120]
    measured = truth.copy()
    measured[60:66] = np.nan
    measured[30:40, Joint.FOOT_LEFT] = np.nan
    assert np.linalg.norm(denoise(measured, 30.0) - truth, axis=2).max() < 0.08


def test_bones_are_measured_on_both_sides() -> None:
    lengths = bone_lengths(source().true_joints_in_camera)
    assert lengths.shape == (19,)
    assert np.allclose(lengths, lengths[np.array(MIRRORED_JOINTS[1:]) - 1])


def test_a_straight_path_stays_and_half_of_a_movement_at_the_cut_off() -> None:
    times = np.arange(400)
    straight = np.stack([times, -2.0 * times], axis=1).astype(float)
    weights = np.ones(len(times))
    assert np.abs(smooth_path(straight, weights, 0.2) - straight).max() < 1e-3
    swaying = np.cos(2.0 * np.pi * 0.2 * times)[:, None]
    kept = smooth_path(swaying, weights, 0.2)[100:300] / swaying[100:300]
    assert np.allclose(kept, 0.5, atol=0.01)
