"""A model: a mesh, and the roles of its groups."""

from __future__ import annotations

import tempfile
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TypedDict

from contact_dd import folder as folders
from contact_dd import programs, toml
from contact_dd.calls import Calls, call
from contact_dd.errors import InputError, OutputError
from contact_dd.mesh import MeshSource, deck_of, msh_of
from contact_dd.result import Result
from contact_dd.study import Study, cases_of

Number = float | str
"""A number, or an expression of position such as `"1e6*(1 - x^2/25)"`."""

Vector = Sequence[Number]
"""Two numbers, in space three."""

Groups = str | Sequence[str]
"""The name of a physical group of the mesh, or several."""


@dataclass(frozen=True)
class Material:
    """A linear elastic material: Young's modulus and Poisson's ratio, or a stiffness matrix in Voigt's notation
    (in the plane xx, yy, xy, around an axis xx, yy, zz, xy, in space xx, yy, zz, yz, xz, xy; engineering shear
    strains)."""

    young: float | None = None
    poisson: float | None = None
    stiffness: Sequence[Sequence[float]] | None = None
    out_of_plane: Sequence[float] | None = None


class Thermal(TypedDict):
    """Expansion by heat: the coefficient, and the temperature above that without stress."""

    expansion: float
    temperature: Number


class Step(TypedDict, total=False):
    """A load step, as `[[step]]` of a scene: loads that it doesn't mention are the model's, times `scale`."""

    name: str
    time: float
    scale: float | dict[str, float]
    add: str | list[str]
    remove: str | list[str]
    displacement: list[dict[str, Any]]
    traction: list[dict[str, Any]]
    pressure: list[dict[str, Any]]
    force: list[dict[str, Any]]
    body_force: dict[str, Vector]
    temperature: dict[str, Number]
    motion: dict[str, Sequence[float]]
    equation: dict[str, float]
    coupling: dict[str, dict[str, Any]]
    pretension: dict[str, dict[str, Any]]


