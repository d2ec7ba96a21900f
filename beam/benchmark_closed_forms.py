r"""Rods whose large deflection is known in closed form (R5): the elastica of a tip load, the helix of an end moment.

**Elastica.** Inextensible cantilever, load P across its end, :math:`\alpha = P L^2 / EI`, slope theta_0 of the end,

.. math:: p^2 = \tfrac12 (1 + \sin\theta_0), \quad \sin\varphi = \frac{1}{p\sqrt2}, \quad \sqrt\alpha = K(p) - F(\varphi, p), \quad
          \frac{w}{L} = 1 - \frac{2}{\sqrt\alpha} [E(p) - E(\varphi, p)], \quad \frac{x}{L} = \sqrt{\frac{2 \sin\theta_0}{\alpha}} .

**Helix.** A moment M of fixed direction a at the free end is the moment in every section; with EI = GJ the sections turn about a
evenly, :math:`R(s) = \exp(s \hat M / EI)`, and the rod lies on a helix about a,

.. math:: r(L) = L \Big[ a\, a_x + \frac{\sin\phi}{\phi} (e_x - a\, a_x) + \frac{1 - \cos\phi}{\phi}\, a \times e_x \Big],
          \qquad \phi = M L / EI .

Sources: K. E. Bisshopp, D. C. Drucker, Quart. Appl. Math. 3 (1945) 272-275, doi 10.1090/qam/13360; Love, Mathematical Theory of
Elasticity, chapter XIX.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from beam.rod import Rod
from beam.rod_model import RodModel, Support
from beam.shape import straight
from beam.statics import equilibrium
from homogenize.benchmark import Benchmark, Case, components
from homogenize.section_stiffness import SectionInertia, SectionStiffness

EI, STIFF = 1e2, 1e6
"""Bending stiffness [N m2]; EA and GA over EI / L^2, so that stretch and shear change the tip by 4e-6 of the length."""
HELIX = np.array([2.4, 0.0, 3.2])
"""phi a of the end moment: four radians about an axis 53 degrees off the rod."""


def cantilever_tip(load: NDArray[np.float64], elements: int) -> NDArray[np.float64]:
    """Tip (3,) of a rod of unit length, EI = GJ, along x, under EI times a nodal load (12,) on its free end."""
    EA = EI * STIFF
    section = SectionStiffness.uncoupled(EA=EA, GA_x=EA, GA_y=EA, EI_x=EI, EI_y=EI, GJ=EI, area=1.0)
    rod = Rod.straight(1.0, elements, section, SectionInertia(1.0, 1e-3, 1e-3, 2e-3))
    loads = np.zeros((rod.nodes, 12))
    loads[-1] = EI * load
    result = equilibrium(RodModel(rod, straight(rod.s), [Support(0)], load=loads))
    result.outcome.require_success()
    return result.q[-1, :3]


def elastica_tip(alpha: float) -> tuple[float, float]:
    """x / L and w / L of the tip under a load across the unbent rod.

    Examples
    --------
    >>> [round(x, 4) for x in elastica_tip(4.0)]
    [0.6711, 0.67]
    """

    def of(slope: float) -> tuple[float, float]:
        m = (1 + np.sin(slope)) / 2
        return m, float(np.arcsin(1 / np.sqrt(2 * m)))

    def excess(slope: float) -> float:
        m, phi = of(slope)
        return float(ellipk(m) - ellipkinc(phi, m) - np.sqrt(alpha))

    slope = float(np.asarray(brentq(excess, 1e-6, np.pi / 2 - 1e-9, xtol=1e-15)))
    m, phi = of(slope)
    across = 1 - 2 / np.sqrt(alpha) * (ellipe(m) - ellipeinc(phi, m))
    return float(np.sqrt(2 * np.sin(slope) / alpha)), float(across)


def helix_tip(turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """r(L) / L for the rotation vector `turn` (3,) = M L / EI of the end."""
    phi, e = float(np.linalg.norm(turn)), np.array([1.0, 0.0, 0.0])
    a = turn / phi
    along = a * a[0]
    return along + np.sin(phi) / phi * (e - along) + (1 - np.cos(phi)) / phi * np.cross(a, e)


def elastica(alpha: float) -> Iterable[Benchmark]:
    """Tip at n = 32."""
    load = np.zeros(12)
    load[1] = alpha
    found = cantilever_tip(load, 32)[:2]
    name, names = f"R5 elastica, P L2 / EI {alpha:g}", ("tip along / L", "tip across / L")
    yield from components(name, "elliptic integrals", names, elastica_tip(alpha), found, 5e-6, scale=1.0)


def helix() -> Iterable[Benchmark]:
    """Tip at n = 32, and the order of its error."""
    load = np.zeros(12)
    load[6:9] = HELIX
    exact, tips = helix_tip(HELIX), {n: cantilever_tip(load, n) for n in (16, 32)}
    name, names = "R5 straight rod into a helix", ("tip x / L", "tip y / L", "tip z / L")
    yield from components(name, "Kirchhoff", names, exact, tips[32], 5e-6, scale=1.0)
    coarse, fine = (float(np.linalg.norm(tips[n] - exact)) for n in (16, 32))
    yield Benchmark(
        name, "Kirchhoff", "order of the error, n 16 to 32", 3.5, float(np.log2(coarse / fine)), 0.0, "at least"
    )


def closed_form_cases() -> tuple[Case, ...]:
    """Elastica at two loads, helix."""
    return (
        *(Case(f"R5 elastica {a:g}", "elliptic integrals", partial(elastica, a)) for a in (1.0, 4.0)),
        Case("R5 helix", "Kirchhoff", helix),
    )
