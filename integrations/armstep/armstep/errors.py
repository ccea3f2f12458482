"""Errors: one line each that says what is wrong and what would be right."""


class ArmstepError(Exception):
    """Any error of this package."""


class InputError(ArmstepError, ValueError):
    """An argument has a wrong type, shape or value; nothing is changed."""


class TablesError(ArmstepError, ValueError):
    """Tables, or a saved arm, cannot be read, are damaged, or belong to others."""


class LibraryError(ArmstepError, ImportError):
    """The library in C is missing, or is none for this machine."""
