"""Simulated recordings as a whole."""

import numpy as np
import pytest
from inhand_lab.geometry.transforms import MIRROR
from inhand_lab.motions.performance import ContactKind
from inhand_lab.people.person import People, SimulatedPerson, sample_person
from inhand_lab.sensing.cameras import CAMERAS
from inhand_lab.sensing.skeleton_noise import INFERRED, MISSING, TRACKED
from inhand_lab.world import simulation as world
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.random_streams import GENERATOR_VERSION
from inhand_lab.world.simulation import Casting, Simulation, simulate, simulate_cast
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

KINECT = CAMERAS["kinect"].intrinsics


OBJECTS_OF_VERSION_6 = {
    "pourCream": (-0.070513, -0.227570, 2.362408),
    "answerPhone": (-0.128455, -0.817747, 2.555554),
    "drinkFromMug": (-0.107820, -0.540381, 2.637531),
    "recordVideo": (0.024588, -0.911290, 2.283338),
    "liftWeights": (0.143508, -0.483440, 2.282507),
    "playFlute": (-0.096160, -0.648916, 2.300939),
    "hitTennisBall": (-0.039653, -0.319234, 2.163108),
    "hammerNail": (-0.024494, -0.452742, 2.242067),
    "paintWall": (-0.700926, -0.256037, 2.841682),
    "putOnGlasses": (-0.019145, -0.927413, 2.467883),
    "shakeVinegar": (-0.161822, -0.224084, 2.305311),
    "magnifyText": (-0.077404, -0.235941, 2.135473),
    "putOnShoe": (0.011141, 0.836784, 2.525474),
    "sweepFloor": (-0.135138, 0.218178, 2.088186),
    "hitGolfBall": (0.089273, 0.038924, 2.479011),
}
"""Where the object is in frame 200 of participant 2 of seed 7, metres, in world version 6."""


def bytes_of(simulation: Simulation) -> list[bytes]:
    arrays: list[NDArray[np.generic]] = [
        simulation.joints_in_camera,
        simulation.joint_states,
        simulation.joint_confidences,
        simulation.true_joints_in_camera,
        simulation.translations,
        simulation.rotations,
        simulation.contact,
    ]
    return [array.tobytes() for array in arrays]


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_the_same_seed_makes_the_same_bytes(interaction: str) -> None:
    one, other = (simulate(interaction, 2, seed=7) for _ in range(2))
    assert bytes_of(one) == bytes_of(other)
    first, later = one.render(150), [other.render(frame) for frame in (40, 150)][1]
    assert first.colour.tobytes() == later.colour.tobytes()
    assert first.depth.tobytes() == later.depth.tobytes()


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_usual_people_do_what_they_did_in_world_version_6(interaction: str) -> None:
    assert GENERATOR_VERSION == 6
    place = simulate(interaction, 2, seed=7).translations[200]
    assert place == pytest.approx(OBJECTS_OF_VERSION_6[interaction], abs=2e-6)


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_varied_people_and_what_they_use_are_in_the_image(interaction: str) -> None:
    for participant in range(4):
        cast = Casting(interaction, participant, 9, people="varied")
        simulation = simulate_cast(cast, 360, CAMERAS["kinect"])
        assert len(np.unique(simulation.contact)) > 1
        points = np.concatenate(
            [simulation.true_joints_in_camera.reshape(-1, 3), simulation.translations]
        )
        pixels = points[:, :2] / points[:, 2:] * KINECT.fx + (KINECT.cx, KINECT.cy)
        assert pixels.min() > 0.0
        assert (pixels.max(axis=0) < (KINECT.width, KINECT.height)).all()


def test_another_seed_makes_another_world() -> None:
    one, other = (simulate("drinkFromMug", 2, seed=seed) for seed in (7, 8))
    assert not np.array_equal(one.translations, other.translations)
    assert one.person != other.person


def test_a_participant_is_the_same_person_in_every_interaction() -> None:
    people = [simulate(interaction, 3, seed=7, frames=1).person for interaction in INTERACTIONS]
    assert all(person == people[0] for person in people)
    assert people[0] == sample_person(7, 3)


def test_another_performance_is_the_same_person_before_the_same_camera() -> None:
    one, other = (simulate("sweepFloor", 0, seed=7, performance=number) for number in (0, 1))
    assert one.person == other.person
    assert np.array_equal(one.camera_from_world.translation, other.camera_from_world.translation)
    assert np.abs(one.translations - other.translations).max() > 0.05


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_fewer_frames_are_the_beginning_of_more(interaction: str) -> None:
    short, long = (simulate(interaction, 1, seed=7, frames=frames) for frames in (50, 360))
    assert short.frames == 50
    assert np.allclose(short.translations, long.translations[:50])
    assert np.allclose(short.true_joints_in_camera, long.true_joints_in_camera[:50])


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_shapes_and_values_are_what_the_reader_expects(interaction: str) -> None:
    simulation = simulate(interaction, 0, seed=7, frames=90)
    assert simulation.joints_in_camera.shape == (90, 20, 3)
    assert simulation.joint_states.shape == simulation.joint_confidences.shape == (90, 20)
    assert np.isfinite(simulation.joints_in_camera).all()
    assert (simulation.joint_confidences >= 0).all()
    assert (simulation.joint_confidences <= 1).all()
    assert np.allclose(np.linalg.norm(simulation.rotations, axis=1), 1.0)
    assert np.sum(simulation.rotations[1:] * simulation.rotations[:-1], axis=1).min() > 0.9
    frame = simulation.render(0)
    assert frame.colour.shape == (480, 640, 3)
    assert frame.depth.shape == (480, 640)


