"""An effect of your own in about ten lines: a numpy function of the path becomes an :class:`~effects.effect.Effect`.

>>> import numpy as np
>>> from effects import Parameter, of_strain, section_effect
>>> @section_effect(
...     "locking",
...     shape=[Parameter("onset", "strain", "strain at which the armour locks", starts=of_strain(0.1, 0.9, 8))],
...     strength=[Parameter("gain", "1", "stiffness gained beyond the onset over the linear one")],
... )
... def locking(path, onset):
...     "the armour locks at large strain"
...     return np.sign(path.strain) * np.maximum(np.abs(path.strain) - onset, 0.0)
>>> locking.title, locking.forms[0].stage
('the armour locks at large strain', 'section')

``register(locking)`` then puts it into the library. Rigs and sensors are written out as :class:`Effect` by hand.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from effects.effect import UNKNOWN, Advance, Array, BenchPath, Effect, EffectKind, Form, Parameter

Law = Callable[..., Array]
STRENGTH = Parameter(
    "strength", "1", "load that it adds over the linear stiffness, per unit of its column", low=-np.inf,
    plausible=(-np.inf, np.inf),
)  # fmt: skip


def section_effect(
    name: str,
    *,
    shape: Sequence[Parameter] = (),
    strength: Sequence[Parameter] = (STRENGTH,),
    memoryless: bool = True,
    kinds: Sequence[str] = ("tension", "torsion", "bending", "shear"),
    kind: EffectKind = "physics",
    title: str = "",
    equation: str = "",
    source: str = "own effect",
    needs: str = "nothing special",
    signature: str = "not described",
    why_untestable: Callable[[Sequence[BenchPath]], str | None] = lambda _paths: None,
) -> Callable[[Law], Effect]:
    """Make an effect of a function that says which strain the section seems to have on top of the true one.

    Parameters
    ----------
    name : str
        A new name in small letters, words joined by ``-``.
    shape : sequence of Parameter
        Nonlinear parameters, each with `starts`; the function takes them after the path.
    strength : sequence of Parameter
        One per column that the function returns; without it one of either sign.
    memoryless : bool
        Whether every sample depends only on the strain, tension and temperature of the moment. The law can then run in
        a rod as well, whose points of one instant are handed to it as one path without time (strain, tension and
        temperature of shape (n,)). Registering tries whether it is true. A law with a memory acts on the bench only.
    kinds : sequence of str
        Kinds of experiment in which it can act.
    kind, title, equation, source, needs, signature, why_untestable
        As in :class:`~effects.effect.Effect`; the first line of the function's docstring is the title otherwise.

    Returns
    -------
    decorator
        It turns ``law(path, *shape) -> (n,) or (n, k) array [strain]`` into an :class:`~effects.effect.Effect`.
    """

    def make(law: Law) -> Effect:
        def respond(path: BenchPath, *values: float) -> Array:
            return _columns(law(path, *values))

        form = Form(name, "section", respond, tuple(shape), tuple(strength), _stepping(respond) if memoryless else None)
        told = (inspect.getdoc(law) or "").strip().splitlines()
        arguments = ", ".join(("strain", *(p.name for p in shape)))
        return Effect(
            name=name,
            kind=kind,
            title=title or (told[0].rstrip(".") if told else name),
            equation=equation or f"load = K (strain + strength {law.__name__}({arguments}))",
            source=source,
            needs=needs,
            signature=signature,
            kinds=tuple(kinds),
            forms=(form,),
            why_untestable=why_untestable,
        )

    return make


def _columns(given: Array) -> Array:
    columns = np.asarray(given, dtype=float)
    return columns[:, None] if columns.ndim == 1 else columns


def _stepping(respond: Law) -> Advance:
    """The step of a law without memory: the law at the end of the step."""

    def advance(
        strain: Array,
        before: Array,
        dt: float,
        tension: Array,
        temperature: Array,
        state: Array,
        *shape: float,
        reference: BenchPath = UNKNOWN,
    ) -> tuple[Array, Array]:
        now = replace(reference, strain=strain, time=None, tension=tension, temperature=temperature)
        return respond(now, *shape), state

    return advance
