"""Building TINs of files and arrays."""
import ctypes
import json
import os
from typing import Any, Callable, Dict, Iterable, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._library import LIBRARY, PROGRESS, call

BREAKLINE, RIDGE, VALLEY, BOUNDARY, HOLE, LAKE = 1, 2, 4, 8, 16, 32

Path = Union[str, "os.PathLike[str]"]
Source = Union[Path, ArrayLike]
#: Called with the phase and the fraction done in it; cancels the build if it returns True.
Progress = Callable[[str, float], Optional[bool]]


def _pointer(array: NDArray[Any], kind: Any) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(kind))


class Tin:
    """A TIN that `build` made: arrays to read, and files to write."""

    def __init__(self, handle: int) -> None:
        self._handle = handle

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            LIBRARY.thalweg_tin_free(self._handle)

    @property
    def vertices(self) -> NDArray[np.float64]:
        """(n, 3): x, y, z as they would be written."""
        xyz = np.empty((LIBRARY.thalweg_tin_vertex_count(self._handle), 3))
        call("tin_vertices", self._handle, _pointer(xyz, ctypes.c_double))
        return xyz

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(m, 3): indices of vertices, counter-clockwise, the smallest first, triangles sorted."""
        corners = np.empty((LIBRARY.thalweg_tin_triangle_count(self._handle), 3), np.uint32)
        call("tin_triangles", self._handle, _pointer(corners, ctypes.c_uint32))
        return corners

    @property
    def orders(self) -> NDArray[np.uint16]:
        """(m,): the constrained order of each triangle."""
        orders = np.empty(LIBRARY.thalweg_tin_triangle_count(self._handle), np.uint16)
        call("tin_orders", self._handle, _pointer(orders, ctypes.c_uint16))
        return orders

    @property
    def constraints(self) -> Tuple[NDArray[np.uint32], NDArray[np.uint8]]:
        """Constraint edges: (k, 2) indices of vertices, and (k,) kinds, sums of BREAKLINE, RIDGE, ..."""
        count = LIBRARY.thalweg_tin_constraint_count(self._handle)
        ends, kinds = np.empty((count, 2), np.uint32), np.empty(count, np.uint8)
        call("tin_constraints", self._handle, _pointer(ends, ctypes.c_uint32), _pointer(kinds, ctypes.c_uint8))
        return ends, kinds

    @property
    def crs(self) -> str:
        """The CRS of the vertices as WKT; "" if it is not known."""
        return LIBRARY.thalweg_tin_crs(self._handle).decode()

    @property
    def report(self) -> Dict[str, Any]:
        """The report, as `thalweg build --report` writes it."""
        return json.loads(LIBRARY.thalweg_tin_report(self._handle).decode())

    def write(self, path: Path, format: Optional[str] = None, options: Union[Sequence[str], Dict[str, str]] = (),
              overwrite: bool = False) -> None:
        """Writes a mesh or vector layers; `format` by the extension if None, `options` as "K=V", or a dict.

        Raises: ThalwegError "output-exists", "write-failed", "usage", ...
        """
        pairs = [f"{key}={value}" for key, value in options.items()] if isinstance(options, dict) else options
        values = (ctypes.c_char_p * (len(pairs) + 1))(*[pair.encode() for pair in pairs], None)
        call("tin_write", self._handle, os.fsencode(path), None if format is None else format.encode(), values,
             int(overwrite))


def _is_path(source: Source) -> bool:
    return isinstance(source, (str, os.PathLike))


def _add_line(job: int, kind: int, line: ArrayLike) -> None:
    array = np.ascontiguousarray(line, np.float64)
    if array.ndim != 2 or array.shape[1] not in (2, 3):
        raise ValueError(f"a line is an array (n, 2) or (n, 3), not {array.shape}")
    call("job_add_line", job, kind, _pointer(array, ctypes.c_double), array.shape[0], array.shape[1])


def _set_options(job: int, options: Dict[str, Any]) -> None:
    for name, value in options.items():
        if value is None:
            continue
        if name == "optimize" and isinstance(value, (list, tuple)):
            value = ",".join(value)
        for part in value if isinstance(value, (list, tuple)) else [value]:
            call("job_set_option", job, name.replace("_", "-").encode(), str(part).encode())


def _run(fill: Callable[[int], None], work: Callable[[int, Any], None], progress: Optional[Progress]) -> Tin:
    """Makes a job, fills it, and runs `work` on it and the place where the TIN goes."""
    job = LIBRARY.thalweg_job_new()
    if not job:
        raise MemoryError
    raised = []

    def report(phase: bytes, fraction: float, _: object) -> int:
        try:
            return int(bool(progress is not None and progress(phase.decode(), fraction)))
        except BaseException as error:  # it must not cross the C interface
            raised.append(error)
            return 1

    callback = PROGRESS(report)
    try:
        fill(job)
        call("job_set_progress", job, callback, None)
        tin = ctypes.c_void_p()
        try:
            work(job, ctypes.byref(tin))
        finally:
            result = Tin(tin.value)  # is freed in any case
            if raised:
                raise raised[0] from None
        return result
    finally:
        LIBRARY.thalweg_job_free(job)


def build(points: Union[Source, Sequence[Path]], *, ridges: Iterable[Source] = (), valleys: Iterable[Source] = (),
          breaklines: Iterable[Source] = (), boundary: Iterable[Source] = (), holes: Iterable[Source] = (), lakes: Iterable[Source] = (),
          crs: Optional[str] = None, progress: Optional[Progress] = None, **options: Any) -> Tin:
    """Builds a TIN.

    points: an array (n, 3) of x, y, z, a source "PATH" or "PATH|layername=NAME", or a list of sources. Vertex i
    of the TIN is the i-th distinct point that is used.
    ridges, valleys, breaklines: sources, or arrays (n, 3) with heights or (n, 2) without; boundary, holes,
    lakes: the same, each array one closed ring and an area by itself. crs: of the coordinates, in place of what sources declare (option a-crs).
    options: those of `thalweg build`, dashes as underscores: order=1, optimize="none", max_error=0.5.
    progress: called with phase and fraction; cancels if it returns True; what it raises is raised here.

    Raises: ThalwegError, whose `code` is "cancelled", "usage", "not-found", ...
    """

    def fill(job: int) -> None:
        if _is_path(points):
            call("job_add_source", job, os.fsencode(points))
        elif isinstance(points, (list, tuple)) and all(_is_path(source) for source in points):
            for source in points:
                call("job_add_source", job, os.fsencode(source))
        else:
            array = np.ascontiguousarray(points, np.float64)
            if array.ndim != 2 or array.shape[1] != 3:
                raise ValueError(f"points are an array (n, 3), not {array.shape}")
            call("job_add_points", job, _pointer(array, ctypes.c_double), array.shape[0])
        for name, kind, lines in (("ridges", RIDGE, ridges), ("valleys", VALLEY, valleys),
                                  ("breaklines", BREAKLINE, breaklines), ("boundary", BOUNDARY, boundary),
                                  ("holes", HOLE, holes), ("lakes", LAKE, lakes)):
            for line in [lines] if _is_path(lines) else lines:
                if _is_path(line):
                    call("job_set_option", job, name.encode(), os.fsencode(line))
                else:
                    _add_line(job, kind, line)
        _set_options(job, {"a-crs": crs, **options})

    return _run(fill, lambda job, tin: call("job_build", job, tin), progress)


def optimize(tin: Path, *, progress: Optional[Progress] = None, **options: Any) -> Tin:
    """Optimises a TIN that exists, a file; its vertices, heights, outline and constraint edges stay.

    options: those of `thalweg optimize`, dashes as underscores: order=1, optimize="edge-length".
    progress, and what is raised: as for `build`.
    """
    return _run(lambda job: _set_options(job, options),
                lambda job, result: call("job_optimize", job, os.fsencode(tin), result), progress)
