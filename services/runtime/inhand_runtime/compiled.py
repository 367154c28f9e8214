"""Compiled code (Numba), kept from one start to the next in a folder that the process may write.

Every kernel is made with ``njit`` or ``vectorised`` of this module, and nothing else imports Numba.
By itself Numba keeps what it compiles beside the source, where an installed package cannot be
written, and compiles again only when the file of the function itself changed: not when another file
did, of which the kernel calls a function or holds a constant.
"""

import hashlib
import inspect
import logging
import numbers
import re
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import copy_context
from functools import cache, partial, wraps
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numba
import numpy as np
from numba.core.caching import Cache, FunctionCache, NullCache
from numba.core.dispatcher import Dispatcher
from numba.np.ufunc.gufunc import GUFunc
from numba.np.ufunc.wrappers import GufWrapperCache, _GufuncWrapper

from inhand_runtime.cache_folder import cache_folder

log = logging.getLogger(__name__)

_NUMBA_SETTINGS: Any = numba.config  # its stubs know none of them

OUR_PACKAGES = "inhand"
"""Beginning of the names of the packages whose sources decide what is compiled again."""


class KernelLocator:
    """Says where Numba keeps one kernel, and by which stamp it knows that it is still right.

    Numba calls it by name, as ``NUMBA_CACHE_LOCATOR_CLASSES`` describes.
    """

    def __init__(self, kernel: FunctionType, file: str) -> None:
        module = sys.modules[kernel.__module__]
        place = hashlib.sha256(str(Path(file).resolve().parent).encode()).hexdigest()[:16]
        self._folder = FOLDER / f"{kernel.__module__.rpartition('.')[0]}-{place}"
        self._stamp = stamp_of(module)
        self._line = kernel.__code__.co_firstlineno

    @classmethod
    def from_function(cls, kernel: FunctionType, file: str) -> "KernelLocator":
        """Make the locator of a kernel that stands in a file."""
        return cls(kernel, file)

    def ensure_cache_path(self) -> None:
        """Make the folder."""
        self._folder.mkdir(parents=True, exist_ok=True)

    def get_cache_path(self) -> str:
        """Return the folder of the kernel's files."""
        return str(self._folder)

    def get_source_stamp(self) -> str:
        """Return what changes when the kernel must be compiled again."""
        return self._stamp

    def get_disambiguator(self) -> str:
        """Return what tells functions of one name and file apart."""
        return str(self._line)


LOCATOR = f"{__name__}.{KernelLocator.__name__}"


class _ForgivingCache(Cache):
    """A cache of Numba's, which a damaged file or a full disk costs time and no more."""

    def load_overload(self, *wanted: Any) -> Any:
        """Load what was compiled; None where there is nothing that can be read."""
        try:
            return super().load_overload(*wanted)  # type: ignore[no-untyped-call]
        except Exception as error:  # noqa: BLE001 - a damaged pickle may raise anything
            log.warning("a file in %s is damaged (%s): compiled again", self.cache_path, error)
            self.flush()
            return None

    def save_overload(self, *compiled: Any) -> None:
        """Keep what was compiled, where that can be."""
        self._keeping(super().save_overload, *compiled)

    def flush(self) -> None:
        """Forget what was kept, where that can be."""
        self._keeping(super().flush)

    def _keeping(self, keep: Callable[..., None], *compiled: Any) -> None:
        try:
            keep(*compiled)
        except OSError as error:
            log.warning("cannot keep compiled code in %s: %s", self.cache_path, error.strerror)


class KernelCache(_ForgivingCache, FunctionCache):
    """Keeps what is compiled of one function."""


class LoopCache(_ForgivingCache, GufWrapperCache):  # type: ignore[misc]
    """Keeps the loop over arrays of one function."""


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Compile a function with Numba's ``njit`` and these options of its; ``cache=True`` is the
    folder of this module's, where that can be written."""

    kept = options.pop("cache", False) and KEPT

    def compiled(function: Callable[..., Any]) -> Any:
        kernel = numba.njit(**options)(function)
        if kept and isinstance(kernel, Dispatcher):
            with _kept_here():
                kernel._cache = KernelCache(function)  # type: ignore[attr-defined, no-untyped-call]
        return kernel

    return compiled


class _Silence(threading.local):
    """A context of one thread in which NumPy does not warn of what is not a number.

    It is made once: to enter and leave ``np.errstate`` takes longer than to turn a vector.
    """

    def __init__(self) -> None:
        with np.errstate(invalid="ignore", divide="ignore"):
            self.context = copy_context()


_SILENCE = _Silence()


