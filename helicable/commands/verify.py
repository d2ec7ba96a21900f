"""`helicable verify`: theory and other codes beside what this installation computes."""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Annotated, Any

import typer

from geometry.errors import SpecError
from helicable.options import JsonOption
from helicable.screen import plain, progress, say, write_json
from homogenize.benchmark import Benchmark, Case, Progress, run_cases

PARTS = ("section", "rod")


def verify(
    only: Annotated[
        str | None, typer.Option("--only", metavar="section|rod", help="One part; both without it.")
    ] = None,
    match: Annotated[
        str | None, typer.Option("--match", metavar="TEXT", help="Benchmarks whose name contains the text.")
    ] = None,
    json: JsonOption = None,
) -> None:
    """Run the benchmarks of section and rod and print expected and computed numbers side by side.

    Exit code 1 if any of them fails.

    Example: `helicable verify --only section --json verify.json`
    """
    start = time.perf_counter()
    chosen = chosen_cases(only, match)
    found: dict[str, list[Benchmark]] = {}
    with progress("verification") as tell:
        done, total = 0, sum(len(cases) for cases in chosen.values())
        for part, cases in chosen.items():
            found[part] = run_cases(cases, _share(tell, done / total, len(cases) / total))
            done += len(cases)
    for part, benchmarks in found.items():
        show_benchmarks(part, benchmarks)
    write_json(json, verification_record(found, time.perf_counter() - start))
    failed = [b for benchmarks in found.values() for b in benchmarks if not b.passed]
    for benchmark in failed:
        say(plain(f"FAILS {benchmark.sentence()}"))
    count = sum(len(benchmarks) for benchmarks in found.values())
    say(f"{count - len(failed)} of {count} benchmarks pass, {time.perf_counter() - start:.0f} s")
    if failed:
        raise typer.Exit(1)


def chosen_cases(only: str | None, match: str | None) -> dict[str, Sequence[Case]]:
    """The cases by part.

    Raises
    ------
    SpecError
        If the part is not known or nothing matches.
    """
    if only is not None and only not in PARTS:
        raise SpecError(f'--only "{only}" is not known; choose {" or ".join(PARTS)}.')
    chosen = {part: _cases(part) for part in PARTS if only in (None, part)}
    if match is not None:
        chosen = {part: [c for c in cases if match.lower() in c.name.lower()] for part, cases in chosen.items()}
        if not any(chosen.values()):
            raise SpecError(f'no benchmark has "{match}" in its name; `helicable verify` without --match lists them.')
    return {part: cases for part, cases in chosen.items() if cases}


def _cases(part: str) -> Sequence[Case]:
    if part == "section":
        from homogenize.verification import section_cases

        return section_cases()
    from beam.verification import rod_cases

    return rod_cases()


def _share(tell: Progress, start: float, width: float) -> Progress:
    return lambda fraction, sentence: tell(start + width * fraction, sentence)


def expected_text(b: Benchmark) -> str:
    """The expected number, range or bound."""
    if b.kind == "band":
        half = b.tolerance * abs(b.expected)
        return f"{b.expected - half:.6g} .. {b.expected + half:.6g}"
    return {"at least": ">= ", "at most": "<= "}.get(b.kind, "") + f"{b.expected:.7g}"


LINE = "{:4}  {:<44} {:>24} {:>14} {:>9} {:>9}"


def show_benchmarks(part: str, benchmarks: Sequence[Benchmark]) -> None:
    """Print the numbers of one part, each benchmark under its name and source."""
    heads = ("", "quantity", "expected", "computed", "error", "allowed")
    say({"section": "[bold]Section and cell[/bold]", "rod": "[bold]Rod[/bold]"}[part])
    say(f"[bold]{LINE.format(*heads)}[/bold]")
    last = ""
    for b in benchmarks:
        head = f"{b.name} ({b.source})"
        if head != last:
            say(plain(head))
        last = head
        bounded = b.kind != "equal"
        error = "" if bounded and b.passed else f"{b.error:.1e}"
        allowed = "" if bounded else f"{b.tolerance:.1e}"
        mark = "pass" if b.passed else "FAIL"
        say(plain(LINE.format(mark, b.quantity, expected_text(b), f"{b.computed:.7g}", error, allowed)))
    say("")


def verification_record(found: dict[str, list[Benchmark]], seconds: float) -> dict[str, Any]:
    """The JSON of `helicable verify`."""
    rows = [
        {
            "name": b.name,
            "part": part,
            "source": b.source,
            "quantity": b.quantity,
            "kind": b.kind,
            "expected": b.expected,
            "computed": b.computed,
            "relative_error": b.error,
            "scale": b.scale or abs(b.expected),
            "tolerance": b.tolerance,
            "passed": b.passed,
            "note": b.note,
        }
        for part, benchmarks in found.items()
        for b in benchmarks
    ]
    passed = sum(row["passed"] for row in rows)
    return {
        "schema": 1,
        "benchmarks": rows,
        "passed": passed,
        "failed": len(rows) - passed,
        "seconds": seconds,
        "notes": [
            "relative_error is |computed - expected| / scale; for bounds and bands the distance to what is allowed"
        ],
    }
