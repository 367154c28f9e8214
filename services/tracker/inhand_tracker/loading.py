"""Loads what a tracker's settings name, and checks before a start all that can be known then."""

from collections.abc import Mapping

from inhand_runtime.errors import SettingsError
from inhand_runtime.rig_calibration import read_rig_calibration
from inhand_runtime.settings import Settings
from inhand_runtime.settings_errors import suggestion
from inhand_schemas.joints import Joint

from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import DEFAULT_METHOD, new_tracker
from inhand_tracker.model.model import Model, ModelError
from inhand_tracker.model.model_file import load_model
from inhand_tracker.people.watching import GivenObjects, RecognisedObjects, Watcher
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.recogniser_file import load_recogniser
from inhand_tracker.settings import TrackerSettings


def check(settings: Settings[TrackerSettings]) -> Watcher:
    """Check all that can be known before a start, and load it; raises SettingsError."""
    _require_rig(settings)
    _require_cameras(settings)
    require_files(settings)
    try:
        return load_watcher(settings.instance, settings.service)
    except ModelError as error:
        raise SettingsError(f"[tracker.{settings.instance}]: {error}") from None


def _require_cameras(settings: Settings[TrackerSettings]) -> None:
    """Raise SettingsError for a camera that no table names.

    A file without cameras, and one that joins other machines, follow cameras of elsewhere.
    """
    tables, zenoh = settings.origin.instances.get("capture", ()), settings.zenoh
    if not tables or zenoh.connect or zenoh.listen:
        return
    setting = "cameras" if settings.service.cameras else "camera"
    for camera in settings.service.camera_names:
        if camera not in tables:
            raise settings.origin.refusal(
                setting, f"there is no table [capture.{camera}]" + suggestion(camera, tables)
            )


def _require_rig(settings: Settings[TrackerSettings]) -> None:
    """Raise SettingsError for cameras that cannot track together."""
    chosen, refusal = settings.service, settings.origin.refusal
    if "cameras" in chosen.model_fields_set and len(chosen.cameras) < 2:
        raise refusal("cameras", "name two or more in it, or one in camera")
    if not chosen.cameras:
        if chosen.calibration is not None:
            raise refusal("calibration", "it is for several cameras: name them in cameras")
        return
    if "camera" in chosen.model_fields_set:
        raise refusal("camera", "name all cameras in cameras, and leave camera out")
    if len(set(chosen.cameras)) < len(chosen.cameras):
        raise refusal("cameras", "one is named twice: name each once")
    if chosen.method != DEFAULT_METHOD:
        raise refusal(
            "method", f"{chosen.method} takes one camera: choose {DEFAULT_METHOD}, or name a camera"
        )
    if chosen.calibration is None:
        return
    calibrated = read_rig_calibration(chosen.calibration).cameras
    for camera in chosen.cameras:
        if camera not in calibrated:
            raise refusal(
                "calibration",
                f"{chosen.calibration} does not say where {camera} is: run `inhand calibrate` with "
                "it, or leave it out of cameras",
            )


def require_files(settings: Settings[TrackerSettings]) -> None:
    """Raise SettingsError for a file that is not there."""
    chosen = settings.service
    models = (("models", file) for file in chosen.models)
    for setting, file in (("model", chosen.model), *models, ("recogniser", chosen.recogniser)):
        if file is not None and not file.exists():
            reason = f"{file} does not exist: check the path; `inhand train` makes it"
            raise settings.origin.refusal(setting, reason)


def load_watcher(instance: str, settings: TrackerSettings) -> Watcher:
    """Load all that it takes to watch one person; raises SettingsError or ModelError."""
    models = load_models(instance, settings)
    trackers = new_trackers(models, settings)
    if settings.recogniser is None:
        learned = [model.mapping.absent_joints for model in models.values()]
        needs_hips = any(Joint.HIP_CENTER not in absent for absent in learned)
        return GivenObjects(trackers, needs_hips=needs_hips)
    recogniser = load_recogniser(settings.recogniser)
    by_action = {model.interaction: name for name, model in models.items()}
    if missing := [action for action in recogniser.actions if action not in by_action]:
        raise SettingsError(
            f"[tracker.{instance}] recognises {missing[0]!r} and has no model of it: add it to "
            "models, or train the recogniser without it"
        )
    objects = [by_action[action] for action in recogniser.actions]
    cascade = Cascade(
        recogniser, [trackers[name] for name in objects], left_handed=settings.left_handed
    )
    return RecognisedObjects(cascade, objects)


def load_models(instance: str, settings: TrackerSettings) -> dict[str, Model]:
    """Load the models that are named, by object; raises SettingsError or ModelError."""
    where = f"[tracker.{instance}]"
    if settings.model is not None and settings.models:
        raise SettingsError(f'{where} has model and models: put all in models = ["FILE", …]')
    files = settings.model_files
    if not files:
        raise SettingsError(
            f'{where} names no model: write model = "FILE"; `inhand train` makes one'
        )
    models: dict[str, Model] = {}
    for file in files:
        model = load_model(file)
        name = model.shape.name
        if name in models:
            raise SettingsError(f"{where} has two models of {name!r}: an object has one pose key")
        models[name] = model
    return models


def new_trackers(
    models: Mapping[str, Model], settings: TrackerSettings
) -> dict[str, ObjectTracker]:
    """Make a tracker for each model, by object; raises SettingsError or ModelError."""
    return {
        name: new_tracker(
            model,
            settings.method,
            left_handed=settings.left_handed,
            terms=settings.likelihood,
            particles=settings.particles,
            several_cameras=bool(settings.cameras),
            seed=settings.seed,
        )
        for name, model in models.items()
    }
