"""The alerts: right for Prometheus, of metrics that there are, each with its mend."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from examples import RUNNING
from inhand_runtime.roll import Roll
from inhand_schemas.keys import Site
from inhand_schemas.messages import Latency, TopicHealth
from msgspec.structs import replace
from prometheus_client import CollectorRegistry, generate_latest
from running_rig import ROOT

from inhand.deployment import deploy_folder
from inhand.health_metrics import HealthMetrics

RULES = deploy_folder() / "prometheus/inhand.rules.yml"
ALERTS = re.findall(r"- alert: (\w+)", RULES.read_text())
PROMTOOL = shutil.which("promtool")

needs_promtool = pytest.mark.skipif(
    PROMTOOL is None and "PROMTOOL_REQUIRED" not in os.environ, reason="there is no promtool"
)
HEALTH = replace(
    RUNNING,
    effort=1.0,
    shutter_closed=False,
    latency_ms=Latency(p50=1.0, p99=2.0),
    topics={"inhand/@v1/rig/rgbd/front": TopicHealth(received=1, late_ms=1.0)},
)


def _promtool(*arguments: str | Path) -> None:
    done = subprocess.run(
        ["promtool", *map(str, arguments)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


@needs_promtool
def test_prometheus_takes_the_rules() -> None:
    _promtool("check", "rules", RULES)


@needs_promtool
def test_each_alert_fires_for_what_it_is_for_and_for_nothing_else(tmp_path: Path) -> None:
    text = Path(__file__).with_name("inhand.rules.test.yml").read_text()
    assert set(re.findall(r"alertname: (\w+)", text)) == set(ALERTS)
    tests = tmp_path / "test.yml"
    tests.write_text(text.replace("RULES", str(RULES)))
    _promtool("test", "rules", tests)


def test_each_metric_and_label_that_a_rule_names_is_there() -> None:
    roll = Roll()
    roll.change("tracker", "mug", True)
    roll.hear(HEALTH)
    registry = CollectorRegistry()
    registry.register(HealthMetrics(roll, Site(), (), lambda: True))
    given = generate_latest(registry).decode()
    samples = {line.partition("{")[0].partition(" ")[0] for line in given.splitlines()}
    labels = set(re.findall(r"(\w+)=\"", given))
    rules = RULES.read_text().partition("groups:")[2]
    named = set(re.findall(r"\binhand_\w+", rules))
    assert named
    assert named <= samples
    assert set(re.findall(r"\$labels\.(\w+)", rules)) <= labels
    assert set(re.findall(r"[{,] ?(\w+)=\"", rules)) - {"job"} <= labels


def test_each_alert_has_its_mend_in_the_runbook_and_no_other_is_there() -> None:
    page = (ROOT / "docs/runbook.md").read_text()
    assert re.findall(r"^## (Inhand\w+)$", page, re.MULTILINE) == ALERTS
