"""Which settings the tables of each service hold."""

from importlib import import_module

from inhand_runtime.settings import Section

_PLACES = {
    "capture": ("inhand_capture.settings", "CaptureSettings"),
    "tracker": ("inhand_tracker.settings", "TrackerSettings"),
    "recorder": ("inhand_recorder.settings", "RecorderSettings"),
    "studio": ("inhand_studio.settings", "StudioSettings"),
    "outcomes": ("inhand_outcomes.settings", "OutcomesSettings"),
    "hub": ("inhand_hub.settings", "HubSettings"),
}


def settings_model(service: str) -> type[Section]:
    """Return the model of ``[SERVICE.NAME]``; the service's package is imported for it alone."""
    module, name = _PLACES[service]
    model: type[Section] = getattr(import_module(module), name)
    return model
