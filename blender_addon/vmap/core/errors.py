# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors whose one-line text is meant for the user."""


class AddonError(Exception):
    """Something the user can act on; the text is one line."""


class FileProblem(AddonError):
    """A file that cannot be used: its name, what was found and what was expected."""

    def __init__(self, path, found, expected):
        super().__init__(f"{printable(path)}: {found}; expected {expected}")


def printable(text, limit=300):
    """The text on one line without control characters, shortened in the middle when it is very long."""
    clean = "".join(c if c.isprintable() else "?" for c in str(text))
    if len(clean) <= limit:
        return clean
    half = (limit - 3) // 2
    return f"{clean[:half]}...{clean[-half:]}"
