"""The section for other beam programs: order, axes, sign and units of each, and what each one drops.

Here: z along the cable, x and y across it, right-handed; (T_x, T_y, N, M_x, M_y, M_z) = C (gamma_x, gamma_y, epsilon, kappa_x,
kappa_y, tau). Cyclic
renaming of the axes and reordering is all that the full formats need: no sign changes.

| format | axes | order | source |
|---|---|---|---|
| vabs | x1 = z, x2 = x, x3 = y | stretch, shear 2, shear 3, twist, bending 2, bending 3 | Hodges, Nonlinear Composite Beam Theory |
| beamdyn | x, y, z as here, z the tangent | shear x, shear y, stretch, bending x, bending y, twist | BeamDyn user guide, blade input file |
| exudyn | x = z, y = x, z = y | N, V_y, V_z, M_x, M_y, M_z with x axial | Exudyn, BeamSection and ObjectBeamGeometricallyExact |
| moordyn | none | EA, EI, mass, diameter | MoorDyn v2, LINE TYPES |
| orcaflex | none | EA, EI, GJ, tension-torque coupling, mass, diameter; kN, t | OrcaFlex help, line types |

The full formats carry every coupling of C. Line types drop the shear stiffness and the couplings of shear with bending: a shear force that
bends a one-handed cable out of its plane (F14) has no place there; MoorDyn drops torsion too. Where an end condition decides
(EA), both values are written.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.errors import InputError, SpecError
from homogenize.section_stiffness import SectionInertia, SectionStiffness

FloatArray = NDArray[np.float64]

FORMATS = ("vabs", "beamdyn", "exudyn", "moordyn", "orcaflex")

ENDINGS = {".k": "vabs", ".dat": "beamdyn", ".json": "exudyn", ".txt": "moordyn", ".csv": "orcaflex"}

AXIAL_FIRST = (2, 0, 1, 5, 3, 4)
"""Where the entries of the axial-first order (vabs, exudyn) stand in the order used here."""

ORDERS: dict[str, tuple[int, ...]] = {"vabs": AXIAL_FIRST, "exudyn": AXIAL_FIRST, "beamdyn": (0, 1, 2, 3, 4, 5)}


@dataclass(frozen=True)
class ExportedSection:
    """What an export needs: the section averaged over the pitch, its inertia, its outer diameter [m], and a name without blanks."""

    name: str
    section: SectionStiffness
    inertia: SectionInertia
    diameter: float


def permuted(C: FloatArray, order: tuple[int, ...]) -> FloatArray:
    """Rows and columns of C in another order.

    Examples
    --------
    >>> np.diag(permuted(np.diag([1.0, 2, 3, 4, 5, 6]), AXIAL_FIRST)).tolist()
    [3.0, 1.0, 2.0, 6.0, 4.0, 5.0]
    """
    return np.asarray(C)[np.ix_(order, order)]


def restored(K: FloatArray, order: tuple[int, ...]) -> FloatArray:
    """The inverse of :func:`permuted`: rows and columns back in the order used here."""
    back = tuple(int(i) for i in np.argsort(order))
    return permuted(K, back)


def export_format(path: str | Path, format: str | None = None) -> str:
    """The format that is meant, by name or by the ending of the file.

    Raises
    ------
    SpecError
        If neither says which one.
    """
    if format is None:
        format = ENDINGS.get(Path(path).suffix.lower())
        if format is None:
            endings = ", ".join(f"{e} {f}" for e, f in ENDINGS.items())
            raise SpecError(f'the ending of "{path}" names no format ({endings}); say --format {"|".join(FORMATS)}.')
    if format not in FORMATS:
        raise SpecError(f'--format "{format}" is not known; choose {", ".join(FORMATS[:-1])} or {FORMATS[-1]}.')
    return format


def export_text(exported: ExportedSection, format: str) -> str:
    """The text of the file in one of :data:`FORMATS`; see the module docstring.

    Raises
    ------
    SpecError
        If the format is not known.
    """
    writers = {"vabs": _vabs, "beamdyn": _beamdyn, "exudyn": _exudyn, "moordyn": _moordyn, "orcaflex": _orcaflex}
    return writers[export_format("", format)](exported)


def export_section(exported: ExportedSection, path: str | Path, format: str | None = None) -> Path:
    """Write the section for another program.

    Parameters
    ----------
    exported : ExportedSection
    path : file to write
    format : one of :data:`FORMATS`; by the ending of the file if not given

    Raises
    ------
    SpecError
        If the format is not known.
    InputError
        If the file cannot be written.
    """
    text = export_text(exported, export_format(path, format))
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror or error}; choose another place.") from None
    return path


def dropped(format: str) -> str:
    """What the format has no place for, as a sentence."""
    return {
        "vabs": "Nothing of the 6x6 is lost; mass and diameter are not part of this matrix.",
        "exudyn": "Nothing of the 6x6 is lost; damping is not known here and left at zero.",
        "beamdyn": "Nothing of the 6x6 is lost; the damping coefficients mu are zero and yours to set.",
        "moordyn": "Lost: torsion and the torque of a pulled cable, shear stiffness, and the bending that a shear force causes (F14).",
        "orcaflex": "Lost: shear stiffness, and the bending that a shear force causes (F14).",
    }[export_format("", format)]


def mass_matrix(inertia: SectionInertia) -> FloatArray:
    """6x6 mass per length in the order used here (velocities x, y, z, turns x, y, z), mass centre on the axis [kg/m, kg m]."""
    m = inertia.mass_per_length
    return np.diag([m, m, m, inertia.J_x, inertia.J_y, inertia.J_z])


def _rows(matrix: FloatArray) -> str:
    return "\n".join("  ".join(f"{value: .16e}" for value in row) for row in matrix)


def _vabs(exported: ExportedSection) -> str:
    K = permuted(exported.section.C, ORDERS["vabs"])
    return f"""! {exported.name}: Timoshenko stiffness matrix, order 1 stretch, 2 shear x2, 3 shear x3, 4 twist, 5 bending x2, 6 bending x3
