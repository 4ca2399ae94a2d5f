"""The source tree keeps the laws of layering.py, and each law is one that a broken tree fails."""

import tempfile
import unittest
from pathlib import Path

import layering

ROOT = Path(__file__).resolve().parents[2]

# A tree that keeps every law; each case below adds one file to it.
SOUND = {
    "include/thalweg/base/error.hpp": "#include <string>\n",
    "include/thalweg/mesh/tin.hpp": "#include <thalweg/base/error.hpp>\n",
    "include/thalweg/geodesy/crs.hpp": "#include <thalweg/base/error.hpp>\n",
    "include/thalweg/optimize/optimum.hpp": "#include <thalweg/mesh/tin.hpp>\n",
    "src/base/parallel.hpp": "#include <tbb/parallel_for.h>\n",
    "src/geometry/predicates.cpp": '#include <CGAL/Gmpq.h>\n#include "base/parallel.hpp"\n',
    "src/io/raster.cpp": "#include <gdal_priv.h>\n#include <cairo.h>\n",
    "src/geodesy/crs.cpp": "#include <GeographicLib/Geodesic.hpp>\n",
    "tests/unit/io/raster_test.cpp": "#include <ogrsf_frmts.h>\n#include <thalweg/mesh/tin.hpp>\n",
}

# What is added, its text, and what the complaint must say.
BROKEN = [
    ("src/mesh/up.cpp", "#include <thalweg/optimize/optimum.hpp>", "mesh includes the higher optimize"),
    ("src/mesh/side.cpp", "#include <thalweg/geodesy/crs.hpp>", "share a layer"),
    ("src/geodesy/side.cpp", "#include <thalweg/mesh/tin.hpp>", "share a layer"),
    ("src/base/up.cpp", '#include "../../include/thalweg/mesh/tin.hpp"', "base includes the higher mesh"),
    ("src/extra/new.cpp", "#include <thalweg/base/error.hpp>", "module extra has no layer"),
    ("src/mesh/lost.cpp", "#include <thalweg/mesh/lost.hpp>", "no such header"),
    ("src/mesh/exact.cpp", "  #  include <CGAL/Gmpq.h>", "CGAL belongs to delaunay and geometry"),
    ("src/delaunay/read.cpp", "#include <ogrsf_frmts.h>", "GDAL belongs to io"),
    ("src/io/geodesic.cpp", "#include <GeographicLib/Geodesic.hpp>", "GeographicLib belongs to geodesy"),
    ("src/terrain/draw.cpp", "#include <cairo/cairo.h>", "Cairo belongs to io"),
    ("src/mesh/cloud.cpp", "#include <pdal/Options.hpp>", "PDAL belongs to io"),
    ("tools/thalweg/read.cpp", "#include <cpl_conv.h>", "GDAL belongs to io"),
    ("tests/unit/order/oracle.cpp", "#include <CGAL/Gmpq.h>", "CGAL belongs to delaunay and geometry"),
    ("include/thalweg/io/raster.hpp", "#include <gdal.h>", "only the standard library"),
    ("include/thalweg/mesh/text.hpp", "#include <fmt/format.h>", "only the standard library"),
    ("include/thalweg/mesh/fast.hpp", '#include "base/parallel.hpp"', "includes the private"),
    ("src/mesh/talk.cpp", "#include <iostream>", "neither prints"),
    ("src/mesh/say.cpp", '  std::fprintf(stderr, "%d", 1);', "neither prints"),
    ("src/mesh/end.cpp", "  std::abort();", "nor ends"),
    ("include/thalweg/mesh/long.hpp", "\n" * 150, "150 lines, fewer than 150"),
    ("src/mesh/long.cpp", "\n" * 500, "500 lines, fewer than 500"),
    ("src/mesh/utils.cpp", "", "says nothing"),
    ("tests/CMakeLists.txt", "file(GLOB sources *.cpp)", "hides new files"),
    ("src/io/vector.cpp", None, "not named in src/io/CMakeLists.txt"),
    ("include/thalweg/base/id.hpp", None, "not named in src/base/CMakeLists.txt"),
    ("README.md", "1  geometry    exact\n0  base    errors\n", "layer diagram"),
]

# The diagram of the sound tree.
DIAGRAM = """
5  optimize                                     criteria
3  io                                           readers
2  mesh       |   geodesy                       the Tin | CRS
1  geometry                                     points
0  base                                         errors
"""


def complaints(files):
    """What is said about a tree of these files; each module lists all its files but those without text."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            parts = Path(name).parts
            if text is not None and parts[-1] != "CMakeLists.txt" and parts[0] in ("src", "include"):
                listing = Path(folder, "src", parts[-2], "CMakeLists.txt")
                listing.parent.mkdir(parents=True, exist_ok=True)
                with listing.open("a", encoding="utf-8") as lines:
                    lines.write(f"  {parts[-1]}\n")
        for name, text in files.items():
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text or "", encoding="utf-8")
        return layering.violations(folder)


class Layering(unittest.TestCase):
    def test_this_tree_keeps_every_law(self):
        self.assertEqual(layering.violations(ROOT), [])

    def test_this_tree_was_read(self):
        self.assertGreater(len(list(layering.sources(ROOT))), 10)

    def test_a_sound_tree_has_no_complaint(self):
        self.assertEqual(complaints(SOUND | {"README.md": DIAGRAM}), [])

    def test_each_broken_law_is_found(self):
        for name, text, expected in BROKEN:
            with self.subTest(name):
                found = complaints(SOUND | {name: text})
                self.assertEqual(len(found), 1, found)
                self.assertIn(expected, found[0])
                self.assertTrue(found[0].startswith(name), found[0])


if __name__ == "__main__":
    unittest.main()