class Model:
    """A mesh with materials, supports, loads and contacts on its groups.

    `scene` is what `scene.toml` will say, as nested dictionaries; what has no method here can be set there.
    """

    def __init__(self, mesh: MeshSource, scene: dict[str, Any]) -> None:
        self.mesh: bytes | Path = deck_of(mesh) or msh_of(mesh)
        self.scene = scene
        self._calls = Calls()
        self._name = ""

    @classmethod
    def from_mesh(
        cls, mesh: MeshSource, plane: str | None = None, *, units: str = "m", title: str | None = None
    ) -> Model:
        """A model without materials, supports, loads and contacts yet.

        `mesh` is a file of Gmsh's, a deck of Abaqus or CalculiX (`.inp`) or a file that meshio reads, a mesh of
        meshio, or Gmsh's model as it stands (`gmsh.model`). `plane` is "strain", "stress" or "axisymmetric", in space
        None; `units` is "m" (m, N, Pa) or "mm" (mm, N, MPa).
        """
        return cls(mesh, given(title=title, plane=plane, units=units))

    @classmethod
    def from_scene(cls, path: str | Path) -> Model:
        """The model of a `scene.toml`."""
        scene, mesh = scene_of(Path(path))
        model = cls(mesh, scene)
        model._name = str(path)
        return model

    def body(
        self, group: str, material: Material, body_force: Vector | None = None, *,
        initial_stress: Sequence[Number] | None = None, thermal: Thermal | None = None,
        integration: str | None = None,
    ) -> None:
        """Makes a group of cells a body. `body_force` is a force per volume, `initial_stress` the stress that it has
        without strain (xx, yy, zz, xy in plane strain and around an axis; xx, yy, xy in plane stress; in space xx, yy,
        zz, yz, xz, xy), `thermal` its expansion by heat; "reduced" as `integration` takes two points in each
        direction in 8-node quadrilaterals and 20-node hexahedra."""
        known: dict[str, dict[str, Any]] = self.scene.setdefault("materials", {})
        keys = given(**asdict(material))
        name = next((name for name, other in known.items() if other == keys), f"material {len(known) + 1}")
        known[name] = keys
        beside = given(
            body_force=body_force, initial_stress=initial_stress, thermal=thermal, integration=integration
        )
        body = self.scene.setdefault("bodies", {})[group] = {"material": name, **beside}
        self._calls.add(body, call("body", group, **beside))

    def fix(
        self, on: Groups, *, x: Number | None = None, y: Number | None = None, z: Number | None = None,
        normal: bool = False,
    ) -> None:
        """Prescribes displacements: the components that are given, all of them as 0 where none is, or with
        `normal` no displacement along the normal."""
        components = given(x=x, y=y, z=z)
        all_fixed = dict.fromkeys("xy" if "plane" in self.scene else "xyz", 0.0)
        if normal and components:
            raise InputError("fix: normal=True leaves the other directions free; expected no component beside it")
        if normal:
            entry = self._add("bilateral", on=on)
        else:
            entry = self._add("displacement", on=on, **(components or all_fixed))
        self._calls.add(entry, call("fix", on, **components, normal=normal or None))

    def spring(
        self, on: Groups, *, stiffness: Vector | None = None, normal: Number | None = None,
        tangential: Number | None = None,
    ) -> None:
        """Holds points by springs to the ground, each of this stiffness along the axes; or a side by an elastic
        foundation, with stiffnesses per area along the axes, or along the normal and the tangents."""
        keys = given(stiffness=stiffness, normal=normal, tangential=tangential)
        self._calls.add(self._add("spring", on=on, **keys), call("spring", on, **keys))

    def spring_between(
        self, a: Groups, b: Groups, *, stiffness: Sequence[float] | None = None, axial: float | None = None,
        name: str | None = None,
    ) -> None:
        """A spring between two points, or the mean displacements of two groups, with a stiffness along the line between
        them (`axial`) or along the axes (`stiffness`)."""
        keys = given(name=name, stiffness=stiffness, axial=axial)
        self._calls.add(self._add("spring", between=[a, b], **keys), call("spring_between", a, b, **keys))

    def load(
        self, on: Groups, *, pressure: Number | None = None, traction: Vector | None = None,
        force: Vector | None = None, force_on_each: Vector | None = None, body_force: Vector | None = None,
    ) -> None:
        """Adds loads: a pressure, positive into the body; a traction, a force per area in any direction; the total
        force on a side or on points, or the force on each of their nodes; or the body force of bodies, a force per
        volume."""
        loads = (pressure, traction, force, force_on_each, body_force)
        if all(given is None for given in loads):
            raise InputError(f"load on {on!r}: expected a pressure, a traction, a force or a body force")
        if pressure is not None:
            self._calls.add(self._add("pressure", on=on, value=pressure), call("load", on, pressure=pressure))
        if traction is not None:
            self._calls.add(self._add("traction", on=on, value=traction), call("load", on, traction=traction))
        if force is not None:
            self._calls.add(self._add("force", on=on, total=force), call("load", on, force=force))
        if force_on_each is not None:
            entry = self._add("force", on=on, each=force_on_each)
            self._calls.add(entry, call("load", on, force_on_each=force_on_each))
        if body_force is not None:
            for name in [on] if isinstance(on, str) else on:
                if name not in self.scene.get("bodies", {}):
                    raise InputError(f"load: there is no body {name!r}; expected one that `body` has made")
                self.scene["bodies"][name]["body_force"] = body_force

    def contact(
        self, a: Groups | None = None, b: Groups | None = None, *, between: Groups | None = None,
        within: Number | None = None, name: str | None = None, friction: Number | None = None,
        cohesion: Number | None = None, tresca: Number | None = None, gap: Number | None = None,
        adjust: float | None = None, interference: bool | None = None, pairing: str | None = None,
        stiffness: dict[str, Number] | None = None,
    ) -> None:
        """Two sides that may touch, slide and part. Pressures and normals belong to side `a`, of curved sides best the
        one with the coarser mesh; `a` may be points. The gap is measured from the mesh where none is given; `adjust`
        closes some of it.

        With a `stiffness`, {"normal": …} and with friction perhaps "tangential", the sides overlap by pressure over it.

        With `between` in place of sides: contacts wherever two of these bodies touch, or one touches itself, or "all";
        `within` is up to which distance."""
        if (between is None) == (a is None) or (a is None) != (b is None):
            raise InputError("contact: expected two sides, or the bodies between which contacts are found")
        called = name
        if name is None and between is not None:
            name = "contact" if between == "all" else f"contact of {joined(between)}"
        elif name is None and a is not None and b is not None:
            name = f"{joined(a)} on {joined(b)}"
        keys = given(
            between=between, within=within, friction=friction, cohesion=cohesion, tresca=tresca, gap=gap,
            adjust=adjust, interference=interference, pairing=pairing, stiffness=stiffness,
        )
        entry = self._add("contact", name=name, sides=[a, b] if between is None else None, **keys)
        self._calls.add(entry, call("contact", a, b, name=called, **keys))

    def obstacle(
        self, side: Groups, *, point: Sequence[float] | None = None, normal: Sequence[float] | None = None,
        center: Sequence[float] | None = None, axis: Sequence[float] | None = None, radius: float | None = None,
        inside: bool | None = None, motion: Sequence[float] | None = None, name: str | None = None,
        friction: Number | None = None, cohesion: Number | None = None, tresca: Number | None = None,
        gap: Number | None = None, adjust: float | None = None, interference: bool | None = None,
        stiffness: dict[str, Number] | None = None,
    ) -> None:
        """A side that may touch a rigid obstacle: a wall (`point`, `normal` out of the wall), a circle or sphere
        (`center`, `radius`), in space a cylinder (`point`, `axis`, `radius`); `inside` keeps the body inside it. It may
        move by `motion`, or in steps."""
        shape = given(point=point, normal=normal, center=center, axis=axis, radius=radius, inside=inside)
        keys = given(
            motion=motion, friction=friction, cohesion=cohesion, tresca=tresca, gap=gap, adjust=adjust,
            interference=interference, stiffness=stiffness,
        )
        name_of = name or f"{joined(side)} on obstacle"
        entry = self._add("contact", name=name_of, sides=[side], obstacle=shape, **keys)
        self._calls.add(entry, call("obstacle", side, **shape, name=name, **keys))

    def tie(
        self, a: Groups, b: Groups, *, name: str | None = None, tolerance: float | None = None,
        adjust: bool | None = None, pairing: str | None = None,
    ) -> None:
        """Ties two sides, whose meshes match or not, to each other where they are no farther apart than `tolerance`.
        Nodes of side `a`, best the one with the finer mesh, follow side `b`; with `adjust` they are moved onto it."""
        keys = given(tolerance=tolerance, adjust=adjust, pairing=pairing)
        entry = self._add("tie", name=name or f"{joined(a)} on {joined(b)}", sides=[a, b], **keys)
        self._calls.add(entry, call("tie", a, b, name=name, **keys))

    def equation(self, *terms: tuple[Groups, str, float], value: float | None = None, name: str | None = None) -> None:
        """A linear equation between displacements: the sum of factor times displacement over the terms, each a point,
        "x", "y" or "z", and a factor, is `value`, 0 where it isn't given. Of a group it is the mean displacement."""
        tables = [{"at": at, "component": component, "factor": factor} for at, component, factor in terms]
        entry = self._add("equation", name=name, terms=tables, value=value)
        self._calls.add(entry, call("equation", *terms, value=value, name=name))

    def quantity(
        self, name: str, kind: str, *, contact: str | None = None, body: str | None = None, on: str | None = None,
        at: Sequence[float] | None = None, node: int | None = None, direction: str | Sequence[float] | None = None,
        component: str | None = None, about: Sequence[float] | None = None, over: float | None = None,
        tip: str | None = None,
    ) -> None:
        """Asks for a quantity, its value and its derivatives: a "displacement" (`direction`, `at` or `node`), the
        "reaction" of what holds a group (`on`, `direction`), of a contact its "contact_force" (perhaps `direction`),
        its "contact_moment" (`about` a point, in space with the `direction` of an axis), "mean_pressure",
        "largest_pressure" (perhaps smoothed `over` a length) or the "opening" at a point (`at` or `node`), the
        "mean_stress" of a body (`body`, `component`), "k_i", "k_ii" or the "energy_release_rate" of a crack `tip`, as
        "left crack, tip 1", or the elastic "energy". `Result.quantities` and `Result.gradient` have it by its name."""
        keys = given(
            contact=contact, body=body, on=on, at=at, node=node, direction=direction, component=component, about=about,
            over=over, tip=tip,
        )
        entry = self._add("quantity", name=name, kind=kind, **keys)
        self._calls.add(entry, call("quantity", name, kind, **keys))

    def coupling(
        self, on: Groups, point: Sequence[float], *, name: str | None = None, kind: str | None = None,
        directions: Sequence[Sequence[float]] | None = None, axis: dict[str, Sequence[float]] | None = None,
        force: Sequence[float] | None = None, moment: float | Sequence[float] | None = None,
        x: float | None = None, y: float | None = None, z: float | None = None, rx: float | None = None,
        ry: float | None = None, rz: float | None = None,
    ) -> None:
        """Couples a side, or points, to a reference point, "rigid" or "distributing": forces and moments act there, and
        displacements and rotations of it may be prescribed. A rigid one may tie nodes along some `directions` alone,
        which are perpendicular to each other, or with an `axis` of a "point" and a "direction" radial, around and along
        it."""
        of_point = given(force=force, moment=moment, x=x, y=y, z=z, rx=rx, ry=ry, rz=rz)
        keys = given(kind=kind, directions=directions, axis=axis) | of_point
        entry = self._add("coupling", name=name or f"coupling of {joined(on)}", on=on, point=point, **keys)
        self._calls.add(entry, call("coupling", on, point, name=name, **keys))

    def pretension(
        self, on: Groups, *, name: str | None = None, force: float | None = None, shortening: float | None = None,
        direction: Sequence[float] | None = None,
    ) -> None:
        """Tightens a bolt at a cut through it, facets between its cells, by a tensile `force` or by the length that is
        taken out there. A step gives another one, or `{"lock": True}` to keep the length that was reached."""
        keys = given(force=force, shortening=shortening, direction=direction)
        entry = self._add("pretension", name=name or f"pretension of {joined(on)}", on=on, **keys)
        self._calls.add(entry, call("pretension", on, name=name, **keys))

    def cyclic(
        self, a: Groups, b: Groups, point: Sequence[float], sectors: int, *, axis: Sequence[float] | None = None,
        name: str | None = None,
    ) -> None:
        """Makes the mesh one of so many equal `sectors` of a ring about an axis through `point`, in space along `axis`:
        side `b` moves as side `a` does, turned. Their meshes match."""
        keys = given(point=point, axis=axis, sectors=sectors)
        entry = self._add("cyclic", name=name or f"{joined(a)} to {joined(b)}", sides=[a, b], **keys)
        self._calls.add(entry, call("cyclic", a, b, point, sectors, axis=axis, name=name))

    def steps(self, *steps: Step) -> None:
        """Load steps, one after the other."""
        known: list[dict[str, Any]] = self.scene.setdefault("step", [])
        for step in steps:
            known.append(dict(step))
            self._calls.add(known[-1], f"step {len(known)} of steps")

    def write(self, folder: str | Path) -> Path:
        """Writes `scene.toml` and `mesh.msh` into a folder; returns the path of the scene. A deck stays where it is.

        What the package has written there before is replaced; `InputError` is raised where one of the files is
        somebody else's, `OutputError` where they can't be written."""
        for kind in ("materials", "bodies"):
            if not self.scene.get(kind):
                raise InputError("the model has no body; expected a call of `body`, which makes a group of cells one")
        mesh = self.mesh if isinstance(self.mesh, Path) else Path("mesh.msh")
        scene = toml.dumps({"mesh": str(mesh), **self.scene})
        return folders.write(Path(folder), scene, self.mesh if isinstance(self.mesh, bytes) else None)

    def run(
        self, ranks: int = 2, *, folder: str | Path | None = None, subdomains: int | None = None,
        options: Sequence[str] = (), progress: bool | Callable[[dict[str, Any]], None] = True,
    ) -> Result:
        """Solves the model on `ranks` processes.

        Files stand in `folder`, as `write` says, without one as long as the result is in use. `options` are those of
        `contact-dd-mpi`. `progress` prints a line now and then; a function gets the events of `--log json` instead.

        Raises the programs' messages as `InputError`, `NotConverged`, `IllPosed` and so on.
        """
        warned: set[str] = set()
        temporary, problem, worded = self._partition(folder, subdomains, progress, warned)
        result = programs.solve(problem, ranks, options, progress, worded, warned)
        result.folder = temporary
        return result

    def study(
        self, vary: Mapping[str, Sequence[float]], ranks: int = 2, *, folder: str | Path | None = None,
        subdomains: int | None = None, options: Sequence[str] = (),
        progress: bool | Callable[[dict[str, Any]], None] = True,
    ) -> Study:
        """Solves for all combinations of the values of parameters, by the factors of one run, and returns the table
        of the quantities that the model asks for.

        `vary` has the values by the names of parameters, as `Result.gradient` has them, or a part that only one name
        has, as "friction": factors of loads, additions to gaps, coefficients of friction. What changes the stiffness
        takes a run of its own. The other arguments are those of `run`.
        """
        # The folder is needed until the table is read.
        warned: set[str] = set()
        temporary, problem, worded = self._partition(folder, subdomains, progress, warned)
        cases = cases_of(problem, vary)
        table = programs.study(problem, cases, ranks, options, progress, worded, warned)
        if temporary:
            temporary.cleanup()
        return table

    def _partition(
        self, folder: str | Path | None, subdomains: int | None,
        progress: bool | Callable[[dict[str, Any]], None], warned: set[str],
    ) -> tuple[tempfile.TemporaryDirectory[str] | None, Path, Callable[[str], str]]:
        """Writes the problem file into a folder; returns the folder if it is temporary, the file, and a function that
        completes messages. Warnings are added to those `warned`."""
        try:
            temporary = tempfile.TemporaryDirectory(prefix="contact-dd-") if folder is None else None
        except OSError as error:
            raise OutputError(f"no temporary folder can be made: {error.strerror}") from error
        scene = self.write(temporary.name if temporary else folder or ".")

        def worded(message: str) -> str:
            return self._calls.worded(message, self.scene, scene, self._name)

        return temporary, programs.partition(scene, subdomains, progress, worded, warned=warned), worded

    def _add(self, kind: str, /, **keys: Any) -> dict[str, Any]:
        entry = given(**keys)
        self.scene.setdefault(kind, []).append(entry)
        return entry


def scene_of(path: Path) -> tuple[dict[str, Any], Path]:
    """Tables of a `scene.toml`, and its mesh file."""
    try:
        scene = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path}: {error}") from error
    if not isinstance(scene.get("mesh"), str):
        raise InputError(f"{path}: there is no key 'mesh'; expected the name of the mesh file")
    return scene, path.parent / scene.pop("mesh")


def given(**keys: Any) -> dict[str, Any]:
    """Entries that aren't None."""
    return {name: value for name, value in keys.items() if value is not None}


def joined(groups: Groups) -> str:
    return groups if isinstance(groups, str) else ", ".join(groups)
