"""Rigs of several simulated cameras."""

import numpy as np
import pytest
from inhand_lab.world.random_streams import random_stream
from inhand_lab.world.rigs import RigSimulation, simulate_rig
from inhand_lab.world.room import in_the_open, wall_place
from inhand_lab.world.simulation import Simulation, simulate
from inhand_lab.world.viewpoint import hidden
from inhand_schemas.joints import Joint


def arrays_of(simulation: Simulation) -> list[bytes]:
    return [
        array.tobytes()
        for array in (
            simulation.joints_in_camera,
            simulation.joint_states,
            simulation.joint_confidences,
            simulation.true_joints_in_camera,
            simulation.translations,
            simulation.rotations,
            simulation.contact,
        )
    ]


@pytest.mark.parametrize("cameras", [1, 3])
def test_a_rigs_first_camera_sees_what_a_single_camera_does(cameras: int) -> None:
    alone = simulate("drinkFromMug", 1, seed=5, frames=90)
    first = simulate_rig("drinkFromMug", 1, seed=5, frames=90, cameras=cameras).cameras[0]
    assert arrays_of(first) == arrays_of(alone)
    for frame in (0, 70):
        seen, expected = first.render(frame), alone.render(frame)
        assert seen.colour.tobytes() == expected.colour.tobytes()
        assert seen.depth.tobytes() == expected.depth.tobytes()


def in_rig(rig: RigSimulation, camera: int) -> tuple[np.ndarray, np.ndarray]:
    placed, seen = rig.rig_from_camera[camera], rig.cameras[camera]
    return placed.apply(seen.true_joints_in_camera), placed.apply(seen.translations)


@pytest.mark.parametrize("interaction", ["drinkFromMug", "hitTennisBall"])
def test_every_camera_sees_the_same_performance_at_its_own_moments(interaction: str) -> None:
    rig = simulate_rig(interaction, 2, seed=4, frames=240, cameras=4)
    assert rig.names == ("front", "left", "right", "high")
    truth = [*in_rig(rig, 0)]
    for camera in range(1, 4):
        times = rig.times_s(camera)
        assert 0.0 <= times[0] < 1 / 30
        assert len(times) in (239, 240)
        for first, other in zip(truth, in_rig(rig, camera), strict=True):
            at = np.arange(240) / 30.0
            flat = first.reshape(240, -1)
            between = [np.interp(times, at, column) for column in flat.T]
            off = np.abs(other.reshape(len(times), -1) - np.transpose(between))
            assert np.median(off) < 5e-4
            assert off.max() < 0.05


def test_cameras_err_by_themselves_and_their_skeletons_depend_on_the_view() -> None:
    rig = simulate_rig("drinkFromMug", 2, seed=4, frames=240, cameras=3)
    errors = [
        rig.rig_from_camera[k].apply(seen.joints_in_camera)[:, Joint.HEAD]
        - rig.rig_from_camera[k].apply(seen.true_joints_in_camera)[:, Joint.HEAD]
        for k, seen in enumerate(rig.cameras)
    ]
    frames = min(len(error) for error in errors)
    for one, other in ((0, 1), (0, 2), (1, 2)):
        shared = np.corrcoef(errors[one][:frames].ravel(), errors[other][:frames].ravel())[0, 1]
        assert abs(shared) < 0.8
    hidden_shares = [(seen.joint_states != 2).mean(axis=0) for seen in rig.cameras]
    assert np.abs(hidden_shares[1] - hidden_shares[2]).max() > 0.5


def test_clocks_drops_and_places_are_seeded_and_within_their_bounds() -> None:
    for seed in range(2):
        rig, again = (simulate_rig("hammerNail", 0, seed, frames=60, cameras=4) for _ in range(2))
        assert rig.clocks == again.clocks
        assert all(map(np.array_equal, rig.dropped, again.dropped))
        assert rig.clocks[0].offset_s == rig.clocks[0].drift == 0.0
        for camera, clock in enumerate(rig.clocks):
            assert abs(clock.offset_s) <= 0.03
            assert abs(clock.drift) <= 30e-6
            said = 1e-9 * rig.stamps_ns(camera)
            assert np.diff(said) == pytest.approx(1 / 30, abs=2e-9)
            assert said * (1 + clock.drift) + clock.offset_s == pytest.approx(
                rig.times_s(camera), abs=2e-9
            )


@pytest.mark.parametrize("interaction", ["pourCream", "paintWall", "hammerNail", "putOnShoe"])
def test_no_camera_stands_behind_a_wall_or_furniture(interaction: str) -> None:
    for seed in range(2):
        rig = simulate_rig(interaction, 0, seed, frames=2, cameras=4)
        wall = wall_place(random_stream(seed, 0, interaction, "room"), rig.cameras[0].room)
        for seen in rig.cameras[1:]:
            position = seen.camera_from_world.inverse().translation
            assert in_the_open(seen.room, wall, position)
            assert not hidden(seen.person, position, seen.furniture)


def test_a_rig_of_no_or_five_cameras_or_of_one_frame_is_refused() -> None:
    for cameras in (0, 5):
        with pytest.raises(ValueError, match="1 to 4 cameras"):
            simulate_rig("drinkFromMug", 0, 0, cameras=cameras)
    with pytest.raises(ValueError, match="2 frames"):
        simulate_rig("drinkFromMug", 0, 0, frames=1)


def test_a_camera_upside_down_sees_the_same_the_other_way_up_and_follows_nobody() -> None:
    upright, turned = (
        simulate_rig("drinkFromMug", 2, seed=4, frames=20, cameras=2, upside_down=down)
        for down in ((), ("left",))
    )
    for one, other in zip(in_rig(upright, 1), in_rig(turned, 1), strict=True):
        assert np.allclose(one, other)
    seen, expected = turned.cameras[1], upright.cameras[1]
    assert np.allclose(seen.translations, expected.translations * [-1.0, -1.0, 1.0])
    assert not seen.joint_states.any()
    shown, usual = (one.draw(3).canvas.labels for one in (seen, expected))
    assert np.mean(shown[::-1, ::-1] != usual) < 0.005
    assert arrays_of(turned.cameras[0]) == arrays_of(upright.cameras[0])
    with pytest.raises(ValueError, match="no camera high; there are: front, left"):
        simulate_rig("drinkFromMug", 2, seed=4, frames=20, cameras=2, upside_down=("high",))