! axes: x1 along the cable (z), x2 = x, x3 = y; N, N m, N m^2; averaged over the pitch; {dropped("vabs")}

 Timoshenko Stiffness Matrix (1-extension; 2,3-shear, 4-twist; 5,6-bending)
 ========================================================
{_rows(K)}

 Timoshenko Flexibility Matrix (1-extension; 2,3-shear, 4-twist; 5,6-bending)
 ========================================================
{_rows(permuted(exported.section.compliance, ORDERS["vabs"]))}
"""


def _beamdyn(exported: ExportedSection) -> str:
    K, M = permuted(exported.section.C, ORDERS["beamdyn"]), mass_matrix(exported.inertia)
    station = "\n".join([_rows(K), "", _rows(M), ""])
    return f"""------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------
{exported.name}: shear x, shear y, stretch, bending x, bending y, twist; z along the tangent; averaged over the pitch. {dropped("beamdyn")}
---------------------- BLADE PARAMETERS --------------------------------------
2    station_total    - Number of blade input stations (-)
0    damp_type        - Damping type: 0: no damping; 1: damped
---------------------- DAMPING COEFFICIENT------------------------------------
   mu1        mu2        mu3        mu4        mu5        mu6
   (-)        (-)        (-)        (-)        (-)        (-)
0.0 0.0 0.0 0.0 0.0 0.0
---------------------- DISTRIBUTED PROPERTIES---------------------------------
  0.000000
{station}
  1.000000
{station}"""


def _exudyn(exported: ExportedSection) -> str:
    inertia = exported.inertia
    record = {
        "name": exported.name,
        "for": "exudyn.BeamSection() of ObjectBeamGeometricallyExact: set each key as the attribute of the same name",
        "axes": "x along the cable (z here), y = x, z = y; averaged over the pitch",
        "order": ["N", "V_y", "V_z", "M_x", "M_y", "M_z"],
        "units": "N, N m, N m^2; kg/m; kg m",
        "dropped": dropped("exudyn"),
        "stiffnessMatrix": permuted(exported.section.C, ORDERS["exudyn"]).tolist(),
        "massPerLength": inertia.mass_per_length,
        "inertia": np.diag([inertia.J_z, inertia.J_x, inertia.J_y]).tolist(),
        "dampingMatrix": np.zeros((6, 6)).tolist(),
    }
    return json.dumps(record, indent=1) + "\n"


def _moordyn(exported: ExportedSection) -> str:
    s = exported.section
    EI = 0.5 * (s.EI_x + s.EI_y)
    lines = [
        f"{exported.name}_{ends} {exported.diameter:.10g} {exported.inertia.mass_per_length:.10g} {EA:.10g} -0.8 {EI:.10g} "
        "1.2 1.0 0.0 0.0"
        for ends, EA in (("blocked", s.EA_blocked_twist), ("free", s.EA_free_twist))
    ]
    return f"""{exported.name}: line types by helicable. Choose _blocked for ends that cannot turn, _free for ends that turn without torque.
{dropped("moordyn")} EI: constant moment, averaged over the pitch. BA and Cd, Ca, CdAx, CaAx are placeholders: set them for your case.
---------------------- LINE TYPES -----------------------------------
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
{chr(10).join(lines)}
"""


def _orcaflex(exported: ExportedSection) -> str:
    s = exported.section
    rows = [
        ("Outer diameter", "m", exported.diameter, "outer circle"),
        ("Inner diameter", "m", 0.0, ""),
        ("Mass per unit length", "t/m", exported.inertia.mass_per_length / 1e3, ""),
        ("Bending stiffness x", "kN.m2", s.EI_x / 1e3, "constant moment, averaged over the pitch"),
        ("Bending stiffness y", "kN.m2", s.EI_y / 1e3, "constant moment, averaged over the pitch"),
        ("Axial stiffness", "kN", s.EA_blocked_twist / 1e3, "twist blocked: with torsion included and the coupling below"),
        ("Axial stiffness without torsion", "kN", s.EA_free_twist / 1e3, "ends free to twist: instead of it, if torsion is not included"),
        ("Torsional stiffness", "kN.m2", s.GJ / 1e3, "stretch blocked"),
        ("Tension/torque coupling", "kN.m", s.coupling / 1e3, "torque per unit stretch; positive: right-handed about the tangent"),
    ]  # fmt: skip
    body = "\n".join(f'"{name}","{unit}",{value:.10g},"{note}"' for name, unit, value, note in rows)
    return f'"{exported.name}","","","line type; {dropped("orcaflex")}"\n"data","unit","value","note"\n{body}\n'
