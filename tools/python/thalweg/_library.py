"""The C interface as ctypes sees it: signatures, and failures as exceptions."""
import ctypes
import os
from ctypes import POINTER, c_char_p, c_double, c_int, c_size_t, c_uint8, c_uint16, c_uint32, c_void_p

API_VERSION = 2
PROGRESS = ctypes.CFUNCTYPE(c_int, c_char_p, c_double, c_void_p)

_SIGNATURES = {
    "version": (c_char_p, []),
    "api_version": (c_int, []),
    "last_message": (c_char_p, []),
    "status_name": (c_char_p, [c_int]),
    "job_new": (c_void_p, []),
    "job_free": (None, [c_void_p]),
    "job_add_source": (c_int, [c_void_p, c_char_p]),
    "job_add_points": (c_int, [c_void_p, POINTER(c_double), c_size_t]),
    "job_add_line": (c_int, [c_void_p, c_int, POINTER(c_double), c_size_t, c_int]),
    "job_set_option": (c_int, [c_void_p, c_char_p, c_char_p]),
    "job_set_progress": (c_int, [c_void_p, PROGRESS, c_void_p]),
    "job_cancel": (None, [c_void_p]),
    "job_build": (c_int, [c_void_p, POINTER(c_void_p)]),
    "job_optimize": (c_int, [c_void_p, c_char_p, POINTER(c_void_p)]),
    "tin_free": (None, [c_void_p]),
    "tin_vertex_count": (c_size_t, [c_void_p]),
    "tin_triangle_count": (c_size_t, [c_void_p]),
    "tin_constraint_count": (c_size_t, [c_void_p]),
    "tin_vertices": (c_int, [c_void_p, POINTER(c_double)]),
    "tin_triangles": (c_int, [c_void_p, POINTER(c_uint32)]),
    "tin_orders": (c_int, [c_void_p, POINTER(c_uint16)]),
    "tin_constraints": (c_int, [c_void_p, POINTER(c_uint32), POINTER(c_uint8)]),
    "tin_crs": (c_char_p, [c_void_p]),
    "tin_report": (c_char_p, [c_void_p]),
    "tin_write": (c_int, [c_void_p, c_char_p, c_char_p, POINTER(c_char_p), c_int]),
}


class ThalwegError(Exception):
    """What the library says went wrong; `code` is the name that the command line prints, as "not-found"."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(f"{code}: {message}")
        self.code = code
        self.message = message


def _load() -> ctypes.CDLL:
    path = os.environ.get("THALWEG_LIBRARY", "libthalweg_c.so.1")
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"the library of Thalweg cannot be loaded ({error}); install it where the loader looks, "
                          "or name it in THALWEG_LIBRARY") from None
    for name, (result, arguments) in _SIGNATURES.items():
        function = getattr(library, "thalweg_" + name)
        function.restype, function.argtypes = result, arguments
    if library.thalweg_api_version() < API_VERSION:
        raise ImportError(f"{path} has version {library.thalweg_api_version()} of the C interface; "
                          f"this package needs {API_VERSION}")
    return library


LIBRARY = _load()


def call(name: str, *arguments: object) -> None:
    """Calls a function that returns a status. Raises: ThalwegError."""
    status = getattr(LIBRARY, "thalweg_" + name)(*arguments)
    if status != 0:
        raise ThalwegError(LIBRARY.thalweg_status_name(status).decode(), LIBRARY.thalweg_last_message().decode())


def version() -> str:
    """Version of the library, as "0.1.0"."""
    return LIBRARY.thalweg_version().decode()
