"""`python -m benchmarks.blind`: hidden-effect campaigns, `compare.explain` on them, and the scorecard.

python -m benchmarks.blind --campaigns 600 --seeds tuning          run and print the scorecard
python -m benchmarks.blind show LOG --wrong                        list the failures with their seeds
python -m benchmarks.blind make SEED FOLDER                        write one campaign (--label prints its truth)
python -m benchmarks.blind score LOG                               the scorecard of a log, without running
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Iterable
from pathlib import Path

from benchmarks.blind.judge import Row, class_of, right
from benchmarks.blind.methods import BASELINE_NAMES, METHODS
from benchmarks.blind.plan import RANGES
from benchmarks.blind.runner import Job, labels_of, read_log, run
from benchmarks.blind.scorecard import scorecard, side_by_side


def _arguments(argv: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.blind", description="Hidden-effect campaigns and the scorecard."
    )
    parser.add_argument("--campaigns", type=int, default=600)
    parser.add_argument("--seeds", choices=sorted(RANGES), default="tuning")
    parser.add_argument("--first", type=int, default=0, help="start at this place of the range")
    parser.add_argument("--only", help="comma-separated groups: null, single, tie, outside, pair, untestable")
    parser.add_argument("--effect", help="only campaigns with this effect")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--method", default="explain", choices=sorted(METHODS))
    parser.add_argument("--no-baselines", action="store_true")
    parser.add_argument("--baseline-campaigns", type=int, default=200, help="baselines see the first so many only")
    parser.add_argument("--log", type=Path, help="default: out/blind-<seeds>.jsonl")
    parser.add_argument("--resume", action="store_true", help="go on with the log instead of beginning anew")
    parser.add_argument("--out", type=Path, help="write the scorecard to this Markdown file")
    parser.add_argument("--keep", type=Path, help="keep the campaign folders here")
    return parser.parse_args(argv)


def _chosen(arguments: argparse.Namespace) -> list[int]:
    """Seeds in the order of their range that fit the wishes."""
    from benchmarks.blind.plan import case_of

    wanted = arguments.only.split(",") if arguments.only else None
    seeds: list[int] = []
    seed = RANGES[arguments.seeds].start + arguments.first
    while len(seeds) < arguments.campaigns and seed in RANGES[arguments.seeds]:
        case = case_of(seed)
        if (wanted is None or case.group in wanted) and (not arguments.effect or arguments.effect in case.effects):
            seeds.append(seed)
        seed += 1
        if seed - RANGES[arguments.seeds].start > 200_000:
            break
    return seeds


def _score(argv: list[str]) -> int:
    arguments = _arguments(argv)
    seeds = _chosen(arguments)
    log = arguments.log or Path("out") / f"blind-{arguments.seeds}.jsonl"
    if not arguments.resume:
        log.unlink(missing_ok=True)
    start = time.perf_counter()
    labels, digest = labels_of(seeds, arguments.workers, log.parent)
    print(f"{len(labels)} labels made in {time.perf_counter() - start:.0f} s; sha256 {digest}", flush=True)
    keep = str(arguments.keep) if arguments.keep else None
    jobs = [Job(seed, arguments.method, keep) for seed in seeds]
    if not arguments.no_baselines:
        jobs += [Job(seed, "baselines") for seed in seeds[: arguments.baseline_campaigns]]
    _follow(run(jobs, labels, log, arguments.workers), len(jobs), arguments.method)
    methods = [arguments.method, *(() if arguments.no_baselines else BASELINE_NAMES)]
    text = report(log, methods, set(seeds), f"seeds {arguments.seeds}, sha256 of the labels {digest}")
    print(text)
    if arguments.out:
        arguments.out.write_text(text, encoding="utf-8")
    return 0


def _follow(answers: Iterable[Row], total: int, main_method: str) -> None:
    """Use up the answers and show how far they are: one line that is overwritten, or a line now and then in a file."""
    begun, wrong, terminal = time.perf_counter(), 0, sys.stdout.isatty()
    for done, row in enumerate(answers, start=1):
        wrong += row["method"] == main_method and not right(row)
        each = (time.perf_counter() - begun) / done
        left = f"{each:.2f} s each, {each * (total - done):.0f} s left  "
        if terminal or done % 25 == 0 or done == total:
            end = "\r" if terminal and done < total else "\n"
            print(f"{done}/{total} ({row['method']}), {wrong} not right, {left}", end=end, flush=True)


def report(log: Path, methods: list[str], seeds: set[int] | None, note: str) -> str:
    """Scorecard of the first method, and all methods beside each other."""
    rows = read_log(log)
    by_method = {
        m: [r for (name, s), r in sorted(rows.items()) if name == m and (seeds is None or s in seeds)] for m in methods
    }
    by_method = {m: some for m, some in by_method.items() if some}
    if not by_method:
        return "no answers in the log.\n"
    name, main = next(iter(by_method.items()))
    text = f"# Blind campaigns\n\n{note}\n\n{scorecard(main, name)}\n"
    return text + (f"\n{side_by_side(by_method)}\n" if len(by_method) > 1 else "")


def _show(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.blind show")
    parser.add_argument("log", type=Path)
    parser.add_argument("--wrong", action="store_true")
    parser.add_argument("--method", default="explain")
    parser.add_argument("--only", help="comma-separated classes: null, single, tie, outside, pair, hidden")
    arguments = parser.parse_args(argv)
    wanted = arguments.only.split(",") if arguments.only else None
    for (method, seed), row in sorted(read_log(arguments.log).items()):
        if method != arguments.method or (arguments.wrong and right(row)) or (wanted and class_of(row) not in wanted):
            continue
        t = row["label"]
        truth = " + ".join(f"{e}/{v}" for e, v in zip(t["effects"], t["variants"])) or "nothing"
        rival = f" rival {t['rival']} at {t['apart']:g}" if t["rival"] else ""
        twins = f" twins {t['twins']}" if t["twins"] else ""
        print(f"{seed:7d} {class_of(row):8s} {truth}  [{t['kind']}, {t['design']}, {t['noise']} {t['size']:g}, strength {t['strength']:g}, "
              f"D {t['D']:g} {t['D_alone'] if len(t['D_alone']) > 1 else ''}, F0 {t['F0']:g}]{twins}{rival}")  # fmt: skip
        print(
            f"        -> {row['verdict']} {row['effects']} {row['confusable'] or ''} {row.get('closest') or ''} {row.get('why', '')}"
        )
        if row.get("ranking"):
            print(
                "           "
                + "; ".join(f"{c[0]} ({c[1]}) e {c[2]:g} share {c[3]:g} behind {c[4]:g}" for c in row["ranking"][:4])
            )
    return 0


def _make(argv: list[str]) -> int:
    from benchmarks.blind.generator import label, make

    parser = argparse.ArgumentParser(prog="python -m benchmarks.blind make")
    parser.add_argument("seed", type=int)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--label", action="store_true", help="print the truth, too")
    arguments = parser.parse_args(argv)
    print(make(arguments.seed, arguments.folder))
    if arguments.label:
        print(json.dumps(label(arguments.seed)))
    return 0


def _rescore(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.blind score")
    parser.add_argument("log", type=Path)
    arguments = parser.parse_args(argv)
    methods = list(dict.fromkeys(method for method, _ in read_log(arguments.log)))
    print(report(arguments.log, methods, None, f"log {arguments.log}"))
    return 0


def main(argv: list[str]) -> int:
    """Dispatch on the first word."""
    commands = {"show": _show, "make": _make, "score": _rescore}
    if argv and argv[0] in commands:
        return commands[argv[0]](argv[1:])
    return _score(argv)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
