"""Campaign folders that the tests write themselves, with known truth and known noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from sound_campaign import FILES, TOML

Writer = Callable[..., Path]


@pytest.fixture
def folder(tmp_path: Path) -> Writer:
    """Write the small sound campaign, with some files replaced (None leaves one out)."""

    def write(changes: Mapping[str, str | bytes | None] | None = None) -> Path:
        for name, content in {**FILES, **(changes or {})}.items():
            if content is not None:
                path = tmp_path / name
                path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return tmp_path

    return write


@pytest.fixture
def campaign_of(tmp_path: Path) -> Writer:
    """Write a campaign of records given as arrays; rows are dictionaries of the columns of experiments.csv."""

    def write(
        rows: Sequence[Mapping[str, object]], tables: Mapping[str, Mapping[str, NDArray[np.float64]]], toml: str = TOML
    ) -> Path:
        columns = list(
            dict.fromkeys(["id", "kind", "file", "specimen", "repeat_of", "set", *(c for r in rows for c in r)])
        )
        lines = [",".join(columns)]
        for row in rows:
            full = {"file": f"{row['id']}.csv", "specimen": "S1", "set": "calibrate", **row}
            lines.append(",".join(str(full.get(c, "")) for c in columns))
        (tmp_path / "experiments.csv").write_text("\n".join(lines) + "\n")
        (tmp_path / "campaign.toml").write_text(toml)
        for id, table in tables.items():
            head = ",".join(table)
            np.savetxt(
                tmp_path / f"{id}.csv",
                np.column_stack(list(table.values())),
                delimiter=",",
                header=head,
                comments="",
                fmt="%.17g",
            )
        return tmp_path

    return write


def record_noise(
    rng: np.random.Generator,
    signal: NDArray[np.float64],
    s: float,
    phi: float = 0.0,
    gain: float = 0.0,
    offset: float = 0.0,
) -> NDArray[np.float64]:
    """One record's noise drawn from its definition, sample after sample."""
    n = len(signal)
    e = np.empty(n)
    e[0] = rng.normal()
    for t in range(1, n):
        e[t] = phi * e[t - 1] + np.sqrt(1 - phi**2) * rng.normal()
    return s * e + gain * rng.normal() * signal + offset * rng.normal()


@pytest.fixture
def draw_noise() -> Callable[..., NDArray[np.float64]]:
    """See :func:`record_noise`."""
    return record_noise
