#!/usr/bin/env python3
"""Compressed LAS gives the same TIN as the file it was made of: point formats 0 and 6, classes, returns, withheld points.

Runs where Thalweg was built with PDAL and the program pdal, which compresses, is there; exit status 77 elsewhere.
Usage: laz.py BINARY
"""
import json
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile


def write_las(path, point_format):
    """2000 points of LAS 1.4: scattered, of classes 1 to 9, up to three returns, each tenth withheld."""
    draw = random.Random(7)
    record, header = {0: 20, 6: 30}[point_format], 375
    head = bytearray(header)
    head[0:4] = b"LASF"
    head[6] = 0 if point_format < 6 else 16  # these want their CRS, if any, as WKT
    head[24:26] = bytes([1, 4])
    struct.pack_into("<HIIBH", head, 94, header, header, 0, point_format, record)
    count = 2000
    struct.pack_into("<I", head, 107, count if point_format < 6 else 0)
    struct.pack_into("<6d", head, 131, 0.001, 0.001, 0.001, 500000, 5000000, 100)
    struct.pack_into("<6d", head, 179, 501000, 500000, 5001000, 5000000, 200, 100)
    struct.pack_into("<Q", head, 247, count)
    body = bytearray()
    for i in range(count):
        point = bytearray(record)
        struct.pack_into("<3i", point, 0, *(draw.randrange(1000000) for _ in range(2)), draw.randrange(100000))
        returns = draw.randint(1, 3)
        number = draw.randint(1, returns)
        point_class = draw.randint(1, 9)
        withheld = i % 10 == 0
        if point_format < 6:
            point[14] = number | returns << 3
            point[15] = point_class | (0x80 if withheld else 0)
        else:
            point[14] = number | returns << 4
            point[15] = 4 if withheld else 0
            point[16] = point_class
        body += point
    with open(path, "wb") as file:
        file.write(head + body)


def main():
    binary = os.path.abspath(sys.argv[1])
    formats = json.loads(subprocess.run([binary, "formats", "-f", "json"], check=True, capture_output=True).stdout)
    if "LAZ" not in formats["points"] or not shutil.which("pdal"):
        print("skip: built without PDAL, or there is no program pdal")
        return 77
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for point_format in (0, 6):
            las, laz = (f"{folder}/{point_format}.{extension}" for extension in ("las", "laz"))
            write_las(las, point_format)
            subprocess.run(["pdal", "translate", las, laz, "--writers.las.compression=true", "--writers.las.forward=all",
                            "--writers.las.minor_version=4", f"--writers.las.dataformat_id={point_format}"], check=True)
            for options in ([], ["--classes", "2,9"], ["--returns", "first"], ["--returns", "last", "--classes", "1"]):
                meshes = []
                for source in (las, laz):
                    mesh = source + ".ply"
                    subprocess.run([binary, "build", source, mesh, "-q", "--overwrite", *options], check=True)
                    with open(mesh, "rb") as file:
                        meshes.append(file.read())
                same = meshes[0] == meshes[1]
                failed += not same
                print(f"{'ok  ' if same else 'FAIL'} point format {point_format} {' '.join(options)}")
    print(f"{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
