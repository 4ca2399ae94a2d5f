"""Terrain TINs from Python: the library Thalweg through its C interface.

>>> import thalweg
>>> tin = thalweg.build(points, valleys=[line], crs="EPSG:32632", max_error=0.5)
>>> tin.vertices, tin.triangles, tin.report["pits"]["result"]
>>> tin.write("tin.ply")

The shared library libthalweg_c.so.1 is found by the loader, or named by the environment variable THALWEG_LIBRARY.
"""
from ._library import ThalwegError, version
from ._tin import BOUNDARY, BREAKLINE, HOLE, LAKE, RIDGE, VALLEY, Tin, build, optimize

__all__ = ["BOUNDARY", "BREAKLINE", "HOLE", "LAKE", "RIDGE", "VALLEY", "ThalwegError", "Tin", "build", "optimize", "version"]
