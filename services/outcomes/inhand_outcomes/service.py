"""The daemon of outcomes: what it is made of, and its loop."""

import os
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import date
from importlib.metadata import version

from inhand_runtime.daemon import Arrivals, Daemon, running_daemon
from inhand_runtime.health import HealthBoard
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher
from inhand_runtime.settings import Settings
from inhand_runtime.settings_errors import suggestion
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import Event, ObjectPose, RgbdFrame
from inhand_schemas.procedures import (
    PAUSE_MEASURING,
    RESUME_MEASURING,
    OutcomesReply,
    OutcomesRequest,
)
from inhand_schemas.topics import EVENT, INFO, POSE, RGBD, SKELETONS, topic_of
from msgspec.structs import replace

from inhand_outcomes.capture_clock import CaptureClock
from inhand_outcomes.days import local_day
from inhand_outcomes.floor_watch import FloorWatch
from inhand_outcomes.handling import LEFT_IN_USE
from inhand_outcomes.homeassistant.home import Home, Place
from inhand_outcomes.keeping import open_kept
from inhand_outcomes.memory import Memory
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.pausing import Pausing
from inhand_outcomes.rules import Rules
from inhand_outcomes.settings import OutcomesSettings, check
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.failures import StoreError
from inhand_outcomes.store.floor_maps import floor_maps, keep_floor_map
from inhand_outcomes.store.forgetting import Forget, forget
from inhand_outcomes.store.goal_marks import events_to_publish, judge_goals, mark_published
from inhand_outcomes.store.queries import outcomes_to_publish
from inhand_outcomes.store.retention import Retention, remove_old
from inhand_outcomes.store.saving import Saver, mark_outcomes_published, read_journal
from inhand_outcomes.store.waiting import WaitingOutcomes
from inhand_outcomes.things import load_things, models_of
from inhand_outcomes.watching import Watcher

IDLE_S = 0.25
SAVE_PERIOD_S = 2.0
"""An end at any moment loses what came in this time."""
QUEUE_SAMPLES = 4096
MOST_AT_ONCE = 1000
"""Number of outcomes that are published after one saving; the others follow after the next."""


def run(settings: Settings[OutcomesSettings]) -> None:
    """Measure until SIGTERM or SIGINT.

    Raises SettingsError before anything starts, and InhandError when there is no session, or
    another daemon owns the database.
    """
    check(settings)
    chosen = settings.service
    models = chosen.models or models_of(settings.origin.path)
    things, problems = load_things(models, chosen.objects)
    place = f"{settings.site.realm}/{settings.site.rig}"
    owner = f"outcomes {settings.instance} of {place}, process {os.getpid()}"
    waiting = WaitingOutcomes(lambda: _saver(chosen, owner))

    def own_database() -> None:
        waiting.begin(time.monotonic())

    with running_daemon("outcomes", settings, prepare=own_database) as daemon:
        for problem in problems:
            daemon.health.trouble(f"object {problem}", problem)
        if not things:
            daemon.health.trouble("objects", NO_OBJECTS)
        for name in set(chosen.always_in_use) - set(things):
            unknown = f"always_in_use names {name!r}, which is not measured"
            daemon.health.trouble(f"object {name}", unknown + suggestion(name, things))
        for goal in chosen.goals:
            if goal.object is not None and goal.object not in things:
                unknown = f"the goal {goal.name} counts {goal.object!r}, which is not measured"
                daemon.health.trouble(
                    f"goal {goal.name}", unknown + suggestion(goal.object, things)
                )
        watcher = Watcher(things, place)
        pausing = Pausing()
        home = None
        if chosen.homeassistant is not None:
            site = settings.site
            uses = {name: thing.use for name, thing in things.items()}
            of = Place(site.realm, site.rig, settings.instance)
            home = Home(
                chosen.homeassistant,
                of,
                uses,
                chosen.rules,
                chosen.sure,
                pausing,
                chosen.regions,
            )
        rules, retention = chosen.rules, chosen.retention
        always = frozenset(chosen.always_in_use)
        loop = OutcomesLoop(daemon, watcher, waiting, rules, retention, pausing, home, always)
        with _telling_home(home, chosen, daemon.health):
            loop.run()


def _saver(settings: OutcomesSettings, owner: str) -> Saver:
    """The database that the settings name, as its owner."""
    database = open_kept(settings, owner)
    try:
        return Saver(database, settings.keeping)
    except BaseException:
        database.close()
        raise


