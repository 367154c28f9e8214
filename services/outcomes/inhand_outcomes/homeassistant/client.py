"""Talks to Home Assistant's broker for as long as the daemon lives, in a thread of its own.

Totals come from the store and are retained, so a broker that is away costs no more than events.
The client's id stays the same: a broker ends what an earlier process left half open, and sends its
last will, before this one says that it is there.
"""

import asyncio
import json
import logging
import threading
from collections.abc import Coroutine, Mapping
from contextlib import suppress
from datetime import date
from typing import Any

import aiomqtt
from aiomqtt.exceptions import MqttConnectError
from inhand_runtime.errors import InhandError
from inhand_runtime.health import HealthBoard

from inhand_outcomes.homeassistant.discovery import (
    FORGET,
    MIGRATE,
    OFF,
    OFFLINE,
    ON,
    ONLINE,
    PAUSE,
    PRESS,
    Topics,
    announcement,
    config_topics,
    removed_entities,
    state_topics,
)
from inhand_outcomes.homeassistant.handover import ForgetDay, Handover
from inhand_outcomes.homeassistant.parameters import DEFAULT_HOME, HomeParameters
from inhand_outcomes.homeassistant.settings import HomeAssistantSettings
from inhand_outcomes.homeassistant.shape import Shape
from inhand_outcomes.homeassistant.state import HomeState
from inhand_outcomes.homeassistant.values import event_message, refreshed_values, retained_values
from inhand_outcomes.pausing import Pausing

log = logging.getLogger(__name__)

QUIET = logging.getLogger("inhand.mqtt")
"""Where the library's own lines go: it has one for each message that a stranger sends too fast."""
QUIET.setLevel(logging.CRITICAL)

TROUBLE = "homeassistant"
COMMANDS = "homeassistant/commands"
"""Key by which the health counts what is no command."""
QOS = 1
REFUSED_LOGIN = (4, 5, 134, 135)
"""Codes by which a broker refuses a user or a password."""
SUBSCRIPTION_REFUSED = 128


