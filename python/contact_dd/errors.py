"""Errors, by the exit codes of the programs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contact_dd.result import Result


class ContactError(Exception):
    """A program ended with an error; its message is the exception's."""

    exit_code = 1


class InputError(ContactError):
    """The model, the mesh or a file isn't as expected; the message says where and what was expected."""

    exit_code = 2


class NotConverged(ContactError):
    """The iteration ended without converging. `result` has the last iterate."""

    exit_code = 3
    result: Result


class IllPosed(ContactError):
    """A body is free to move under its load; the message names body and motion."""

    exit_code = 4


class OutputError(ContactError):
    """A file can't be written."""

    exit_code = 5


class Stopped(ContactError):
    """The run was stopped by a signal."""

    exit_code = 6


def by_exit_code(code: int, message: str) -> ContactError:
    """The error of a program that ended with `code`."""
    for kind in (InputError, NotConverged, IllPosed, OutputError, Stopped):
        if kind.exit_code == code:
            return kind(message)
    return ContactError(message or f"ended with exit code {code}")
