"""`python -m benchmarks.blind_towing`: hidden-effect towing campaigns, `compare.explain` on them, table and confusion matrix.

python -m benchmarks.blind_towing --campaigns 44 --first 1000 --minutes 60      run and print the table
python -m benchmarks.blind_towing --log LOG --campaigns 0 --out benchmarks/blind_towing.md --picture P    table of a log
python -m benchmarks.blind_towing --make SEED FOLDER                            write one campaign
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from benchmarks.blind_towing.confusion_plot import draw_confusion
from benchmarks.blind_towing.generator import Case, make
from benchmarks.blind_towing.score import Row, read_log, run, table

HEAD = """# Blind towing campaigns

Hidden-effect towing campaigns made by a simulator that shares no code with the model that explains
([benchmarks/blind_towing](blind_towing)), and what `explain` says of them. Line, trough, noise, effect and its form are drawn from the
seed; many of the forms are richer than those of the library. The label stays outside the folder. *share*: part of the tension that no
friction coefficient absorbs; *D*: its distance from the best base model in units of the noise; errors in noise floors. *apart*: distance of
the nearest rival, every other effect fitted to what the truth makes with its strength and the friction coefficient; rivals closer than 5
are twins, and a set of truth and twins is then right ([rivals.py](blind_towing/rivals.py)).

    .venv/bin/python -m benchmarks.blind_towing --first {first} --campaigns {count} --out benchmarks/blind_towing.md

![Confusion matrix]({picture})

"""

BELOW = "## Beside the score"


def page(rows: Sequence[Row], out: Path, picture: Path) -> str:
    """Head, picture and table; what else was written by hand below them in an earlier `out` stays."""
    head = HEAD.format(first=min(r["seed"] for r in rows), count=len(rows), picture=picture.as_posix())
    old = out.read_text(encoding="utf-8") if out.is_file() else ""
    below = old[old.index(BELOW) :] if BELOW in old else ""
    return "\n".join([head + table(rows), below]).rstrip() + "\n"


def main(argv: list[str]) -> int:
    """Run, and write what is asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.blind_towing")
    parser.add_argument(
        "--campaigns",
        type=int,
        default=44,
        help="how many; every 11 have 6 single effects, 3 nulls, a pair, an outsider",
    )
    parser.add_argument("--first", type=int, default=1000, help="first seed; seeds below 1000 are for tuning")
    parser.add_argument(
        "--minutes", type=float, default=1e9, help="begin no campaign after so many minutes of CPU time"
    )
    parser.add_argument("--log", type=Path, default=Path("out/blind-towing.jsonl"))
    parser.add_argument("--out", type=Path, help="write the table to this Markdown file")
    parser.add_argument("--picture", type=Path, default=Path("docs/pictures/blind-towing-confusion.png"))
    parser.add_argument("--make", nargs=2, metavar=("SEED", "FOLDER"), help="write one campaign and stop")
    asked = parser.parse_args(argv)
    if asked.make:
        print(make(Case(int(asked.make[0])), asked.make[1]))
        return 0
    cases = [Case(asked.first + n) for n in range(asked.campaigns)]
    for row in run(cases, asked.log, 60 * asked.minutes):
        label = row["label"]
        print(row["seed"], "+".join(label["effects"]) or "(none)", label["variants"], f"D {label['D']:g}", "->", row["verdict"],
              row["effects"], row["confusable"], row.get("why", ""), f"{row['seconds']:.0f} s", flush=True)  # fmt: skip
    rows = read_log(asked.log)
    print(table(rows))
    if asked.out:
        asked.out.write_text(page(rows, asked.out, Path("..") / asked.picture), encoding="utf-8")
        draw_confusion(rows, asked.picture, f"{len(rows)} towing campaigns: what is true, what explain said")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
