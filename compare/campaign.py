"""A campaign: a folder of measured experiments on one cable, read strictly; the only thing that a user has to bring.

Every number is SI after reading. Tables of `sealed` experiments are hashed and not read: they are opened once, on
request, by :meth:`Campaign.open_sealed`, so that a model that was fixed before can be judged on data it never saw.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from compare.campaign_file import FILE as CAMPAIGN_FILE
from compare.campaign_file import read_campaign_file
from compare.experiment import Experiment
from compare.experiment_list import FILE as LIST_FILE
from compare.experiment_list import ListedExperiment, read_experiment_list
from compare.nominal_section import NominalSection
from compare.record_table import read_record
from compare.text_file import digest, read_bytes
from geometry.errors import InputError, SpecError

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Campaign:
    """All experiments of a campaign folder, in SI.

    Attributes
    ----------
    folder : Path
        Where it was read from.
    title : str
        From campaign.toml; empty where it has none.
    cable : str or None
        Name of a built-in cable, or path of a cable file relative to the folder.
    section : NominalSection or None
        The nominal section, where campaign.toml states one; it wins over the cable's own.
    sensors : mapping of str to float
        Standard uncertainty of one sample by channel.
    towing : mapping of str to float
        Table [towing], SI.
    experiments : tuple of Experiment
        In the order of experiments.csv.
    sealed_opened : bool
        Whether the sealed tables were opened.

    Examples
    --------
    >>> campaign = Campaign.read("my-campaign")                                     # doctest: +SKIP
    >>> [e.id for e in campaign.of_set("calibrate")]                                # doctest: +SKIP
    ['b01', 'b02']
    """

    folder: Path
    title: str
    cable: str | None
    section: NominalSection | None
    sensors: Mapping[str, float]
    towing: Mapping[str, float]
    experiments: tuple[Experiment, ...]
    sealed_opened: bool = False

    @classmethod
    def read(cls, path: str | Path) -> Campaign:
        """Read a campaign folder; sealed tables are hashed, not read.

        Raises
        ------
        SpecError
            One sentence that names file, row and column of the first thing that is not understood.
        """
        folder = Path(path)
        if not folder.exists():
            raise SpecError(f"{folder}: there is no such folder; give the folder that holds {CAMPAIGN_FILE}.")
        if not folder.is_dir():
            raise SpecError(f"{folder}: this is not a folder; give the folder that holds {CAMPAIGN_FILE}.")
        content = read_campaign_file(read_bytes(folder / CAMPAIGN_FILE, CAMPAIGN_FILE))
        listed = read_experiment_list(read_bytes(folder / LIST_FILE, LIST_FILE))
        _check_towing(listed, content.towing)
        paths = _table_paths(folder, listed)
        experiments = tuple(_experiment(row, paths[row.id]) for row in listed)
        return cls(folder, content.title, content.cable, content.section, content.sensors, content.towing, experiments)

    def open_sealed(self) -> Campaign:
        """The same campaign with its sealed tables read; to be done once, after the model is fixed.

        Raises
        ------
        SpecError
            If a sealed table is not what it was when the campaign was read, or is not understood.
        """
        sealed = [e.id for e in self.experiments if not e.is_open]
        log.warning("sealed experiments opened: %s", ", ".join(sealed) or "none")
        opened = tuple(e if e.is_open else _opened(e, self.folder) for e in self.experiments)
        return replace(self, experiments=opened, sealed_opened=True)

    def of_set(self, name: str) -> tuple[Experiment, ...]:
        """Experiments of the set ``calibrate``, ``validate`` or ``sealed``."""
        return tuple(e for e in self.experiments if e.set == name)

    @property
    def readable(self) -> tuple[Experiment, ...]:
        """Experiments whose tables were read: all but the sealed ones, until these are opened."""
        return tuple(e for e in self.experiments if e.is_open)

    def __getitem__(self, id: str) -> Experiment:
        for experiment in self.experiments:
            if experiment.id == id:
                return experiment
        raise InputError(f"the campaign has no experiment {id}; it has {', '.join(e.id for e in self.experiments)}.")


def _experiment(row: ListedExperiment, path: Path) -> Experiment:
    raw = read_bytes(path, row.file)
    sealed = row.set == "sealed"
    return Experiment(
        id=row.id,
        kind=row.kind,
        file=row.file,
        specimen=row.specimen,
        set=row.set,
        conditions=row.conditions,
        repeat_of=row.repeat_of,
        continues=row.continues,
        direction=row.direction,
        control=row.control,
        sha256=digest(raw),
        table=None if sealed else read_record(raw, row.file, row.kind, row.control, row.conditions),
    )


def _opened(experiment: Experiment, folder: Path) -> Experiment:
    raw = read_bytes(folder / experiment.file, experiment.file)
    if digest(raw) != experiment.sha256:
        raise SpecError(
            f"{experiment.file}: the sealed table was changed after the campaign was read; read the campaign again."
        )
    return replace(
        experiment, table=read_record(raw, experiment.file, experiment.kind, experiment.control, experiment.conditions)
    )


def _table_paths(folder: Path, listed: tuple[ListedExperiment, ...]) -> dict[str, Path]:
    """Path of every table; each must lie inside the folder and belong to one experiment only."""
    root = folder.resolve()
    paths: dict[str, Path] = {}
    for row in listed:
        where = f'{LIST_FILE}, row {row.row}, column "file"'
        try:
            path = (folder / row.file).resolve()
        except (OSError, ValueError, RuntimeError):
            raise SpecError(f'{where}: "{row.file}" is not a file name.') from None
        if Path(row.file).is_absolute() or not path.is_relative_to(root):
            raise SpecError(f'{where}: "{row.file}" lies outside the campaign folder; copy the table into it.')
        if path.name in (CAMPAIGN_FILE, LIST_FILE) and path.parent == root:
            raise SpecError(f'{where}: "{row.file}" is not a table of an experiment.')
        twin = next((id for id, other in paths.items() if other == path), None)
        if twin is not None:
            raise SpecError(f'{where}: "{row.file}" is already the table of {twin}; every experiment has its own.')
        if not path.exists():
            raise SpecError(f'{where}: "{row.file}" is not in the campaign folder.')
        if not path.is_file():
            raise SpecError(f'{where}: "{row.file}" is not a file.')
        paths[row.id] = path
    return paths


def _check_towing(listed: tuple[ListedExperiment, ...], towing: Mapping[str, float]) -> None:
    """A towing experiment needs its table; what the conditions or the section give need not stand there."""
    tows = [row for row in listed if row.kind == "towing"]
    if not tows:
        return
    for key in ("friction_coefficient", "cable_length"):
        if key not in towing:
            raise SpecError(
                f"{CAMPAIGN_FILE}, [towing]: {key} is missing; the towing experiment {tows[0].id} needs it."
            )
    for row in tows:
        for key, condition in (("tail_tension", "tail tension"), ("inclination", "inclination")):
            if key not in towing and condition not in row.conditions:
                raise SpecError(
                    f"{LIST_FILE}, row {row.row}: {row.id} has no {condition}, and "
                    f"{CAMPAIGN_FILE}, [towing] gives no {key}."
                )