def vectorised(layout: str) -> Callable[[Callable[..., None]], Any]:
    """Compile a function of double arrays so that it takes any number of them, as NumPy's own do.

    The ``layout`` is NumPy's signature of generalised functions: the function fills its last
    arguments, which stand behind the arrow, and its callers get them as results. What is not a
    number stays so without a warning. It is compiled, or loaded, at the first call: a process pays
    for what it uses, and not for all that it imports.
    """
    inputs, outputs = layout.split("->")
    types = []
    for number, dimensions in enumerate(re.findall(r"\(([^)]*)\)", inputs + outputs)):
        scalar = not dimensions and number < inputs.count("(")
        axes = ",".join(":" * max(1, len(dimensions.split(","))))
        types.append("float64" if scalar else f"float64[{axes}]")

    def compiled(function: Callable[..., None]) -> Callable[..., Any]:
        caches = _caches_of(function) if KEPT else None

        @cache
        def made() -> Any:
            with _MAKING:
                return _vectorised(function, layout, types, caches)

        _LOOPS.append(made)

        @wraps(function)
        def silent(*arrays: Any, **options: Any) -> Any:
            return _SILENCE.context.run(made(), *arrays, **options)

        return silent

    return compiled


def make_loops() -> None:
    """Compile, or load, all that is ``vectorised`` in the modules that were imported: for who works
    live, and cannot wait at a first call."""
    for made in _LOOPS:
        made()


_LOOPS: list[Callable[[], Any]] = []
"""What gives the loop over arrays of each function, and makes it the first time."""

Caches = tuple[KernelCache, LoopCache]
"""Where one function and its loop over arrays are kept."""

_MAKING = threading.Lock()
"""Held by the thread that compiles: two that call a function first share its caches."""


def _caches_of(function: Callable[..., None]) -> Caches:
    with _kept_here():
        return KernelCache(function), LoopCache(function)  # type: ignore[no-untyped-call]


def _vectorised(
    function: Callable[..., None], layout: str, types: list[str], caches: Caches | None
) -> Any:
    made: Any = GUFunc(function, layout, targetoptions={"nopython": True})
    builder = made.gufunc_builder
    if caches:
        builder.nb_func.cache, loops = caches
        builder.build = partial(_build_loop, function, builder, loops)
    made.add(f"void({', '.join(types)})")
    made.disable_compile()
    return made.build_ufunc().ufunc


def _build_loop(
    function: Callable[..., None], builder: Any, loops: LoopCache, compiled: Any
) -> Any:
    """Build the loop over arrays, which Numba keeps apart from the function that it calls.

    The one that was kept may be of another process's compilation than the function is: Numba would
    then call a function at address 0. It is compiled again instead. Returns what ``build`` of
    Numba's builders does: numbers of types, an address, and what must live as long.
    """
    caches: tuple[Any, ...] = loops, loops, NullCache()
    for kept in caches:
        wrapper: Any = _GufuncWrapper(  # type: ignore[no-untyped-call]
            function, compiled, builder.sin, builder.sout, cache=None, is_parfors=False
        )
        wrapper.cache = kept
        built = wrapper.build()
        address = built.library.get_pointer_to_function(built.name)
        if address:
            break
        kept.flush()
    return [np.dtype(float).num] * len(compiled.signature.args), address, built.env


@contextmanager
def _kept_here() -> Iterator[None]:
    """Let Numba keep what is made meanwhile in this module's folder."""
    usual = _NUMBA_SETTINGS.CACHE_LOCATOR_CLASSES
    _NUMBA_SETTINGS.CACHE_LOCATOR_CLASSES = LOCATOR
    try:
        yield
    finally:
        _NUMBA_SETTINGS.CACHE_LOCATOR_CLASSES = usual


def stamp_of(module: ModuleType) -> str:
    """A digest of all that kernels of a module are compiled from.

    That is the module's source, the constants that it holds, and the same of each module of which
    it holds a kernel. What it imports stands above its kernels, and so is known by then.
    """
    digest = hashlib.sha256()
    for part in _parts(module, set()):
        digest.update(part)
    return digest.hexdigest()


def _parts(module: ModuleType, seen: set[str]) -> Iterator[bytes]:
    seen.add(module.__name__)
    yield Path(inspect.getfile(module)).read_bytes()
    for name, value in sorted(vars(module).items()):
        if isinstance(value, Dispatcher):
            value = sys.modules[value.__module__]
        if isinstance(value, ModuleType):
            if value.__name__.startswith(OUR_PACKAGES) and value.__name__ not in seen:
                yield from _parts(value, seen)
        elif isinstance(value, np.ndarray):
            yield name.encode() + value.tobytes()
        elif _is_plain(value) and not name.startswith("__"):
            yield f"{name} = {value!r}".encode()


def _is_plain(value: Any) -> bool:
    if isinstance(value, tuple):
        return all(map(_is_plain, value))
    return isinstance(value, numbers.Number | np.generic | str)


def _can_be_kept(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        log.warning(
            "cannot write %s: %s; what is compiled is lost at the end, and the next start takes as "
            "long: name a folder that can be written in INHAND_CACHE",
            folder,
            error.strerror,
        )
        return False
    return True


# Who sets NUMBA_CACHE_DIR has chosen already.
FOLDER = Path(_NUMBA_SETTINGS.CACHE_DIR or cache_folder() / "compiled")
KEPT = _can_be_kept(FOLDER)
