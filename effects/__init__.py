"""The library of effects that a linear cable model leaves out: physics, rig and sensor, one file each.

>>> from effects import find
>>> find("sensor-lag").equation
'tau dy/dt + y = x, y(0) = x(0)'
"""

from effects.effect import (
    ActiveEffect,
    BenchPath,
    Effect,
    Form,
    Parameter,
    of_length,
    of_play,
    of_strain,
    of_time,
    of_values,
)
from effects.library import find, library, library_notes, register, unregister
from effects.own_effect import section_effect
from effects.signature_plot import plot_signature

__all__ = [
    "ActiveEffect",
    "BenchPath",
    "Effect",
    "Form",
    "Parameter",
    "find",
    "library",
    "library_notes",
    "of_length",
    "of_play",
    "of_strain",
    "of_time",
    "of_values",
    "plot_signature",
    "register",
    "section_effect",
    "unregister",
]
