"""Fixtures of the tests: built-in scenes, and the numbers of their pages."""

import re
import subprocess
from pathlib import Path

import pytest

from contact_dd import programs

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def scene(tmp_path_factory):
    """Writes a built-in scene and its mesh, and returns the path of the scene."""

    def write(name, *options):
        folder = tmp_path_factory.mktemp(name)
        command = [programs.find("contact-dd-partition"), "--example", name, "--write-scene", folder, *options]
        subprocess.run(command, check=True, capture_output=True)
        return folder / "scene.toml"

    return write


def numbers_of(page):
    """The table of a page of the gallery: values, and their paths in the report."""
    text = (ROOT / "partition/src/example" / page / "README.md").read_text()
    for found, where in re.findall(r"^\| [^|]+ \| ([^|]+) \|[^|]*\|[^|]*\| `([^`]+)` \|$", text, re.MULTILINE):
        if not where.startswith(("PointData", "CellData")):
            yield found.replace("−", "-").replace(" ", ""), where


def in_report(report, where):
    """The value of a report at a path; entries of lists by their names or numbers."""
    for name in re.split(r"/(?![^\[]*\])", where):
        if isinstance(report, dict):
            report = report[name]
        elif name.isdigit():
            report = report[int(name)]
        else:
            report = next(entry for entry in report if name in (entry.get("name"), entry.get("support")))
    return report


def agrees_with_the_gallery(result, page):
    """Whether a result has the numbers of a page, to within one in their last digit."""
    numbers = list(numbers_of(page))
    assert len(numbers) >= 3, page
    for found, where in numbers:
        digits, _, exponent = found.partition("e")
        unit = 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))
        assert abs(in_report(result.report, where) - float(found)) <= 1.001 * unit, (where, found)
