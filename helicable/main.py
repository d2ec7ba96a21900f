"""The entry point `helicable`: verbs, exit codes, and errors as sentences.

Exit codes: 0 done; 1 it ran, but the result was not reached; 2 the input cannot be used (one sentence on stderr).
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence

import typer

from geometry.errors import ConvergenceError, InputError
from helicable.screen import errors

VERBS = (
    "cables", "show", "mesh", "homogenize", "loop", "stress", "specimen", "calibrate", "strand-test", "tow", "sweep", "check", "compare",
    "explain", "add", "next", "effects", "demo", "verify",
)  # fmt: skip
FILES = {
    "next": "next_experiment",
    "strand-test": "strand_test",
}  # where a verb's file and function are not named as the verb


def application(arguments: Sequence[str]) -> typer.Typer:
    """The command line with the verb that is called, or with all verbs for the help: each loads only what it needs."""
    app = typer.Typer(
        name="helicable",
        help="From the drawing of a helical cable to its beam stiffness, its towing run, and what measurements say.",
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode="markdown",
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    called = [verb for verb in VERBS if list(arguments[:1]) == [verb]]
    for verb in called or VERBS:
        name = FILES.get(verb, verb)
        app.command(verb)(getattr(importlib.import_module(f"helicable.commands.{name}"), name))
    app.callback()(lambda: None)
    return app


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    Examples
    --------
    >>> main(["homogenize", "no-such-cable"])
    2
    """
    try:
        words = sys.argv[1:] if arguments is None else list(arguments)
        result = application(words)(args=words, standalone_mode=False)
    except InputError as error:
        return _fail(str(error), 2)
    except ConvergenceError as error:
        return _fail(str(error), 1)
    except KeyboardInterrupt:
        return _fail("stopped by the user; files already written are complete.", 1)
    except Exception as error:
        if not (hasattr(error, "show") and hasattr(error, "exit_code")):  # not a usage error of the command line itself
            raise
        error.show()  # pyright: ignore[reportAttributeAccessIssue]
        return 2
    return int(result) if isinstance(result, int) else 0


def run() -> None:
    """Console script."""
    sys.exit(main())


def _fail(sentence: str, code: int) -> int:
    errors.print(f"helicable: {sentence}", markup=False, soft_wrap=True)
    return code


if __name__ == "__main__":
    run()