class HomeAssistantClient:
    """Keeps Home Assistant told, until stopped."""

    def __init__(
        self,
        settings: HomeAssistantSettings,
        handover: Handover,
        health: HealthBoard,
        forget_day: ForgetDay,
        pausing: Pausing,
        version: str,
        parameters: HomeParameters = DEFAULT_HOME,
    ) -> None:
        """``version`` is what Home Assistant shows as the software's."""
        self._settings = settings
        self._handover = handover
        self._health = health
        self._forget_day = forget_day
        self._pausing = pausing
        self._version = version
        self._parameters = parameters
        self._ready = threading.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread = threading.Thread(target=self._run, name="homeassistant", daemon=True)
        self._forgetting: asyncio.Task[None] | None = None

    def start(self) -> None:
        """Begin, in a thread."""
        self._thread.start()
        self._ready.wait()

    def stop(self) -> None:
        """Say that the device is gone, and end; a broker that does not answer is not waited for."""
        loop, self._loop = self._loop, None
        if loop is not None:
            with suppress(RuntimeError):  # it has ended by itself
                loop.call_soon_threadsafe(self._stop.set)
            self._thread.join(2.0 * self._parameters.farewell_s + self._parameters.first_wait_s)

    def _run(self) -> None:
        try:
            asyncio.run(self._live())
        except Exception as error:
            self._health.trouble(TROUBLE, f"Home Assistant is told nothing any more: {error!r}")
            log.exception("Home Assistant is told nothing any more")
        finally:
            self._ready.set()

    async def _live(self) -> None:
        """Connect again and again, with growing waits, until stopped."""
        loop = asyncio.get_running_loop()
        self._stop, self._news = asyncio.Event(), asyncio.Event()
        self._handover.wake_by(lambda: loop.call_soon_threadsafe(self._news.set))
        self._loop = loop
        self._ready.set()
        failures = 0
        while not self._stop.is_set():
            began = loop.time()
            try:
                shown = self._handover.newest()
                if shown is not None:
                    await self._until_stopped(self._connect(shown[0].shape))
                    continue
                await self._wait(self._news)
                self._news.clear()
            except (aiomqtt.MqttError, InhandError, OSError) as error:
                self._health.trouble(TROUBLE, self._reason(error))
                wait_s = self._wait_s(failures)
                # One that lasted was none that is refused again and again.
                failures = 0 if loop.time() - began > 2.0 * wait_s else failures + 1
                with suppress(TimeoutError):
                    await asyncio.wait_for(self._stop.wait(), self._wait_s(failures))
        self._handover.wake_by(lambda: None)

    async def _until_stopped(self, connection: Coroutine[Any, Any, None]) -> None:
        """Run a connection, which says goodbye by itself in time, or is cut off."""
        task, stop = asyncio.create_task(connection), asyncio.create_task(self._stop.wait())
        await asyncio.wait((task, stop), return_when=asyncio.FIRST_COMPLETED)
        stop.cancel()
        if not task.done():
            await asyncio.wait((task,), timeout=2.0 * self._parameters.farewell_s)
        if not task.done():
            task.cancel()
            return
        task.result()

    def _wait_s(self, failures: int) -> float:
        first_s, longest_s = self._parameters.first_wait_s, self._parameters.longest_wait_s
        return min(first_s * 2.0 ** min(failures, 30), longest_s)

    async def _connect(self, shape: Shape) -> None:
        """Be connected, until stopped or something fails."""
        status = Topics(shape.node).status
        client = aiomqtt.Client(
            self._settings.host,
            self._settings.broker_port,
            username=self._settings.user,
            password=self._settings.password(),
            identifier=shape.node,
            will=aiomqtt.Will(status, OFFLINE, QOS, retain=True),
            tls_context=self._settings.tls_context(),
            keepalive=self._parameters.keep_alive_s,
            timeout=self._parameters.answer_s,
            max_queued_incoming_messages=self._parameters.commands,
            logger=QUIET,
        )
        async with client:
            try:
                await self._converse(_Conversation(client, self._handover, self._version), shape)
            finally:
                # What ends a connection in order sends no last will; on one that is broken the
                # broker does.
                with suppress(aiomqtt.MqttError):
                    await client.publish(
                        status, OFFLINE, QOS, retain=True, timeout=self._parameters.farewell_s
                    )

    async def _converse(self, talk: "_Conversation", shape: Shape) -> None:
        for topic in (Topics(shape.node).commands, Topics(shape.node).status, self._birth(shape)):
            granted = await talk.client.subscribe(topic, QOS)
            if any(_number(code) >= SUBSCRIPTION_REFUSED for code in granted):
                raise InhandError(f"the broker does not let {self._settings.user} read {topic}")
        tasks = [
            asyncio.create_task(one)
            for one in (self._hear(talk, shape), self._tell(talk), self._wait(self._stop))
        ]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    def _birth(self, shape: Shape) -> str:
        """Where Home Assistant says that it is there."""
        return f"{shape.prefix}/status"

    async def _wait(self, event: asyncio.Event) -> None:
        """Wait for an event, or until stopped."""
        waits = [asyncio.create_task(one.wait()) for one in {event, self._stop}]
        try:
            await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for one in waits:
                one.cancel()

    async def _tell(self, talk: "_Conversation") -> None:
        """Send what is new, as soon as the broker has taken what was before."""
        while True:
            self._news.clear()
            shown = self._handover.newest()
            assert shown is not None
            await talk.show(*shown)
            self._health.well(TROUBLE)
            await talk.say(self._parameters.discovered_s)
            with suppress(TimeoutError):
                await asyncio.wait_for(self._news.wait(), self._parameters.refresh_s)
            if not self._news.is_set():
                talk.refresh()

    async def _hear(self, talk: "_Conversation", shape: Shape) -> None:
        """Do what is asked, and announce all again when Home Assistant or the broker's memory of
        this device says so."""
        topics = Topics(shape.node)
        async for message in talk.client.messages:
            topic, payload = str(message.topic), message.payload
            if topic == topics.status:
                if payload == OFFLINE.encode() and not self._stop.is_set():
                    talk.forget_sent()  # the will of a connection that was lost before
                    self._news.set()
            elif topic == self._birth(shape):
                if payload == ONLINE.encode():
                    talk.forget_sent()
                    self._news.set()
            elif message.retain or not self._do(topic.split("/")[2], payload):
                strange = f"{topic}: no command, retained, or not for now: {payload!r:.60}"
                self._health.malformed(COMMANDS, ValueError(strange))

    def _do(self, component: str, payload: object) -> bool:
        """Do what a command says; whether it is one."""
        if component == PAUSE and payload in (ON.encode(), OFF.encode()):
            self._pausing.want(paused=payload == ON.encode())
            return True
        if component == FORGET and payload == PRESS.encode():
            return self._start_forgetting()
        return False

    def _start_forgetting(self) -> bool:
        """Forget the day that is shown, beside all else; whether there is one and none is being
        forgotten yet."""
        shown = self._handover.newest()
        if shown is None or (self._forgetting is not None and not self._forgetting.done()):
            return False
        self._forgetting = asyncio.create_task(self._forget(shown[0].since.date()))
        return True

    async def _forget(self, day: date) -> None:
        try:
            await asyncio.to_thread(self._forget_day, day)
        except InhandError as error:
            self._health.error(f"{day} was not forgotten: {error}")
        else:
            log.info("forgot %s, as somebody wanted in Home Assistant", day)

    def _reason(self, error: Exception) -> str:
        """Why the broker is told nothing now, and the mend."""
        broker = f"Home Assistant's broker {self._settings.host}:{self._settings.broker_port}"
        code = getattr(error, "rc", None)
        if isinstance(error, MqttConnectError) and _number(code) in REFUSED_LOGIN:
            return f"{broker} refuses the user or the password: change user and password_file"
        text = str(error)
        if "CERTIFICATE_VERIFY_FAILED" in text:
            why = text.partition("failed: ")[2].partition(" (_ssl")[0]
            return (
                f"{broker} has a certificate that is not trusted: {why}: change authority, or host"
            )
        return f"{broker} cannot be reached: {text}: totals are kept, and sent when it can"


