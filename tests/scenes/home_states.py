"""States that Home Assistant is to show, and a client that shows them through a real broker."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import date, datetime
from pathlib import Path
from zoneinfo import ZoneInfo

from inhand_outcomes.floor_map import RegionShare
from inhand_outcomes.homeassistant.client import HomeAssistantClient
from inhand_outcomes.homeassistant.handover import Handover
from inhand_outcomes.homeassistant.parameters import HomeParameters
from inhand_outcomes.homeassistant.settings import HomeAssistantSettings
from inhand_outcomes.homeassistant.shape import GoalShape, Shape, object_shape
from inhand_outcomes.homeassistant.state import GoalProgress, HomeState, KindTotal
from inhand_outcomes.pausing import Pausing
from inhand_outcomes.store.queries import LastPlace
from inhand_outcomes.totals import AmountTotal
from inhand_runtime.health import HealthBoard
from inhand_schemas.messages import Pose
from mosquitto import PASSWORD, USER

ZURICH = ZoneInfo("Europe/Zurich")
DAY = date(2026, 11, 30)
SHAPE = Shape(
    node="inhand_0123456789ab",
    label="Inhand home",
    prefix="homeassistant",
    single_components=False,
    objects=(
        object_shape("broom", "sweeping", (), None),
        object_shape("mug", "drinking", (), None),
    ),
    goals=(GoalShape("drink", "volume_ml"),),
    floor=True,
    regions=("under_the_table",),
)
STATE = HomeState(
    shape=SHAPE,
    since=datetime(2026, 11, 30, tzinfo=ZURICH),
    totals={("mug", "sip"): KindTotal(7, {"volume_ml": AmountTotal(7, 210.4567891, 144.0, 44.0)})},
    places={
        "mug": LastPlace(
            "mug",
            1_796_000_000_000_000_000,
            DAY,
            "put_down",
            0,
            Pose((0.4, 0.2, 1.9), (1, 0, 0, 0)),
        )
    },
    in_use={"mug": True},
    goals={"drink": GoalProgress(210.0, 1500.0, False, datetime(2026, 11, 30, tzinfo=ZURICH))},
    floor_png=b"\x89PNG not looked at",
    zone=ZURICH,
    paused=False,
    regions={"under_the_table": RegionShare(0.75, 0.05, 0.25)},
)
QUICK = HomeParameters(
    refresh_s=2.0,
    answer_s=5.0,
    farewell_s=1.0,
    first_wait_s=0.1,
    longest_wait_s=0.4,
    discovered_s=0.1,
)


def without(state: HomeState, name: str) -> HomeState:
    """The state without an object."""
    objects = tuple(one for one in state.shape.objects if one.name != name)
    return replace(state, shape=replace_shape(state.shape, objects=objects))


def replace_shape(shape: Shape, **changes: object) -> Shape:
    """The shape with other fields."""
    from msgspec.structs import replace as replace_fields

    return replace_fields(shape, **changes)


@dataclass
class Shown:
    """A client that shows what is handed over."""

    handover: Handover
    health: HealthBoard
    client: HomeAssistantClient
    pausing: Pausing
    forgotten: list[date] = field(default_factory=list)

    @property
    def troubles(self) -> str:
        """What the health says now."""
        return "; ".join(self.health.report().troubles)


@contextmanager
def showing(
    port: int,
    folder: Path,
    state: HomeState | None = STATE,
    *,
    password: str = PASSWORD,
    parameters: HomeParameters = QUICK,
    **settings: object,
) -> Iterator[Shown]:
    """Show a state until the block ends."""
    file = folder / "given_password"
    file.write_text(password + "\n")
    chosen = {"host": "127.0.0.1", "port": port, "user": USER, "password_file": file, **settings}
    handover, health, forgotten = Handover(parameters), HealthBoard("outcomes", "home"), []
    pausing = Pausing()
    client = HomeAssistantClient(
        HomeAssistantSettings.model_validate(chosen),
        handover,
        health,
        forgotten.append,
        pausing,
        "1.2.3",
        parameters,
    )
    if state is not None:
        handover.show(state, ())
    client.start()
    try:
        yield Shown(handover, health, client, pausing, forgotten)
    finally:
        client.stop()
