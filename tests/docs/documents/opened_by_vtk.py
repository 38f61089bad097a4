"""Compares what VTK's own reader finds in a file with what h5py reads.

    python opened_by_vtk.py FILE PARTITIONS FIELD...
"""

import sys

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

# Nodes of VTK's types of cells.
NODES = {5: 3, 22: 6, 9: 4, 23: 8, 28: 9, 10: 4, 24: 10, 12: 8, 25: 20, 29: 27}


def by_vtk(path, step):
    """A list over the partitions of a load step; each maps the names of arrays to arrays."""
    reader = vtkHDFReader()
    assert reader.CanReadFile(path), f"VTK can't read {path}"
    reader.SetFileName(path)
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == steps_of(path), reader.GetNumberOfSteps()
    reader.SetStep(step)
    reader.Update()
    whole = reader.GetOutputDataObject(0)
    return [of_grid(whole.GetPartition(i)) for i in range(whole.GetNumberOfPartitions())]


def steps_of(path):
    """The number of load steps, 1 in a file without any."""
    with h5py.File(path) as file:
        steps = file["VTKHDF"].get("Steps")
        return 1 if steps is None else len(steps["Values"])


def of_grid(grid):
    cells = grid.GetCells()
    arrays = {
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
        "connectivity": vtk_to_numpy(cells.GetConnectivityArray()),
        "offsets": vtk_to_numpy(cells.GetOffsetsArray()),
        "types": np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]),
    }
    for kind, data in ("PointData", grid.GetPointData()), ("CellData", grid.GetCellData()):
        for i in range(data.GetNumberOfArrays()):
            arrays[f"{kind}/{data.GetArrayName(i)}"] = vtk_to_numpy(data.GetArray(i))
    return arrays


def by_h5py(path, step):
    """The same from the datasets, of which fields hold all steps one after the other."""
    partitions = []
    with h5py.File(path) as file:
        grid = file["VTKHDF"]
        point = cell = entry = 0
        for i in range(len(grid["NumberOfPoints"])):
            points = slice(point, point := point + grid["NumberOfPoints"][i])
            entries = slice(entry, entry := entry + grid["NumberOfConnectivityIds"][i])
            # Every partition before this one has an offset more than cells.
            offsets = slice(cell + i, cell + i + grid["NumberOfCells"][i] + 1)
            cells = slice(cell, cell := cell + grid["NumberOfCells"][i])
            arrays = {
                "points": grid["Points"][points],
                "connectivity": grid["Connectivity"][entries],
                "offsets": grid["Offsets"][offsets],
                "types": grid["Types"][cells],
            }
            for kind, rows in ("PointData", points), ("CellData", cells):
                whole = len(grid["Points" if kind == "PointData" else "Types"])
                for name, data in grid[kind].items():
                    first = step * whole if len(data) > whole else 0
                    arrays[f"{kind}/{name}"] = data[first + rows.start : first + rows.stop]
            partitions.append(arrays)
    return partitions


def main():
    path, partitions, fields = sys.argv[1], int(sys.argv[2]), set(sys.argv[3:])
    for step in range(steps_of(path)):
        compare(path, step, partitions, fields)


def compare(path, step, partitions, fields):
    opened, written = by_vtk(path, step), by_h5py(path, step)
    assert len(opened) == len(written) == partitions, (len(opened), len(written))
    for i, (one, other) in enumerate(zip(opened, written)):
        assert one.keys() == other.keys(), (one.keys(), other.keys())
        assert fields <= one.keys(), fields - one.keys()
        for name, array in one.items():
            assert array.shape == other[name].shape, (i, name, array.shape, other[name].shape)
            assert np.array_equal(array, other[name]), (i, name)
        check_cells(one)
    # The partitions make the whole.
    with h5py.File(path) as file:
        wholes = [("points", "Points"), ("types", "Types"), ("connectivity", "Connectivity")]
        for name, dataset in wholes:
            assert sum(len(one[name]) for one in opened) == len(file["VTKHDF"][dataset]), name


def check_cells(grid):
    """Every cell has as many nodes as its type, and they are nodes of its partition."""
    assert len(grid["types"]) > 0
    nodes = [NODES[kind] for kind in grid["types"]]
    assert np.array_equal(np.diff(grid["offsets"]), nodes)
    assert set(grid["connectivity"]) == set(range(len(grid["points"])))


main()
