"""A table that is read in windows gives the same vehicles, notes and faults as one that is read whole."""

import random
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats import windows
from roadproof.extensions.traffic.formats.large import divide_large
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.samples import HEADER, read_recording

ROAD = (
    '[[lanelet]]\nid = "1"\nlane = "1"\nzone = "main"\nattribute = "main"\ns = [-1000, 9000]\nd = [-7, 0]\n'
)
Rows = list[list[str]]
Change = Callable[[Rows, random.Random], str]
"""Changes rows (without the header), and returns the content of the file."""


REST = ("0", "0", "0", "4.5", "1.8")


def rows_of(rng: random.Random, count: int) -> Rows:
    names = rng.choice((("1", "2", "3", "7"), ("SV", "POV", "B", "Ä"), ("Müller", "车", "POV", "x")))
    speeds = {name: rng.uniform(10, 30) for name in names}
    rows = [
        [f"{k / 10:g}", name, f"{40 * j + speeds[name] * k / 10:.4f}", "-1", f"{speeds[name]:.4f}", *REST]
        for j, name in enumerate(names)
        for k in range(count)
    ]
    if rng.random() < 0.5:
        rows.sort(key=lambda row: float(row[0]))
    return rows


def content_of(rows: Rows, comma: str = ",") -> str:
    return "".join(comma.join(row) + "\n" for row in (list(HEADER), *rows))


def plain(rows: Rows, rng: random.Random) -> str:
    return content_of(rows)


def shuffled(rows: Rows, rng: random.Random) -> str:
    rng.shuffle(rows)
    return content_of(rows)


def copied(rows: Rows, rng: random.Random) -> str:
    for _ in range(rng.randint(1, 3)):
        rows.insert(rng.randrange(len(rows)), list(rng.choice(rows)))
    return content_of(rows)


def contradicting(rows: Rows, rng: random.Random) -> str:
    row = list(rng.choice(rows))
    row[2] = "17"
    rows.insert(rng.randrange(len(rows)), row)
    return content_of(rows)


def spaced(rows: Rows, rng: random.Random) -> str:
    return content_of(rows, ", ")


def quoted(rows: Rows, rng: random.Random) -> str:
    return content_of([[f'"{x}"' for x in row] for row in rows])


def bad_cell(rows: Rows, rng: random.Random) -> str:
    rng.choice(rows)[rng.randrange(2, 10)] = rng.choice(("1e9", "-1e9", "inf", "x", ""))
    return content_of(rows)


def gap(rows: Rows, rng: random.Random) -> str:
    del rows[rng.randrange(len(rows))]
    return content_of(rows)


def jump(rows: Rows, rng: random.Random) -> str:
    row = rng.choice(rows)
    row[2] = f"{float(row[2]) + 75:.4f}"
    return content_of(rows)


def short(rows: Rows, rng: random.Random) -> str:
    rng.choice(rows).pop()
    return content_of(rows)


def page(rows: Rows, rng: random.Random) -> str:
    return "<!DOCTYPE html>\n" + content_of(rows)


def cut_off(rows: Rows, rng: random.Random) -> str:
    return content_of(rows)[:-3]


CHANGES: Mapping[str, Change] = {
    x.__name__: x
    for x in (
        *(plain, shuffled, copied, contradicting, spaced, quoted),
        *(bad_cell, gap, jump, short, page, cut_off),
    )
}


def outcome(read: Callable[[], Recording]) -> tuple[str, frozenset[str], list[object]]:
    """The error, or the notes and the vehicles with their samples."""
    try:
        found = read()
    except InputError as error:
        return str(error), frozenset(), []
    samples = [getattr(found, x) for x in ("vehicle_id", "first_frame", "start", "s", "d", "v_lon", "kind")]
    return "", frozenset(found.notes), [x.tolist() for x in samples]


def joined(path: Path, strict: bool) -> Recording:
    """The recording of a large file, of which all vehicles fit into one window once it is converted."""
    divided = divide_large(path, strict)
    assert divided is not None
    (window,) = divided.windows()
    assert len(window.recording.vehicle_id)
    return window.recording


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("change", sorted(CHANGES))
@pytest.mark.parametrize("strict", [True, False])
def test_both_readers_agree(
    strict: bool, change: str, seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = random.Random(f"{change} {seed}")
    path = tmp_path / "a.csv"
    path.write_text(CHANGES[change](rows_of(rng, 30), rng), "utf-8")
    (tmp_path / "a_road.toml").write_text(ROAD)
    whole = outcome(lambda: read_recording(path, strict))
    monkeypatch.setattr(windows, "MOST_SAMPLES", rng.choice((35, 70, 110)))
    monkeypatch.setattr("roadproof.extensions.traffic.formats.samples.PIECE", 13)
    monkeypatch.setattr("roadproof.extensions.traffic.formats.table.PIECE", 500)
    assert outcome(lambda: joined(path, strict)) == whole


def test_the_faults_are_faults(tmp_path: Path) -> None:
    """The negative control: what is refused of a strict reader, and what is not."""
    (tmp_path / "a_road.toml").write_text(ROAD)
    refused = set()
    for name, change in CHANGES.items():
        rng = random.Random(7)
        path = tmp_path / "a.csv"
        path.write_text(change(rows_of(rng, 30), rng), "utf-8")
        if outcome(lambda path=path: read_recording(path))[0]:  # type: ignore[misc]
            refused.add(name)
    assert refused >= {"contradicting", "bad_cell", "short", "page", "cut_off"}
    assert not refused & {"plain", "shuffled", "copied", "spaced", "quoted"}
