#!/usr/bin/env python3
"""Fails if a folder of the library includes one that it may not, or a header includes heavy CGAL."""
import pathlib
import re
import sys

LAYERS = {
    "core": set(),
    "geometry": {"core"},
    "io": {"core"},
    "state": {"core", "geometry", "io"},
    "operators": {"core", "geometry", "state"},
    "topology": {"core", "geometry", "state"},
    "scene": {"core", "geometry", "state"},
    "frames": {"core", "geometry", "io", "state"},
    "simulation": {"core", "geometry", "io", "state", "operators", "topology", "scene", "frames"},
}
HEAVY = re.compile(r"CGAL/(AABB|Polygon_mesh_processing|corefine|Side_of_triangle_mesh|Delaunay|box_intersection)")
CLOCKS = re.compile(r"std::(cout|cerr|exit|chrono)|\bprintf\(|\bgetenv\(")


def main(root: pathlib.Path) -> int:
    errors = []
    for top in ("include/meniscus", "src"):
        for path in sorted((root / top).rglob("*.[hc]*")):
            folder = path.relative_to(root / top).parts[0]
            allowed = LAYERS.get(folder)
            if allowed is None:
                errors.append(f"{path}: folder {folder} has no layer; add it to check_layers.py and CONTRIBUTING.md")
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                place = f"{path.relative_to(root)}:{number}"
                included = re.match(r'\s*#include "meniscus/(\w+)/', line)
                if included and included[1] != folder and included[1] not in allowed:
                    errors.append(f"{place}: {folder} may not include {included[1]}")
                if top.startswith("include") and "#include" in line and HEAVY.search(line):
                    errors.append(f"{place}: heavy CGAL headers belong in .cpp files")
                if not line.lstrip().startswith("//") and CLOCKS.search(line):
                    errors.append(f"{place}: the library never prints, exits or reads the clock or the environment")
    print("\n".join(errors) or "layers are kept")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
