"""What the lab's tests share."""

from collections.abc import Iterator

import pytest
from shared_results import results_shared, run_folder


@pytest.fixture(scope="session", autouse=True)
def _results_are_shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with results_shared(run_folder(tmp_path_factory) / "shared"):
        yield
