"""What a result file says of its run: the report, the sweeps, the tables of the contacts."""

import json
import sys

import h5py
import numpy as np


def last(column):
    """A column of a contact in the last load step."""
    return column[-1] if column.ndim > 1 else column[:]


def read(path):
    """The report, the rows of the sweeps and the tables of the contacts."""
    try:
        with h5py.File(path) as file:
            report = json.loads(file.attrs["report"])
            sweeps = {name: file["convergence"][name][:] for name in ("residual", "active")}
            same = np.zeros(len(sweeps["residual"]), dtype=int)
            sweeps["step"] = file["convergence"]["step"][:] if "step" in file["convergence"] else same
            tables = {
                name: {"position": table["position"][:], **{key: last(table[key]) for key in ("pressure", "status")}}
                for name, table in file.get("contact", {}).items()
                if len(table["position"]) > 0
            }
    except FileNotFoundError:
        print(f"summary: {path}: there is no such file", file=sys.stderr)
        sys.exit(2)
    except (OSError, KeyError, ValueError):
        print(f"summary: {path}: isn't a result of contact-dd-mpi, a file .vtkhdf", file=sys.stderr)
        sys.exit(2)
    return report, sweeps, tables


def from_mm(report, tables):
    """Turns what is in mm, N and MPa into m, N and Pa, as far as the page shows it."""
    for part in [report, *(report.get("steps") or [])]:
        for contact in part["contacts"]:
            contact["largest_pressure"] = contact["largest_pressure"] and 1e6 * contact["largest_pressure"]
        for one in [*part["contacts"], *part["reactions"]]:
            # Forces are per length.
            one["force"] = [force and 1e3 * force for force in one["force"]]
    for table in tables.values():
        table["position"] = 1e-3 * table["position"]
        table["pressure"] = 1e6 * table["pressure"]