@contextmanager
def _telling_home(
    home: Home | None, settings: OutcomesSettings, health: HealthBoard
) -> Iterator[None]:
    """Tell Home Assistant what is handed over, beside the block."""
    if home is None or settings.homeassistant is None:
        yield
        return
    from inhand_outcomes.homeassistant.client import HomeAssistantClient

    def forget_day(day: date) -> None:
        with closing(open_kept(settings)) as database:
            forget(database, Forget(day=day), time.time_ns())

    client = HomeAssistantClient(
        settings.homeassistant, home.handover, health, forget_day, home.pausing, version("inhand")
    )
    client.start()
    try:
        yield
    finally:
        client.stop()


NO_OBJECTS = (
    "no object is measured: name models in the settings of outcomes, or run a tracker by the same "
    "file"
)


NO_RECOGNISER = (
    "nothing is measured of {0}: its tracker has no recogniser, and takes it as always in use. "
    "Train one (inhand train DATASET -o FILE --recogniser --models MODEL), or write "
    'always_in_use = ["{0}"] in the settings of outcomes if it is'
)


@dataclass
class OutcomesLoop:
    """Takes what arrives one by one, and every two seconds keeps and publishes what is settled."""

    daemon: Daemon
    watcher: Watcher
    waiting: WaitingOutcomes
    rules: Rules
    retention: Retention
    pausing: Pausing
    home: Home | None = None
    always_in_use: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        self.clock = CaptureClock()
        # What was not heard of for long is by the poses alone, since skeletons may be far ahead of
        # them where a recording is played fast, and by when they came: others may still wait here.
        self.pose_clock = CaptureClock()
        self._floors = FloorWatch(self.watcher.floors.see)
        self._frames: Arrivals | None = None
        self._memory = Memory(self.watcher)
        self._events: Publisher[Event] = self.daemon.publisher(EVENT, self.daemon.instance)
        self._published = 0
        self._tidied: date | None = None

    def run(self) -> None:
        """Measure until stopped; what is open then is remembered for the next process."""
        self.recall()
        self._answer()
        for topic in (INFO, SKELETONS, POSE):
            self.daemon.subscribe(topic, samples=QUEUE_SAMPLES)
        settled: list[Outcome] = []
        next_save = time.monotonic() + SAVE_PERIOD_S
        while not self.daemon.stop.is_set():
            sample = self.daemon.receive(IDLE_S)
            if self.pausing.take_wanted():
                settled += self._pause_or_go_on()
                next_save = time.monotonic()
            if sample is not None:
                settled += self._hear(sample)
            if time.monotonic() >= next_save:
                self._look_for_floor()
                came_s = None if sample is None else sample.arrived
                settled += self.watcher.end_quiet(self.pose_clock.now_ns(came_s))
                self._save(settled)
                settled = []
                next_save = time.monotonic() + SAVE_PERIOD_S
        self._save(settled)
        self.waiting.close()

    def _look_for_floor(self) -> None:
        """Let frames arrive while one is to be looked at, and no longer: they are large."""
        wanted = not self.pausing.paused and self._wants_frame()
        if wanted and self._frames is None:
            self._frames = self.daemon.subscribe(RGBD, samples=1)
        elif not wanted and self._frames is not None:
            self.daemon.unsubscribe(self._frames)
            self._frames = None
        if self._floors.room is not None:
            self.watcher.room = self._floors.room

    def _hear(self, sample: Received) -> list[Outcome]:
        """Take one message; what is settled by it."""
        topic, key = topic_of(sample.key)
        if topic is POSE:
            pose = self.daemon.decode(POSE, sample)
            if pose is None:
                return []
            self.clock.hear(pose.time_ns)
            self.pose_clock.hear(pose.time_ns, sample.arrived)
            if self.pausing.paused or not self._tells_use(pose):
                return []
            return self.watcher.hear_pose(pose)
        if topic is SKELETONS:
            skeletons = self.daemon.decode(SKELETONS, sample)
            if skeletons is not None:
                self.clock.hear(skeletons.time_ns)
                if self.pausing.paused:
                    return []
                self._floors.hear_skeletons(key.name, skeletons)
                return self.watcher.hear_skeletons(key.name, skeletons)
        if topic is INFO:
            info = self.daemon.decode(INFO, sample)
            if info is not None:
                self.watcher.hear_info(key.name, info)
                self._floors.hear_info(key.name, info)
        if topic is RGBD and not self.pausing.paused and self._wants_frame():
            frame = self.daemon.decode(RGBD, sample)
            if frame is not None:
                self._look_at(key.name, frame, sample.key)
        return []

    def _tells_use(self, pose: ObjectPose) -> bool:
        """Whether a pose is told of a thing because it is in use: without a recogniser a tracker
        tells poses of what lies somewhere, or is not there, as if a hand held it."""
        trouble = f"use of {pose.object}"
        if pose.class_probabilities or pose.object in self.always_in_use:
            self.daemon.health.well(trouble)
            return True
        if pose.object in self.watcher.things:
            self.daemon.health.trouble(trouble, NO_RECOGNISER.format(pose.object))
        return False

    def _wants_frame(self) -> bool:
        return self._floors.wants_frame(self.clock.now_ns())

    def _answer(self) -> None:
        """Let whoever asks pause, and go on."""

        def pause(request: OutcomesRequest) -> OutcomesReply | None:
            return self.pausing.ask(self.daemon.instance, request, paused=True)

        def resume(request: OutcomesRequest) -> OutcomesReply | None:
            return self.pausing.ask(self.daemon.instance, request, paused=False)

        self.daemon.answer(PAUSE_MEASURING, pause)
        self.daemon.answer(RESUME_MEASURING, resume)

    def _pause_or_go_on(self) -> list[Outcome]:
        """At a pause end what is under way: what was achieved counts, and nothing is left in use by
        it."""
        if self.home is not None:
            self.home.look_anew()
        if not self.pausing.paused:
            return []
        return [outcome for outcome in self.watcher.end_all() if outcome.kind != LEFT_IN_USE]

    def _look_at(self, camera: str, frame: RgbdFrame, key: str) -> None:
        """Look for the floor in a frame; damaged depth is counted."""
        try:
            self._floors.hear_frame(camera, frame)
        except MessageError as error:
            self.daemon.health.malformed(key, error)

    def recall(self) -> None:
        """Go on where the last process of this database ended, if it can be read."""
        self.waiting.save((), {}, time.monotonic())
        if self.waiting.saver is not None:
            self._memory.recall(read_journal(self.waiting.saver.database))
            if remembered := self.watcher.followed.values():
                # It waits for the next captures as if its last had just come.
                last_ns = max(one.gathering.last_ns for one in remembered)
                self.clock.hear(last_ns)
                self.pose_clock.hear(last_ns)
            self.pausing.keep(self.waiting.saver.database)
            if self.home is not None:
                self.home.recall(self.waiting.saver.database)
        self._show()

    def _save(self, settled: Sequence[Outcome]) -> None:
        """Keep what is settled with the watcher's memory, and publish what is new."""
        saved = self.waiting.save(settled, self._memory.entries(), time.monotonic())
        if saved is not None and saved.forget:
            self.watcher.forget()
            self._memory = Memory(self.watcher)
            if self.home is not None:
                self.home.look_anew()
        if self.waiting.saver is not None:
            added = () if saved is None else saved.added
            try:
                self.pausing.keep(self.waiting.saver.database)
                self._publish_kept(self.waiting.saver.database, added)
                self._look_after(self.waiting.saver.database)
            except StoreError as error:
                self.daemon.health.error(str(error))
        self._show()

    def _publish_kept(self, database: Database, added: Sequence[Outcome]) -> None:
        """Publish what is kept and was not published, by a process before this one either; raises
        StoreError.

        What was ``added`` just now is known with all its evidence, the rest as it is kept.
        """
        whole = {outcome.id: outcome for outcome in added}
        waiting = outcomes_to_publish(database, MOST_AT_ONCE)
        if not waiting:
            return
        outcomes = [whole.get(outcome.id, outcome) for outcome in waiting]
        for outcome in outcomes:
            self._publish(outcome.message(self._published))
        if self.home is not None:
            self.home.say(outcomes)
        mark_outcomes_published(database, [outcome.id for outcome in outcomes])

    def _look_after(self, database: Database) -> None:
        """Judge the goals, and once a day remove what is old; raises StoreError."""
        now_ns = self.clock.now_ns()
        judge_goals(database, self.rules, now_ns)
        events = events_to_publish(database)
        for event in events:
            self._publish(replace(event, sequence=self._published))
        if events:
            mark_published(database, events)
        if self.home is not None:
            self.home.say_goals(events)
            self.home.show(database, now_ns)
        today = local_day(now_ns, self.rules.zone)
        for kept in self.watcher.floors.to_keep():
            keep_floor_map(database, kept)
        if today != self.watcher.floors.day:
            self.watcher.floors.begin(today, floor_maps(database, today))
        # A capture of a wrong clock, far ahead, must not make all that is kept too old.
        surely = min(today, local_day(time.time_ns(), self.rules.zone))
        if surely != self._tidied:
            remove_old(database, self.retention, surely)
            self._tidied = surely

    def _publish(self, event: Event) -> None:
        self._events.put(event)
        self._published += 1

    def _show(self) -> None:
        """Say in the health whether outcomes are kept."""
        health = self.daemon.health
        if self.waiting.problem is None:
            health.well("database")
        else:
            lost = f"; {self.waiting.lost} outcomes were lost" if self.waiting.lost else ""
            health.trouble("database", self.waiting.problem + lost)
        health.paused = self.pausing.paused
        health.state = "running" if self.waiting.problem is None else "degraded"
