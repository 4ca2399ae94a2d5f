"""The laws of the source tree that #include lines and file sizes can show.

`violations(root)` reads the project at `root` and returns one line for each broken law:
  1. A module includes only modules of lower layers; modules of one layer do not see each other.
  2. A foreign library is included only behind its fence (CGAL, GDAL, PDAL, GeographicLib, Cairo).
  3. Headers under include/ are plain: the C++ (of .h: the C) standard library and other public headers.
  4. The library, under src/ and include/, neither prints nor ends the process.
  5. A header has fewer than 150 lines, a source fewer than 500.
  6. No file or folder is called misc, utils, common, helpers or manager; no CMake file globs.
  7. Each source and each public header of a module is named in the module's CMakeLists.txt.
  8. The layer diagram of README.md is the table below, as far as its modules exist.
"""

import re
from pathlib import Path

# Lowest layer first. The README shows the same table, highest layer first.
LAYERS = [
    ["base"],
    ["geometry"],
    ["mesh", "geodesy"],
    ["delaunay", "io"],
    ["order"],
    ["optimize", "terrain", "verify"],
    ["pipeline"],
    ["tools/thalweg", "tools/qgis", "src/capi"],
    ["tools/python"],
]
LAYER_OF = {module: layer for layer, modules in enumerate(LAYERS) for module in modules}

# Library -> (its headers, the modules that may include them).
FENCES = {
    "CGAL": (re.compile(r"CGAL/"), {"geometry", "delaunay"}),
    "GDAL": (re.compile(r"(gdal|ogr|cpl_|vrt|proj)[a-z0-9_]*\.h"), {"io"}),
    "GeographicLib": (re.compile(r"GeographicLib/"), {"geodesy"}),
    "Cairo": (re.compile(r"cairo"), {"io"}),
    "PDAL": (re.compile(r"pdal/"), {"io"}),
    "NetCDF": (re.compile(r"netcdf"), {"io"}),
}
STANDARD_HEADER = re.compile(r"[a-z_0-9]+")
C_HEADER = re.compile(r"std[a-z]+\.h")
PRINTS_OR_ENDS = re.compile(
    r"#\s*include\s*<(iostream|print)>"
    r"|\b([fv]?printf|f?puts|putchar|perror|exit|_Exit|quick_exit|abort)\s*\(")
VAGUE_NAMES = {"misc", "util", "utils", "common", "helper", "helpers", "manager"}
MAX_LINES = {".hpp": 150, ".h": 150, ".cpp": 500}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def module_of(path):
    """Module that owns the file at the project-relative `path`, or None outside of the layers."""
    parts = path.parts
    if parts[0] == "include" and len(parts) > 3:
        return parts[2]
    if parts[0] == "src" and len(parts) > 2:
        return "src/capi" if parts[1] == "capi" else parts[1]
    if parts[0] == "tools" and len(parts) > 2:
        return f"tools/{parts[1]}"
    return None


def fenced_module_of(path):
    """As module_of; a test of a module stands inside the fences of that module."""
    if path.parts[0] == "tests" and len(path.parts) > 3:
        return path.parts[2]
    return module_of(path)


def resolve(root, path, quote, target):
    """Project-relative path of the included file, or None if it is foreign."""
    folders = [path.parent] if quote == '"' else []
    for folder in [*folders, Path("include"), Path("src"), Path("tests")]:
        candidate = (root / folder / target).resolve()
        if candidate.is_file() and candidate.is_relative_to(root):
            return candidate.relative_to(root)
    return None


def include_violations(root, path, quote, target):
    module = module_of(path)
    included = resolve(root, path, quote, target)
    if included is not None:
        other = module_of(included)
        if path.parts[0] == "include" and included.parts[0] != "include":
            yield f"a public header includes the private {included}"
        if module is None or other is None or other == module:
            return
        for name in (module, other):
            if name not in LAYER_OF:
                yield f"module {name} has no layer"
                return
        if LAYER_OF[other] == LAYER_OF[module]:
            yield f"{module} and {other} share a layer and do not see each other"
        elif LAYER_OF[other] > LAYER_OF[module]:
            yield f"{module} includes the higher {other}"
        return
    if target.startswith("thalweg/"):
        yield "no such header"
    for library, (headers, allowed) in FENCES.items():
        if headers.match(target) and fenced_module_of(path) not in allowed:
            if path.parts[0] != "tests" or len(path.parts) > 3:
                yield f"{library} belongs to {' and '.join(sorted(allowed))}"
    standard = C_HEADER if path.suffix == ".h" else STANDARD_HEADER
    if path.parts[0] == "include" and not standard.fullmatch(target):
        yield "a public header includes only the standard library and thalweg/"


def file_violations(root, path):
    if path.name == "CMakeLists.txt":
        if re.search(r"^\s*file\s*\(\s*GLOB", (root / path).read_text(), re.MULTILINE | re.IGNORECASE):
            yield f"{path}: file(GLOB) hides new files from the build"
        return
    for part in [*path.parts[:-1], path.stem]:
        if part in VAGUE_NAMES:
            yield f"{path}: {part} says nothing"
    lines = (root / path).read_text(encoding="utf-8").splitlines()
    limit = MAX_LINES[path.suffix]
    if len(lines) >= limit:
        yield f"{path}: {len(lines)} lines, fewer than {limit} are allowed"
    for number, line in enumerate(lines, start=1):
        if path.parts[0] in ("include", "src") and PRINTS_OR_ENDS.search(line.split("//")[0]):
            yield f"{path}:{number}: the library neither prints nor ends the process"
        match = INCLUDE.match(line)
        if match:
            for text in include_violations(root, path, *match.groups()):
                yield f"{path}:{number}: {match.group(2)}: {text}"


def unlisted_violations(root, path):
    parts = path.parts
    is_source = parts[0] == "src" and len(parts) > 2 and path.suffix == ".cpp"
    is_public_header = parts[0] == "include" and len(parts) > 3
    if is_source or is_public_header:
        module = parts[1] if is_source else parts[2]
        listing = root / "src" / module / "CMakeLists.txt"
        if not listing.is_file() or path.name not in re.split(r"[\s()/]+", listing.read_text()):
            yield f"{path}: not named in src/{module}/CMakeLists.txt"


def readme_layers(text):
    """The table of the README's layer diagram, lowest layer first; empty if there is none."""
    rows = re.findall(r"^([0-9])  (\S.*)$", text, re.MULTILINE)
    rows = [re.sub(r"\s*\|\s*", "  ", row) for _, row in reversed(rows)]
    return [sorted(re.split(r"\s{4,}", row)[0].split()) for row in rows]


def existing_layers(root):
    def exists(module):
        return any((root / folder / module).is_dir() for folder in ("", "src", "include/thalweg"))

    return [sorted(filter(exists, modules)) for modules in LAYERS if any(map(exists, modules))]


def readme_violations(root):
    readme = root / "README.md"
    if readme.is_file() and readme_layers(readme.read_text(encoding="utf-8")) != existing_layers(root):
        yield f"README.md: the layer diagram does not show what there is, {existing_layers(root)}"


def sources(root):
    for folder in ("include", "src", "tools", "tests"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in MAX_LINES or path.name == "CMakeLists.txt":
                yield path.relative_to(root)


def violations(root):
    root = Path(root).resolve()
    laws = (file_violations, unlisted_violations)
    found = [text for path in sources(root) for law in laws for text in law(root, path)]
    return found + list(readme_violations(root))
