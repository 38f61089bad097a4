"""The man page of a command and its completions for shells, from its parser."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path

KINDS = ("man", "complete-bash", "complete-zsh", "complete-fish")


def version() -> str:
    """The package's version; where it isn't installed that of the repository."""
    try:
        return metadata.version("contact-dd")
    except metadata.PackageNotFoundError:
        found = re.search(r'(?m)^version = "([^"]+)"', Path(__file__).parents[2].joinpath("Cargo.toml").read_text())
        return found[1] if found else ""


class Generate(argparse.Action):
    """Prints the man page or completions, and ends."""

    def __call__(self, parser: argparse.ArgumentParser, _namespace: object, kind: object, _: object = None) -> None:
        write = {"man": man, "complete-bash": bash, "complete-zsh": zsh, "complete-fish": fish}[str(kind)]
        print(write(parser), end="")
        parser.exit()


def commands_of(parser: argparse.ArgumentParser) -> Iterator[tuple[str, str, argparse.ArgumentParser]]:
    """Name, summary and parser of each command."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for printed in action._choices_actions:
                yield printed.dest, printed.help or "", action.choices[printed.dest]


def options_of(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    return [action for action in parser._actions if action.option_strings]


def help_of(action: argparse.Action) -> str:
    return (action.help or "").replace("%%", "%")


def man(parser: argparse.ArgumentParser) -> str:
    def plain(text: str) -> str:
        # Lines that begin with a dot or a quote would be requests.
        return re.sub(r"(?m)^([.'])", r"\\&\1", text.replace("\\", r"\e").replace("-", r"\-"))

    def listed(actions: list[argparse.Action]) -> Iterator[str]:
        for action in actions:
            names = ", ".join(action.option_strings) or str(action.metavar or action.dest)
            value = f" {action.metavar or action.dest.upper()}" if action.option_strings and action.nargs != 0 else ""
            yield f".TP\n\\fB{plain(names)}\\fR{plain(value)}\n{plain(help_of(action))}"

    name = parser.prog
    lines = [
        f'.TH {plain(name)} 1 "" "{plain(name)} {version()}" "User Commands"',
        f".SH NAME\n{plain(name)} \\- {plain(parser.description or '')}", ".SH SYNOPSIS",
    ]
    for number, (_, _, of) in enumerate(commands_of(parser)):
        usage = " ".join(of.format_usage().removeprefix("usage: ").split())
        lines.append(".br\n" * (number > 0) + plain(usage))
    lines += [".SH OPTIONS", *listed(options_of(parser))]
    for command, _, of in commands_of(parser):
        lines += [f".SH {plain(command.upper())}\n{plain(of.description or '')}", *listed(of._actions)]
    return "\n".join(lines) + "\n"


def words_of(parser: argparse.ArgumentParser) -> str:
    return " ".join(name for action in options_of(parser) for name in action.option_strings)


def bash(parser: argparse.ArgumentParser) -> str:
    commands = list(commands_of(parser))
    cases = "".join(f"        {name}) words='{words_of(of)}' ;;\n" for name, _, of in commands)
    return f"""_contact_dd() {{
    local words
    COMPREPLY=()
    case ${{COMP_WORDS[1]}} in
{cases}        *) words='{" ".join(name for name, _, _ in commands)} {words_of(parser)}' ;;
    esac
    # Words without a dash at their beginning are files, which the shell completes.
    if [[ $COMP_CWORD -eq 1 || ${{COMP_WORDS[COMP_CWORD]}} == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "${{COMP_WORDS[COMP_CWORD]}}")
    fi
}}
complete -o default -F _contact_dd {parser.prog}
"""


def zsh(parser: argparse.ArgumentParser) -> str:
    def printed(text: str) -> str:
        return re.sub(r"([\[\]:])", r"\\\1", text.replace("'", "'\\''"))

    def arguments(of: argparse.ArgumentParser) -> str:
        found = [
            f"'{name}[{printed(help_of(action))}]{'' if action.nargs == 0 else ':value:_files'}'"
            for action in options_of(of) for name in action.option_strings
        ]
        return " ".join([*found, "'*:file:_files'"])

    commands = list(commands_of(parser))
    names = " ".join(f"'{name}:{printed(text)}'" for name, text, _ in commands)
    cases = "".join(f"        {name}) _arguments {arguments(of)} ;;\n" for name, _, of in commands)
    return f"""#compdef {parser.prog}
_contact_dd() {{
    if ((CURRENT == 2)); then
        local -a commands=({names})
        _describe command commands
        _values option {" ".join(words_of(parser).split())}
        return
    fi
    local command=$words[2]
    shift words
    ((CURRENT--))
    case $command in
{cases}    esac
}}
_contact_dd "$@"
"""


def fish(parser: argparse.ArgumentParser) -> str:
    def printed(text: str) -> str:
        return text.replace("\\", "\\\\").replace("'", "\\'")

    def listed(of: argparse.ArgumentParser, where: str) -> Iterator[str]:
        for action in options_of(of):
            for name in action.option_strings:
                letter = f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}"
                value = "" if action.nargs == 0 else " -r"
                yield f"complete -c {parser.prog} -n '{where}' {letter}{value} -d '{printed(help_of(action))}'"

    lines = list(listed(parser, "__fish_use_subcommand"))
    for name, text, of in commands_of(parser):
        lines.append(f"complete -c {parser.prog} -n '__fish_use_subcommand' -a {name} -d '{printed(text)}'")
        lines += listed(of, f"__fish_seen_subcommand_from {name}")
    return "\n".join(lines) + "\n"
