"""The page of `helicable explain`: five sentences first, then seven panels; one file that needs no other and no network."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from compare.findings import Findings
from compare.findings_plot import plot_findings
from compare.findings_sentences import first_screen, listed, named, uncalibrated
from helicable.explain_panels import Panel, panels, sealed_sentence
from helicable.report import write_page
from helicable.rod_correction import correction_panel
from helicable.traffic_light import Light, verdict_light

if TYPE_CHECKING:
    from compare.output_space_mapping import RodCorrection

_PANEL_OF_SENTENCE = (3, 4, 4, 6, 7)


@dataclass(frozen=True)
class Line:
    """One sentence of the first screen, with the panel that says more."""

    name: str
    sentence: str
    panel: int
    light: Light


@dataclass(frozen=True)
class ExplainPage:
    """Everything that the template shows."""

    title: str
    verdict: str
    light: Light
    uncalibrated: str
    lines: tuple[Line, ...]
    panels: tuple[Panel, ...]
    notes: tuple[str, ...]
    sealed: str


def explain_page(
    findings: Findings, pictures: dict[str, Path], notes: Sequence[str] = (), more: Sequence[Panel] = ()
) -> ExplainPage:
    """The content of the page; `more` panels follow the seven."""
    made = panels(findings, pictures)
    lights = (made[2].light, made[3].light, _rivals_light(findings), made[5].light, made[6].light)
    lines = tuple(
        Line(name, sentence, panel, light)
        for (name, sentence), panel, light in zip(first_screen(findings), _PANEL_OF_SENTENCE, lights, strict=True)
    )
    effects = listed(named(findings), "or" if findings.verdict == "confusable" else "and")
    return ExplainPage(
        title=findings.comparison.campaign.title or "Campaign",
        verdict=f"{findings.verdict}: {effects}" if effects else findings.verdict,
        light=verdict_light(findings),
        uncalibrated=uncalibrated(findings),
        lines=lines,
        panels=(*made, *more),
        notes=tuple(dict.fromkeys((*notes, *findings.notes))),
        sealed=sealed_sentence(findings),
    )


def write_report(
    findings: Findings, folder: Path, notes: Sequence[str] = (), correction: RodCorrection | None = None
) -> Path:
    """Write ``report.html`` and the pictures that it shows (which it also carries inside).

    Raises
    ------
    InputError
        If the folder cannot be written to.
    """
    pictures = plot_findings(findings, folder)
    more = () if correction is None else (correction_panel(correction, folder),)
    return write_page("explain.html", folder / "report.html", page=explain_page(findings, pictures, notes, more))


def _rivals_light(findings: Findings) -> Light:
    if findings.verdict == "confusable":
        return Light("mind", "rivals are tied")
    return Light("mind", "some not testable") if findings.untestable else Light("good", "all could be tested")
