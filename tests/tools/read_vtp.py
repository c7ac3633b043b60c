#!/usr/bin/env python3
"""Reads the VTP frames of a run with VTK's own reader, and frames.pvd: counts, positions, velocities, contact, times.

The PLY frames, read by meshio, are the truth.
"""
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import meshio
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkMassProperties
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def read_vtp(path: pathlib.Path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def compare(path: pathlib.Path, time: float) -> bool:
    truth = meshio.read(path.with_suffix(".ply"))
    mesh = read_vtp(path)
    data = mesh.GetPointData()
    assert vtk_to_numpy(mesh.GetFieldData().GetArray("TimeValue")).tolist() == [time], path
    assert np.array_equal(vtk_to_numpy(mesh.GetPoints().GetData()), truth.points), path
    assert np.array_equal(vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3),
                          truth.cells_dict["triangle"]), path
    velocity = np.stack([truth.point_data[k] for k in ("vx", "vy", "vz")], axis=1)
    assert np.array_equal(vtk_to_numpy(data.GetVectors("velocity")), velocity), path
    for name in ("drop", "contact"):
        array = vtk_to_numpy(data.GetArray(name))
        wanted = truth.point_data[name]  # meshio takes PLY's uchar for int8
        assert array.dtype.itemsize == wanted.dtype.itemsize and np.array_equal(array, wanted), path
    measure = vtkMassProperties()
    measure.SetInputData(mesh)
    assert abs(measure.GetVolume() / (4 / 3 * np.pi * 0.2**3) - 1) < 0.02, path  # a drop of R = 0.2 cm, closed, outward
    return bool((velocity != 0).any())


def main(tool: str, scene: str) -> int:
    with tempfile.TemporaryDirectory() as directory:
        subprocess.run([tool, "evolve", scene, "-o", directory, "--frames", "12", "--frames-as", "vtp", "-q"], check=True)
        root = pathlib.Path(directory)
        sets = xml.parse(root / "frames.pvd").getroot().findall("./Collection/DataSet")
        assert [s.get("file") for s in sets] == [f"frame_{k:04}.vtp" for k in range(13)]
        times = [float(s.get("timestep")) for s in sets]
        assert np.allclose(times, np.arange(13) / 240, rtol=0, atol=1e-12), times
        moving = [compare(root / s.get("file"), time) for s, time in zip(sets, times)]
        assert moving == [False] + [True] * 12
        empty = root / "none.off"
        empty.write_text("OFF\n0 0 0\n")
        subprocess.run([tool, "convert", empty, root / "none.vtp"], check=True)
        assert read_vtp(root / "none.vtp").GetNumberOfPoints() == 0
    print(f"{len(times)} frames read")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
