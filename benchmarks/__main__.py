"""`python -m benchmarks`: run all benchmarks and print their tables."""

from __future__ import annotations

import importlib

for name in ("mesh", "cell", "rod_towing"):
    importlib.import_module(f"benchmarks.{name}").main()
