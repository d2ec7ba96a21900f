"""The families of errors that helicable raises.

Every message is a sentence with four parts: what is wrong, where, by how much, and what to try.
The command line turns an :class:`InputError` into exit code 2 and a :class:`ConvergenceError` into exit code 1.
"""

from __future__ import annotations


class InputError(ValueError):
    """Something that the user supplied cannot be used as it is."""


class SpecError(InputError):
    """A cable, scenario or campaign file says something that cannot be understood or cannot be true."""


class GeometryError(InputError):
    """Parts overlap, do not fit, or a layer has no solution."""


class MeshError(InputError):
    """A mesh cannot be made as asked, or a mesh that was handed in is not usable."""


class ConvergenceError(RuntimeError):
    """A computation ran but did not reach its result; the message names the part, step or node and how far it came."""
