"""The result of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from contact_dd.cells import Cells, cells_of
from contact_dd.errors import InputError
from contact_dd.report import report_of

if TYPE_CHECKING:
    import pyvista
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]

# Kinds of problems by the `plane` of a result.
KINDS = {"strain": "plane strain", "stress": "plane stress", "axisymmetric": "axisymmetric"}

# Columns of a contact table with a row for each load step.
STATES = ("gap", "force", "pressure", "status", "tangential_force", "slip", "overclosure")


class Result:
    """Results of one load step in a result file, the last one without `step`.

    Every node of the mesh is there once, in the order of the mesh's tags; where the stresses of two materials meet it
    may be there once for each. In 2-D forces are per unit of thickness, around an axis of the whole
    ring.
    """

    path: Path
    """The result file."""
    report: dict[str, Any]
    """The report of the run."""
    title: str
    """The scene's title; may be empty."""
    units: str
    """"m" (m, N, Pa) or "mm" (mm, N, MPa)."""
    plane: str | None
    """"strain", "stress" or "axisymmetric"; None in space, and for files without it."""
    step: int
    """The load step, from 1."""
    steps: int
    """The number of load steps."""
    nodes: NDArray[np.int64]
    """The tags that nodes have in the mesh file."""
    points: Floats
    """Coordinates of the nodes, undeformed; (n, 3)."""
    displacement: Floats
    """Displacements of the nodes; (n, 3)."""
    since: int
    """The load step at whose end the newest body or contact was added, whose displacements and gaps count from there;
    0 where none was added."""
    deformation: Floats
    """Displacements since then, with which bodies that were added lie where they belong; (n, 3)."""
    stress: Floats
    """Recovered stresses at nodes, XX YY ZZ XY YZ XZ, positive in tension; (n, 6), without rows after `--no-stress`."""
    cells: list[Cells]
    """The cells of each kind that are there in this step, by rows of `points`."""
    cell_data: dict[str, NDArray[Any]]
    """Arrays of the cells: `Stress`, `PrincipalStress`, `VonMises`, `EnergyError`, `Material`, `Subdomain`; where steps
    add or remove bodies `Present`, 0 in cells of inactive ones."""
    contacts: dict[str, NDArray[Any]]
    """A structured array for each contact, a row for each condition: `position`, `normal`, `gap`, `force`, `pressure`,
    `status` (0 open, 1 closed, 2 slipping), `node_a`, `node_b` (-1 but for the node that has the condition, and its
    partner where nodes match); with friction `tangential_force`, `slip`. Of a contact
    that isn't there every `gap` is NaN."""

    convergence: dict[str, NDArray[Any]]
    """A row for each sweep, of each load step the first the bilateral start: `residual`, `active`, `seconds`, with load
    steps `step`, from 0."""

    def __init__(self, path: str | Path, step: int | None = None) -> None:
        self.path = Path(path)
        self.folder: Any = None
        if not self.path.exists():
            raise InputError(f"{path}: there is no such file")
        try:
            with h5py.File(self.path) as file:
                self._read(file, step)
        except ValueError as error:
            raise InputError(f"{path}: isn't a whole result of contact-dd-mpi: {error}") from error
        except (OSError, LookupError, TypeError, AttributeError, RuntimeError) as error:
            # Exceptions of HDF5 and NumPy for a file with other contents in the place of fields.
            raise InputError(f"{path}: isn't a result of contact-dd-mpi, a file .vtkhdf") from error

    def __repr__(self) -> str:
        return f"<Result of step {self.step} of {self.steps} in {str(self.path)!r}>"

    def __str__(self) -> str:
        """What was solved, its size, the status, the largest stress and the estimated error, a line each."""
        report, part = self.report, self._report_of_step()
        kind = "in space" if self.is_in_space else KINDS.get(self.plane or "", "in the plane")
        contacts, subdomains = counted(len(self.contacts), "contact"), counted(report["subdomains"], "subdomain")
        step = f", load step {self.step} of {self.steps}" if self.steps > 1 else ""
        status = "converged" if part["status"] == "converged" else "not converged, numbers aren't to be used"
        closed = f"{part['active_contacts']} of {report['contact_conditions']} contact constraints closed"
        stress = "stresses were left out"
        if len(self.stress):
            unit = "MPa" if self.units == "mm" else "Pa"
            stress = f"largest von Mises stress {np.nanmax(self.von_mises):.5g} {unit}"
        relative = (part.get("error_estimate") or {}).get("relative")
        error = "no error estimate" if relative is None else f"estimated error {relative:.2%} in the energy norm"
        return "\n".join([
            f"{self.title or self.path.name}: {kind}, {contacts}{step}",
            f"{report['dofs']} degrees of freedom in {subdomains}",
            f"{status} after {counted(part['sweeps'], 'sweep')} of {report['method']}, {closed}",
            stress,
            error,
        ])

    def _read(self, file: h5py.File, step: int | None) -> None:
        grid = file["VTKHDF"]
        if "Displacement" not in grid["PointData"]:
            raise InputError(f"{self.path}: is a problem file; contact-dd-mpi {self.path} solves it")
        self._said = file.attrs["report"]
        self.report = report_of(self._said)
        text = {name: value.decode() if isinstance(value, bytes) else value for name, value in file.attrs.items()}
        self.title = text.get("title", "")
        self.units = text.get("units", "m")
        if self.units not in ("m", "mm"):
            raise ValueError(f"it is in {self.units!r}; expected units of 'm' or 'mm'")
        self.plane = text.get("plane")
        self.steps = int(grid["Steps"].attrs["NSteps"]) if "Steps" in grid else 1
        self.step = self.steps if step is None else step
        if not 1 <= self.step <= self.steps:
            raise InputError(f"{self.path}: there is no step {step}; expected 1 to {self.steps}")

        has_stress = "Stress" in grid["PointData"]
        stress = self._of_step(grid, "PointData/Stress", self.step) if has_stress else np.zeros((0, 6))
        kept, row = unique_nodes(grid["PointData/GlobalNodeId"][:], stress)
        self.nodes = grid["PointData/GlobalNodeId"][:][kept]
        self.points = grid["Points"][:][kept]
        self.displacement = self._of_step(grid, "PointData/Displacement", self.step)[kept]
        self.since = since(self.report.get("steps") or [], self.step)
        before = self._of_step(grid, "PointData/Displacement", self.since)[kept] if self.since else 0.0
        self.deformation = self.displacement - before
        self.stress = stress[kept] if len(stress) else stress
        constant = ("Material", "Subdomain")
        self.cell_data = {
            name: grid["CellData"][name][:] if name in constant else self._of_step(grid, f"CellData/{name}", self.step)
            for name in grid["CellData"]
        }
        cells = [Cells(kind, members, row[nodes]) for kind, members, nodes in cells_of(grid)]
        is_there = self.cell_data.get("Present", np.ones(len(grid["Types"]))) > 0
        self.cells = [
            Cells(of.kind, of.members[there], of.nodes[there])
            for of, there in ((of, is_there[of.members]) for of in cells)
            if there.any()
        ]
        self.convergence = {name: column[:] for name, column in file["convergence"].items()}
        self.contacts = {name: self._contact(table) for name, table in file.get("contact", {}).items()}

    def _of_step(self, grid: h5py.Group, name: str, step: int) -> NDArray[Any]:
        """The rows of a step; those of all steps follow each other."""
        rows = len(grid[name]) // self.steps
        values: NDArray[Any] = grid[name][(step - 1) * rows : step * rows]
        return values

    def _contact(self, table: h5py.Group) -> NDArray[Any]:
        has_steps = table["status"].ndim == 2
        columns = {key: table[key][self.step - 1] if has_steps and key in STATES else table[key][:] for key in table}
        rows = np.zeros(len(columns["position"]), [(key, of.dtype, of.shape[1:]) for key, of in columns.items()])
        for key, of in columns.items():
            rows[key] = of
        return rows

    def at_step(self, step: int) -> Result:
        """The result of another load step, from 1. Raises `InputError` where another run has written the file since."""
        other = Result(self.path, step)
        if other._said != self._said:
            raise InputError(
                f"{self.path}: another run has written it since it was read; expected a folder for each run"
            )
        other.folder = self.folder
        return other

    @property
    def contacts_there(self) -> dict[str, NDArray[Any]]:
        """The contacts that are there in this step."""
        tables = self.contacts.items()
        return {name: table for name, table in tables if not len(table) or not np.isnan(table["gap"]).all()}

    @property
    def quantities(self) -> dict[str, float]:
        """The values of the quantities that the scene asks for, by their names."""
        return {one["name"]: number(one["value"]) for one in self._report_of_step().get("quantities") or []}

    @property
    def quantity_errors(self) -> dict[str, float | None]:
        """The estimated errors of the mesh in the quantities, each its value less the exact one, by their names;
        `None` where there is no estimate."""
        errors = {one["name"]: one.get("error") for one in self._report_of_step().get("quantities") or []}
        return {name: None if error is None else number(error) for name, error in errors.items()}

    @property
    def quantity_error_bars(self) -> dict[str, float | None]:
        """How far the exact quantities may be from their values, by their names; `None` where there is no estimate."""
        bars = {one["name"]: one.get("error_bar") for one in self._report_of_step().get("quantities") or []}
        return {name: None if bar is None else number(bar) for name, bar in bars.items()}

    def gradient(self, name: str) -> dict[str, float]:
        """The derivatives of a quantity, by the names of the parameters: loads (of a factor), Young's moduli, gaps,
        prescribed displacements and coefficients of friction.

        Where a contact point is about to change, as `about_to_change` of the report says, they hold on the side on
        which it doesn't. Raises `InputError` where there is no such quantity, or it has no derivatives."""
        report = self._report_of_step()
        found = {one["name"]: one["derivatives"] for one in report.get("quantities") or []}
        if name not in found:
            known = ", ".join(repr(known) for known in found) or "none, as the scene asks for none"
            raise InputError(f"{self.path}: there is no quantity {name!r}; known are {known}")
        if not found[name] and report.get("without_derivatives"):
            raise InputError(f"{self.path}: quantity {name!r} has no derivatives: {report['without_derivatives']}")
        return {one["parameter"]: number(one["derivative"]) for one in found[name]}

    def _report_of_step(self) -> dict[str, Any]:
        """The report's entry of this load step."""
        steps = self.report.get("steps")
        part: dict[str, Any] = steps[self.step - 1] if steps else self.report
        return part

    @property
    def von_mises(self) -> NDArray[np.float64]:
        """The von Mises stress of the stress recovered at nodes."""
        xx, yy, zz, xy, yz, xz = self.stress.T
        axial = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
        equivalent: NDArray[np.float64] = np.sqrt(0.5 * axial + 3 * (xy**2 + yz**2 + xz**2))
        return equivalent

    @property
    def is_in_space(self) -> bool:
        """True if the cells are volumes."""
        return any(cells.kind in (10, 12, 24, 25, 29) for cells in self.cells)

    def plot(self, picture: str = "overview", scale: float | None = None, circle: float | None = None) -> Figure:
        """A picture by matplotlib: `overview`, the deformed shape by von Mises stress with the contact pressures; in
        the plane also `deformation`, `u_x`, `u_y`, `tau_x`, `tau_y`, `tau_xy`, `principal`, in space `displacement`,
        `von_mises`, `pressure`. Without `scale`
        displacements are enlarged until they show, unless closed contacts would seem to overlap. `circle` is the
        radius of a dashed circle on the pressures of an overview in space, around the origin."""
        from contact_dd.drawing.pictures import draw

        figure: Figure
        [(_, figure)] = draw(self, [picture], scale, circle)
        return figure

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """A grid for PyVista with all fields, of the bodies that are there; `grid.warp_by_vector("Displacement")`
        deforms it, where bodies have come `"Deformation"`."""
        import pyvista

        grid = pyvista.UnstructuredGrid({cells.kind: cells.nodes for cells in self.cells}, self.points)
        grid.point_data["Displacement"] = self.displacement
        if self.since:
            grid.point_data["Deformation"] = self.deformation
        grid.point_data["GlobalNodeId"] = self.nodes
        if len(self.stress):
            grid.point_data["Stress"] = self.stress
            grid.point_data["VonMises"] = self.von_mises
        order = np.concatenate([cells.members for cells in self.cells])
        for name, values in self.cell_data.items():
            grid.cell_data[name] = values[order]
        return grid


def since(steps: list[dict[str, Any]], step: int) -> int:
    """The last step before `step`, from 1, at whose end bodies or contacts were added; 0 where there is none."""
    absent = [set(one["absent"]) for one in steps[:step]]
    return max((k for k in range(1, step) if absent[k - 1] - absent[k]), default=0) if absent else 0


def counted(count: int, noun: str) -> str:
    """A number with a noun."""
    return f"{count} {noun}{'s' * (count != 1)}"


def number(value: float | None) -> float:
    """A number of a report, where null stands for one that isn't finite."""
    return float("nan") if value is None else float(value)


def unique_nodes(tags: NDArray[Any], stress: NDArray[Any]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The points of a file that stand for nodes, in the order of tags, and for each point which one it is.

    Points of one tag are one node, unless their stresses differ."""
    order = np.argsort(tags, kind="stable")
    is_new = np.ones(len(tags), dtype=bool)
    is_new[1:] = tags[order][1:] != tags[order][:-1]
    if len(stress):
        first = order[is_new][np.cumsum(is_new) - 1]
        is_new |= (stress[order] != stress[first]).any(axis=1)
    row = np.empty(len(tags), dtype=np.intp)
    row[order] = np.cumsum(is_new) - 1
    return order[is_new], row
