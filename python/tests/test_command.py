"""The command `contact-dd`: its version, its man page, its completions, and what it refuses."""

import re
import subprocess
import sys

import pytest
from conftest import ROOT

from contact_dd import Model
from contact_dd.command import parser
from contact_dd.manual import commands_of, options_of


def run(*arguments):
    return subprocess.run([sys.executable, "-m", "contact_dd", *arguments], capture_output=True, text=True)


def test_the_version_is_that_of_the_programs():
    expected = re.search(r'(?m)^version = "([^"]+)"', (ROOT / "Cargo.toml").read_text())[1]
    for option in ("--version", "-V"):
        ended = run(option)
        assert (ended.returncode, ended.stdout) == (0, f"contact-dd {expected}\n")


def commands_and_options():
    for name, _, of in commands_of(parser()):
        yield name, [option for action in options_of(of) for option in action.option_strings]


def test_the_man_page_has_every_option():
    text = run("--generate", "man").stdout
    assert text.startswith(".TH contact\\-dd 1 ")
    for name, options in commands_and_options():
        section = text.split(f"\n.SH {name.upper()}\n")[1].split("\n.SH ")[0]
        for option in options:
            assert option.replace("-", "\\-") in section, (name, option)
    assert "%%" not in text


@pytest.mark.parametrize("kind", ["complete-bash", "complete-zsh", "complete-fish"])
def test_completions_have_every_option(kind):
    text = run("--generate", kind).stdout
    for name, options in commands_and_options():
        assert name in text
        for option in options:
            in_fish = f"-l {option[2:]}" if option.startswith("--") else f"-s {option[1:]}"
            assert (in_fish if kind == "complete-fish" else option) in text


def test_bash_completes(tmp_path):
    (tmp_path / "completions").write_text(run("--generate", "complete-bash").stdout)

    def completed(*words):
        script = f"""source {tmp_path}/completions
            COMP_WORDS=(contact-dd {" ".join(f"'{word}'" for word in words)}); COMP_CWORD={len(words)}; _contact_dd
            printf '%s\\n' "${{COMPREPLY[@]}}" """
        ended = subprocess.run(["bash", "-euc", script], capture_output=True, text=True, check=True)
        return ended.stdout.split()

    assert completed("re") == ["report"]
    assert {"plot", "report", "table", "compare", "adapt", "--version"} <= set(completed(""))
    assert completed("plot", "result.vtkhdf", "--s") == ["--scale", "--step"]
    assert completed("plot", "res") == []


def test_one_result_is_too_few_to_compare(scene, tmp_path):
    path = Model.from_scene(scene("hertz")).run(folder=tmp_path, progress=False).path
    ended = run("compare", path)
    assert ended.returncode == 2
    assert ended.stderr == (
        f"error: the result {path} alone; expected two or three results of one scene, on meshes that differ in size\n"
    )
