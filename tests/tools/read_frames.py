#!/usr/bin/env python3
"""Runs the first frames of a scene and reads them with python3-meshio: counts, positions, velocities, contact.

The volume is computed here from the triangles and compared with measures.csv; the momentum of the vertices of
a drop in free fall with g t.
"""
import csv
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np


def main(tool: str, scene: str) -> int:
    with tempfile.TemporaryDirectory() as directory:
        subprocess.run([tool, "evolve", scene, "-o", directory, "--frames", "12", "-q"], check=True)
        rows = list(csv.DictReader(open(pathlib.Path(directory) / "measures.csv")))
        frames = sorted(pathlib.Path(directory).glob("frame_*.ply"))
        assert len(frames) == 13 == len(rows), (len(frames), len(rows))
        for path, row in zip(frames, rows):
            mesh = meshio.read(path)
            x = mesh.points
            v = np.stack([mesh.point_data[k] for k in ("vx", "vy", "vz")], axis=1)
            contact = mesh.point_data["contact"]
            faces = mesh.cells_dict["triangle"]
            assert x.dtype == np.float64 and v.dtype == np.float64
            assert mesh.point_data["drop"].dtype == np.int32 and contact.itemsize == 1
            assert len(faces) == int(row["triangles"]) == 2 * len(x) - 4  # Euler: one closed drop
            a, b, c = (x[faces[:, k]] - x.mean(axis=0) for k in range(3))
            volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
            assert abs(volume / float(row["volume"]) - 1) < 1e-12, (path, volume, row["volume"])
            time = float(row["time"])
            if (contact == 0).all():
                assert abs(v[:, 2].mean() + 981 * time) < 0.02 * 981 * max(time, 1e-3), (path, v[:, 2].mean(), time)
        assert (contact != 0).any(), "the last frame should be on the plate"
    print(f"{len(frames)} frames read")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
