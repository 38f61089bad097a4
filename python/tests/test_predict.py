"""`scripts/scaling predict` takes a problem and the report of its run, and nothing else."""

import json
import subprocess
import sys

import pytest
from conftest import ROOT

from contact_dd import programs


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """Problem and report of scenes: two with the same mesh, one in space."""
    folder = tmp_path_factory.mktemp("problems")
    for name in ("granite", "granite-friction", "stack3d"):
        problem, report = folder / f"{name}.h5", folder / f"{name}.json"
        subprocess.run([programs.find("contact-dd-partition"), "--example", name, "-o", problem, "-n", "8"], check=True,
                       capture_output=True)
        subprocess.run([programs.find("contact-dd-mpi"), problem, "--report", report, "--quiet"], check=True,
                       capture_output=True)
    return folder


def predict(*arguments):
    command = [sys.executable, ROOT / "scripts/performance/model.py", *arguments]
    return subprocess.run(command, capture_output=True, text=True)


def test_times_are_predicted(ran):
    ended = predict(ran / "granite.h5", ran / "granite.json", "--ranks", "2,4")
    assert ended.returncode == 0, ended.stderr
    assert "Tree: 8 leaves" in ended.stdout
    assert "\n| 4 |" in ended.stdout


def test_what_isnt_a_problem_and_its_report_is_said(ran, tmp_path):
    def refused(words, *arguments):
        ended = predict(*arguments)
        assert ended.returncode == 2, ended.stderr
        assert words in ended.stderr
        assert len(ended.stderr.splitlines()) == 1

    granite, report = ran / "granite.h5", ran / "granite.json"
    refused("isn't a problem file of contact-dd-partition; expected PROBLEM REPORT", report, granite)
    refused("isn't a problem file", ran / "granite.vtkhdf", report)
    refused("isn't a report of contact-dd-mpi; expected PROBLEM REPORT", granite, granite)
    refused("can't be read", granite, tmp_path / "nothing.json")
    # Of the same mesh, in as many subdomains, with as many conditions.
    refused("granite-friction.json: problem: granite-friction.h5; expected granite.h5", granite,
            ran / "granite-friction.json")
    refused("is a problem in space", ran / "stack3d.h5", ran / "stack3d.json")
    changed = json.loads(report.read_text())
    changed["contacts"][0]["name"] = "other"
    (tmp_path / "changed.json").write_text(json.dumps(changed))
    refused("contacts: other, right crack; expected left crack, right crack", granite, tmp_path / "changed.json")
    changed = {**json.loads(report.read_text()), "ranks": 2}
    (tmp_path / "changed.json").write_text(json.dumps(changed))
    refused("ranks: 2; expected 1, the report of a run of", granite, tmp_path / "changed.json")
