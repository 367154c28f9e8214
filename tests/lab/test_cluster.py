"""Work on a Dask cluster of some worker processes, of which one is killed now and then."""

import json
import signal
from pathlib import Path
from typing import Any

import pytest
from dask_cluster import DaskCluster, dask_cluster, die, die_once, fail, process_of
from inhand_lab.cluster import on_cluster
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.workers import in_processes, working
from inhand_runtime.errors import InhandError, SettingsError
from running_rig import RunningRig, eventually

from inhand.__main__ import main

pytestmark = pytest.mark.long


def test_tasks_are_done_by_workers_in_order_though_one_is_killed(
    rig: RunningRig, tmp_path: Path
) -> None:
    done: list[tuple[int, int]] = []
    with dask_cluster(rig, 2) as cluster, working(cluster.address) as workers:
        assert workers == 2
        results = in_processes(process_of, range(8), 1, done.append)
        assert [task for task, _ in results] == list(range(8))
        assert sorted(done) == results
        assert {process for _, process in results} == {one.pid for one in cluster.workers}
        with pytest.raises(DatasetError, match="broken: mend it"):
            in_processes(fail, range(8), 1)
        tasks = [(tmp_path / "mark", number) for number in range(8)]
        assert in_processes(die_once, tasks, 1) == list(range(8))
        ended = [one.popen.poll() for one in cluster.workers]
        assert sorted(map(str, ended)) == ["-9", "None"]
    here = in_processes(process_of, range(2), 1)
    assert len({process for _, process in here}) == 1


def test_a_task_that_no_worker_survives_ends_with_its_reason(rig: RunningRig) -> None:
    with (
        dask_cluster(rig, 1, deaths=0) as cluster,
        working(cluster.address),
        pytest.raises(InhandError, match="ended again and again at one task, most often because"),
    ):
        in_processes(die, range(1), 1)


def evaluated(path: Path) -> dict[str, Any]:
    result: dict[str, Any] = json.loads(path.read_text())
    del result["seconds"]
    return result


def retracked_with_a_kill(rig: RunningRig, cluster: DaskCluster, here: Path) -> None:
    """Track a dataset's recordings again here and on a cluster, of which a worker is killed while
    recordings grow; the files are the same."""
    files = sorted((here / "recordings").glob("*.mcap"))
    tracked = ["recording", "retrack", *map(str, files), "--model", f"{here}.model", "-o"]
    there = rig.folder / "tracked_there"
    process = rig.inhand(*tracked, there, "--cluster", cluster.address)
    eventually("a recording that grows", lambda: list(there.glob("*.mcap.part")))
    cluster.workers[-1].stop(signal.SIGKILL)
    assert main([*tracked, str(rig.folder / "tracked_here")]) == 0
    assert process.wait() == 0, process.stderr
    assert sorted(path.name for path in there.iterdir()) == [path.name for path in files]
    for path in there.iterdir():
        assert path.read_bytes() == (rig.folder / "tracked_here" / path.name).read_bytes()


@pytest.mark.exhaustive
def test_a_dataset_is_simulated_retracked_and_evaluated_as_it_is_here_though_workers_are_killed(
    rig: RunningRig, tmp_path: Path
) -> None:
    what = ["--interactions", "drinkFromMug", "--participants", "4", "--seed", "1"]
    what += ["--frames", "60", "--no-images"]
    with dask_cluster(rig, 3) as cluster:
        there = ["--cluster", cluster.address]
        for name, more in (("here", []), ("there", there)):
            assert main(["simulate", str(tmp_path / name), *what, *more]) == 0
            model = str(tmp_path / f"{name}.model")
            assert main(["train", str(tmp_path / name), "-o", model, *more]) == 0
        for path in (tmp_path / "here").rglob("*.*"):
            other = tmp_path / "there" / path.relative_to(tmp_path / "here")
            assert path.read_bytes() == other.read_bytes()
        assert (tmp_path / "here.model").read_bytes() == (tmp_path / "there.model").read_bytes()
        retracked_with_a_kill(rig, cluster, tmp_path / "here")
        evaluate = ["evaluate", str(tmp_path / "here"), "--no-images", "--methods", "fusion"]
        assert main([*evaluate, "--json", str(tmp_path / "here.json")]) == 0
        process = rig.inhand(
            *evaluate, "--json", tmp_path / "there.json", "--progress-lines", *there
        )
        process.said("progress: evaluating 1/")
        cluster.workers[0].stop(signal.SIGKILL)
        assert process.wait() == 0, process.stderr
    assert evaluated(tmp_path / "here.json") == evaluated(tmp_path / "there.json")


def test_what_is_no_cluster_of_ours_is_said_in_one_line(
    rig: RunningRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("inhand_lab.cluster.CONNECT_S", 1)
    with pytest.raises(SettingsError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        on_cluster("tcp://127.0.0.1:9").__enter__()
    with pytest.raises(SettingsError, match="no Dask scheduler answers at nonsense"):
        on_cluster("nonsense://x").__enter__()
    with dask_cluster(rig, 1, threads=2) as cluster:
        with pytest.raises(SettingsError, match="works on 2 tasks at once, and ours need a proce"):
            on_cluster(cluster.address).__enter__()
        cluster.workers[0].stop()
        with pytest.raises(SettingsError, match="has no worker: start some with `dask worker tcp"):
            eventually("no worker", lambda: on_cluster(cluster.address).__enter__())
