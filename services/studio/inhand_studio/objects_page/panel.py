"""The controls by which a person says what an object is."""

from pathlib import Path
from typing import Any

import viser
from inhand_lab.new_objects.units import UNITS, UPS
from inhand_lab.objects.kinds import KINDS
from inhand_runtime.errors import InhandError

from inhand_studio.objects_page.making import Making
from inhand_studio.objects_page.wishes import AS_FOUND, ByCamera, ByMeasures, ByMesh, Wishes
from inhand_studio.visit import Visit

MEASURES, MESH, CAMERA = "a few measures", "a mesh file", "a recording on a table"
NOTHING = "(none)"
SYMMETRIES = (AS_FOUND, "none", "x", "y", "z")
MIRRORS = (AS_FOUND, "x", "y", "z")


class Panel:
    """Fields for the name and for each way to make an object."""

    def __init__(self, visit: Visit, making: Making) -> None:
        self._visit, self._making = visit, making
        self._gui = visit.client.gui
        self._uploaded: Path | None = None
        self._fields: dict[str, Any] = {}
        self._shown: list[Any] = []
        self._name = self._gui.add_text("Name", "", hint="a to z, 0 to 9 and _")
        self._way = self._gui.add_dropdown("Make it of", (MEASURES, MESH, CAMERA))
        self._way.on_update(visit.action(lambda _: self._show_way()))
        self._folder = self._gui.add_folder("What it is")
        self._symmetry = self._gui.add_dropdown(
            "Symmetry", SYMMETRIES, hint="About which axis it may be turned by any angle"
        )
        self._mirror = self._gui.add_dropdown(
            "Mirror plane", MIRRORS, hint="The normal of the plane of symmetry"
        )
        self._show_way()

    def wishes(self) -> Wishes:
        """Return what the fields say."""
        return Wishes(
            str(self._name.value), self._chosen(), self._symmetry.value, self._mirror.value
        )

    def _chosen(self) -> ByMeasures | ByMesh | ByCamera:
        fields = self._fields
        if self._way.value == MEASURES:
            kind = str(fields["kind"].value)
            return ByMeasures(kind, {one: float(fields[one].value) for one in KINDS[kind].measures})
        if self._way.value == MESH:
            longest = float(fields["longest"].value)
            return ByMesh(self._uploaded, fields["unit"].value, longest, fields["up"].value)
        name = fields["recording"].value
        return ByCamera(None if name == NOTHING else self._recordings()[name])

    def _show_way(self) -> None:
        self._clear()
        with self._folder:
            if self._way.value == MEASURES:
                self._show_kinds()
            elif self._way.value == MESH:
                self._show_mesh()
            else:
                names = (*self._recordings(), NOTHING)
                self._add("recording", self._gui.add_dropdown("Recording", names))

    def _show_kinds(self, kind: str = "mug") -> None:
        chosen = self._gui.add_dropdown("Kind", tuple(KINDS), initial_value=kind)
        chosen.on_update(self._visit.action(lambda _: self._show_kind(chosen.value)))
        self._add("kind", chosen)
        for name, measure in KINDS[kind].measures.items():
            field = self._gui.add_number(
                f"{name.replace('_', ' ').capitalize()}, cm",
                measure.least,
                min=measure.least,
                max=measure.largest,
                step=0.1,
                hint=measure.meaning,
            )
            self._add(name, field)

    def _show_kind(self, kind: str) -> None:
        self._clear()
        with self._folder:
            self._show_kinds(kind)

    def _show_mesh(self) -> None:
        upload = self._gui.add_upload_button("Upload a mesh file")
        upload.on_upload(self._visit.action(self._take))
        self._add("upload", upload)
        self._add("file", self._gui.add_markdown(""))
        units = (AS_FOUND, *UNITS)
        self._add("unit", self._gui.add_dropdown("Unit", units, hint="of its coordinates"))
        longest = self._gui.add_number(
            "Longest side, cm", 0.0, min=0.0, max=400.0, step=0.1, hint="where it has no unit; or 0"
        )
        self._add("longest", longest)
        ups = (AS_FOUND, *UPS)
        self._add("up", self._gui.add_dropdown("Points up", ups, hint="which of its axes"))

    def _take(self, event: viser.GuiEvent[viser.GuiUploadButtonHandle]) -> None:
        uploaded = event.target.value
        if not uploaded.content:
            raise InhandError(f"{uploaded.name} is empty: choose another file")
        self._uploaded = self._making.keep_upload(uploaded.name, uploaded.content)
        self._fields["file"].content = f"{len(uploaded.content):,} bytes are here."

    def _recordings(self) -> dict[str, Path]:
        folder = self._visit.studio.dataset / "recordings"
        paths = sorted(folder.glob("*.mcap"), key=lambda one: one.stat().st_mtime, reverse=True)
        return {path.name: path for path in paths}

    def _add(self, name: str, field: Any) -> None:
        self._fields[name] = field
        self._shown.append(field)

    def _clear(self) -> None:
        for field in self._shown:
            field.remove()
        self._shown, self._fields, self._uploaded = [], {}, None