def test_an_unknown_interaction_is_named_with_those_there_are() -> None:
    with pytest.raises(ValueError, match=r"juggle.*drinkFromMug"):
        simulate("juggle", 0, seed=0)


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_the_whole_person_and_the_object_are_in_the_image(interaction: str) -> None:
    for participant in range(8):
        simulation = simulate(interaction, participant, seed=9)
        for points, margin in (
            (simulation.true_joints_in_camera.reshape(-1, 3), 10.0),
            (simulation.translations, 0.0),
        ):
            pixels = points[:, :2] / points[:, 2:] * KINECT.fx + (KINECT.cx, KINECT.cy)
            assert pixels.min() > margin
            assert (pixels.max(axis=0) < (KINECT.width - margin, KINECT.height - margin)).all()


def test_a_person_facing_the_camera_has_the_left_hand_at_the_right_of_the_image() -> None:
    joints = simulate("drinkFromMug", 0, seed=9, frames=1).true_joints_in_camera[0]
    assert joints[Joint.SHOULDER_LEFT, 0] > joints[Joint.SHOULDER_RIGHT, 0] + 0.2
    assert joints[Joint.FOOT_LEFT, 1] > joints[Joint.HEAD, 1] + 1.2


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_a_left_handed_person_is_the_mirror_image(
    interaction: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulations = []
    for handedness in ("right", "left"):

        def everybody(
            seed: int, participant: int, people: People, handedness: str = handedness
        ) -> SimulatedPerson:
            fields = vars(sample_person(seed, participant, people)) | {"handedness": handedness}
            return SimulatedPerson(**fields)

        monkeypatch.setattr(world, "sample_person", everybody)
        simulations.append(simulate(interaction, 0, seed=7))
    right, left = (
        simulation.body_in_camera.seen_from(simulation.camera_from_world.inverse())
        for simulation in simulations
    )
    assert np.allclose(left.joints[:, Joint.HAND_LEFT], right.joints[:, Joint.HAND_RIGHT] * MIRROR)
    assert np.allclose(left.joints[:, Joint.KNEE_RIGHT], right.joints[:, Joint.KNEE_LEFT] * MIRROR)
    marked = simulations[0].object_model.marked_vertices
    ours, theirs = (
        (simulation.camera_from_world.inverse() @ simulation.camera_from_object)[150]
        for simulation in simulations
    )
    assert np.allclose(theirs.apply(marked * MIRROR), ours.apply(marked) * MIRROR)
    ours_held, theirs_held = (set(simulation.contact) for simulation in simulations)
    assert (ContactKind.LEFT_HAND in theirs_held) == (ContactKind.RIGHT_HAND in ours_held)
    assert (ContactKind.RIGHT_HAND in theirs_held) == (ContactKind.LEFT_HAND in ours_held)


def test_the_object_is_where_the_hand_is() -> None:
    simulation = simulate("drinkFromMug", 0, seed=7)
    held = simulation.contact == ContactKind.RIGHT_HAND
    hand = simulation.true_joints_in_camera[held, Joint.HAND_RIGHT]
    assert np.linalg.norm(hand - simulation.translations[held], axis=1).max() < 0.15


@pytest.mark.parametrize("interaction", INTERACTIONS)
def test_the_tracker_errs_by_centimetres_and_has_an_inkling_of_it(interaction: str) -> None:
    errors, states, confidences = [], [], []
    for participant in range(6):
        simulation = simulate(interaction, participant, seed=7)
        error = simulation.joints_in_camera - simulation.true_joints_in_camera
        errors.append(np.linalg.norm(error, axis=2))
        states.append(simulation.joint_states)
        confidences.append(simulation.joint_confidences)
    error, state, confidence = (np.stack(each) for each in (errors, states, confidences))
    assert {TRACKED} <= set(np.unique(state)) <= {MISSING, INFERRED, TRACKED}
    assert 0.005 < np.median(error) < 0.05
    assert -0.9 < np.corrcoef(error.ravel(), confidence.ravel())[0, 1] < -0.2


def test_the_trackers_error_is_slow() -> None:
    simulation = simulate("drinkFromMug", 0, seed=7)
    error = (simulation.joints_in_camera - simulation.true_joints_in_camera)[:, Joint.HEAD]
    assert np.corrcoef(error[1:, 0], error[:-1, 0])[0, 1] > 0.8
