"""Writes a table of many reports as CSV, a row a report; run it by scripts/collect."""

import csv
import json
import pathlib
import signal
import sys

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "docs" / "report.schema.json"
HDF5 = b"\x89HDF\r\n\x1a\n"


def fail(text):
    print(f"collect: {text}", file=sys.stderr)
    sys.exit(2)


def columns(schema, part, prefix=""):
    """Names and paths of all fields of `part` but lists of anything else than words."""
    for name in part["required"]:
        field = part["properties"][name]
        # An optional value is a choice between its type and null.
        for choice in [field, *field.get("anyOf", [])]:
            if "$ref" in choice:
                field = schema["$defs"][choice["$ref"].removeprefix("#/$defs/")]
        if "properties" in field:
            for column, path in columns(schema, field, f"{prefix}{name}_"):
                yield column, (name, *path)
        elif field.get("type") != "object" and field.get("items", {"type": "string"}).get("type") == "string":
            yield prefix + name, (name,)


def value(report, path):
    for name in path:
        report = report.get(name) if isinstance(report, dict) else None
    if isinstance(report, list):
        return " | ".join(map(str, report))
    return report


def read(path):
    try:
        content = pathlib.Path(path).read_bytes()
    except OSError as error:
        fail(f"{path}: {error.strerror}")
    if content.startswith(HDF5):
        content = report_of_result(path)
    try:
        report = json.loads(content)
    except ValueError as error:
        fail(f"{path}: isn't a report: {error}; expected the JSON of contact-dd-mpi --report")
    for name in ("status", "certificate", "per_rank"):
        if not isinstance(report, dict) or name not in report:
            fail(f"{path}: isn't a report: it has no '{name}'; expected the JSON of contact-dd-mpi --report")
    return report


def report_of_result(path):
    try:
        import h5py
    except ImportError:
        fail(f"{path}: result files are read with h5py, which {sys.executable} doesn't have; "
             "expected a report, or a Python with h5py: FIGURES_PYTHON=PYTHON scripts/collect ...")
    try:
        with h5py.File(path) as file:
            return file.attrs["report"]
    except (OSError, KeyError):
        fail(f"{path}: isn't a result: it has no attribute 'report'; expected a file of contact-dd-mpi")


def row(path, report, known):
    cells = {"file": path, **{column: value(report, where) for column, where in known}}
    sent = [rank.get("bytes_sent") for rank in report["per_rank"]]
    pressures = [contact.get("largest_pressure") for contact in report.get("contacts", [])]
    cells["bytes_sent"] = None if None in sent else sum(sent)
    cells["largest_pressure"] = max((p for p in pressures if p is not None), default=None)
    return cells


def main():
    # Where nobody reads on, as behind `| head`, there is nothing more to do.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    paths = sys.argv[1:]
    if not paths:
        fail("expected reports: scripts/collect REPORT...; --help tells more")
    schema = json.loads(SCHEMA.read_text())
    known = list(columns(schema, schema))
    rows = [row(path, read(path), known) for path in paths]
    writer = csv.DictWriter(sys.stdout, rows[0].keys(), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)


main()
