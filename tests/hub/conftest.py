"""A hub that runs, for the tests of one file, and a session for each member."""

import contextlib
from collections.abc import Iterator

import pytest
from hub_site import PEOPLE, HubSite, made_site, start_hub
from running_rig import RunningRig
from wire import Wire


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[HubSite]:
    """A hub with two cameras, a tracker of the mug, a recorder, a studio, a viewer and outcomes."""
    folder = tmp_path_factory.mktemp("hub")
    with contextlib.closing(RunningRig(folder)) as rig:
        yield start_hub(rig, made_site(folder / "site"))


@pytest.fixture
def wires(site: HubSite) -> Iterator[dict[str, Wire]]:
    """A session for each member."""
    with contextlib.ExitStack() as opened:
        yield {name: opened.enter_context(site.joined(name)) for name in PEOPLE}