class _Conversation:
    """What one connection was sent, so that it is sent what is new."""

    def __init__(self, client: aiomqtt.Client, handover: Handover, version: str) -> None:
        self.client = client
        self._handover = handover
        self._version = version
        self._announced: Shape | None = None
        self._announced_at = float("-inf")
        self._sent: dict[str, bytes] = {}
        self._refreshed: Mapping[str, bytes] = {}

    def forget_sent(self) -> None:
        """Send everything again."""
        self._announced = None
        self._sent.clear()

    def refresh(self) -> None:
        """Send again what expires."""
        for topic in self._refreshed:
            self._sent.pop(topic, None)

    async def show(self, state: HomeState, old: tuple[Shape, ...]) -> None:
        """Send what is new of a state: its announcement, values, and that the device is there."""
        if state.shape != self._announced:
            await self._announce(state.shape, old)
        self._refreshed = refreshed_values(state)
        for topic, payload in {**retained_values(state), **self._refreshed}.items():
            await self._retain(topic, payload)
        await self._retain(Topics(state.shape.node).status, ONLINE.encode())

    async def say(self, discovered_s: float) -> None:
        """Send the events that wait, once Home Assistant knows their entities."""
        events = self._handover.take_events()
        if not events or self._announced is None:
            return
        since_s = asyncio.get_running_loop().time() - self._announced_at
        await asyncio.sleep(max(discovered_s - since_s, 0.0))
        for event in events:
            topic, payload = event_message(self._announced.node, event)
            await self.client.publish(topic, payload, QOS)

    async def _announce(self, shape: Shape, old: tuple[Shape, ...]) -> None:
        """Announce a shape, and remove what was announced before and is no more."""
        other_topics = {topic for one in old for topic in config_topics(one)}
        other_topics -= config_topics(shape)
        moved = [
            one
            for one in old
            if one.prefix == shape.prefix and one.single_components != shape.single_components
        ]
        # Home Assistant keeps what people did to an entity when it comes in the other form.
        for topic in sorted({topic for one in moved for topic in config_topics(one)}):
            await self.client.publish(topic, json.dumps(MIGRATE), QOS, retain=True)
        removed = removed_entities(old, shape)
        if removed and not shape.single_components:
            for topic, payload in announcement(shape, self._version, removed):
                await self.client.publish(topic, payload, QOS, retain=True)
        for topic, payload in announcement(shape, self._version):
            await self.client.publish(topic, payload, QOS, retain=True)
        old_values = {topic for one in old for topic in state_topics(one)} - state_topics(shape)
        for topic in sorted(other_topics | old_values):
            await self.client.publish(topic, b"", QOS, retain=True)
        self._announced, self._announced_at = shape, asyncio.get_running_loop().time()
        self._handover.announce(shape)

    async def _retain(self, topic: str, payload: bytes) -> None:
        if self._sent.get(topic) != payload:
            await self.client.publish(topic, payload, QOS, retain=True)
            self._sent[topic] = payload


def _number(code: object) -> int:
    """A reason's number; -1 where there is none."""
    value = getattr(code, "value", code)
    return value if isinstance(value, int) else -1
