"""What a result file says of its run: units, report, sweeps, contacts along their sides."""

import json
import sys

import h5py
import numpy as np

from drawing.sides import boundary_edges, curves_along
from drawing.units import units_of


def last(column):
    """A column of a contact in the last load step."""
    return column[-1] if column.ndim > 1 else column[:]


def shear(table):
    """The tangential force over area along the normal turned by 90°; nothing where there is no friction.

    The area is that of force and pressure, so that open conditions have none."""
    if "tangential_force" not in table:
        return None
    force, pressure = last(table["force"]), last(table["pressure"])
    forces = table["tangential_force"]
    forces = forces[-1] if forces.ndim > 2 else forces[:]
    normal = table["normal"][:]
    along = normal[:, 0] * forces[:, 1] - normal[:, 1] * forces[:, 0]
    return np.divide(along * pressure, force, out=np.zeros(len(force)), where=force > 0)


def read(path):
    """The units, the report, the rows of the sweeps, and of each contact pressure, shear and status along its side."""
    try:
        with h5py.File(path) as file:
            units = units_of(file)
            report = json.loads(file.attrs["report"])
            sweeps = {name: file["convergence"][name][:] for name in ("residual", "active")}
            same = np.zeros(len(sweeps["residual"]), dtype=int)
            sweeps["step"] = file["convergence"]["step"][:] if "step" in file["convergence"] else same
            tables = {name: table for name, table in file.get("contact", {}).items() if len(table["position"]) > 0}
            tags = [table["node_a"][:] for table in tables.values()]
            edges = boundary_edges(file["VTKHDF"], np.concatenate(tags)) if tags else []
            tables = {
                name: {
                    "pieces": curves_along(table["position"][:, :2], table["node_a"][:], edges),
                    **{key: last(table[key]) for key in ("pressure", "status")},
                    "shear": shear(table),
                }
                for name, table in tables.items()
            }
    except FileNotFoundError:
        print(f"summary: {path}: there is no such file", file=sys.stderr)
        sys.exit(2)
    except (OSError, KeyError, ValueError):
        print(f"summary: {path}: isn't a result of contact-dd-mpi, a file .vtkhdf", file=sys.stderr)
        sys.exit(2)
    return units, report, sweeps, tables
