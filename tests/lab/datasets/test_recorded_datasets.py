"""What a rig recorded and somebody labelled is learned from and judged as what was simulated."""

import shutil
from pathlib import Path

import pytest
from inhand_lab.datasets.dataset import Dataset, load_dataset
from inhand_lab.evaluation.folds import leave_one_out
from inhand_lab.evaluation.protocol import Protocol, evaluate
from inhand_runtime.recording import RecordedMessage, RecordingWriter, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message, ObjectPose
from inhand_schemas.topics import LABEL, POSE, AnyTopic
from msgspec import structs
from waving import write_dataset

SITE = Site("home", "kitchen")
DELAY_NS = 40_000_000
METHODS = ("g-hand", "gd-stable-proximate")
TERMS = (("edges",), ())


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    return write_dataset(tmp_path_factory.mktemp("simulated"), frames=20, images=True)


def record(messages: list[RecordedMessage], path: Path) -> None:
    """As a recorder writes it, and a labeller completes it.

    The camera has a name of its own, messages arrive late, a tracker went wrong meanwhile, and
    the labels stand at the end.
    """
    with RecordingWriter(path) as writer:

        def write(topic: AnyTopic, name: str, message: Message, captured_ns: int) -> None:
            writer.write(
                topic.key(SITE, name),
                topic.encode(message),
                received_ns=captured_ns + DELAY_NS,
                captured_ns=captured_ns,
                sequence=message.sequence,
            )

        labels = []
        for recorded in messages:
            message = recorded.message()
            if isinstance(message, ObjectPose):
                labels.append(structs.replace(message, camera="front"))
                lost = structs.replace(labels[-1], state="lost", camera_from_object=None)
                write(POSE, "box", lost, recorded.captured_ns)
            else:
                write(recorded.topic, "front", message, recorded.captured_ns)
        for label in labels:
            write(LABEL, "box", label, label.time_ns)


def test_recorded_and_labelled_data_give_the_figures_of_simulated_data(
    simulated: Dataset, tmp_path: Path
) -> None:
    folder = tmp_path / "recorded"
    shutil.copytree(simulated.folder, folder, ignore=shutil.ignore_patterns("*.mcap"))
    for entry in simulated.entries:
        record(list(read_recording(simulated.path(entry))), folder / entry.file)
    judged = [
        evaluate(Protocol(one, one, tuple(leave_one_out(one)), METHODS, TERMS, 1), 1)
        for one in (simulated, load_dataset(folder))
    ]
    assert judged[1] == judged[0]
    assert len(judged[0]) == 3 * len(METHODS) * len(TERMS)
