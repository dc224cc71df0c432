"""Exploring formulas about one instant that no engine reads: a drive at a value, or a proof at that value."""

import json
from fractions import Fraction as F
from pathlib import Path

import pytest

from roadproof.analysis.explore import never
from roadproof.analysis.explore.answer import Explorable
from roadproof.analysis.explore.extreme import ExtremeQuestion, find_extreme
from roadproof.analysis.explore.knobs import Variable
from roadproof.analysis.explore.measure import read_measure
from roadproof.analysis.explore.values import explore
from roadproof.engines.search.ask import Search
from roadproof.engines.search.question import SearchOptions, Setting
from roadproof.frontends.cli.main import main
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

BASE = bundled_library().select("base")
# 30 m/s > 50 m/s^2 * rho, by cubes: wherever rho < 0.6 s.
FAST = "v_lon(SV) = 30 m/s and v_lon(SV)^3 > rho*rho*rho*(50 m/s^2)*(50 m/s^2)*(50 m/s^2)"
RHO = Variable("rho", "s", F(0), F("1.2"))


def search_for(what: str, **values: F) -> Search:
    means = SearchOptions(effort=Effort(6), explain=False)
    return Search(BASE, read_claim(BASE, what), Setting(values=values), means)


def test_every_value_has_a_drive_or_a_proof() -> None:
    explored = explore(Explorable(search_for(FAST), (RHO,), 5))
    found = {x.at[0]: x.verdict for x in explored.findings}
    assert found == {k * F("0.3"): Verdict.WITNESSED if k < 2 else Verdict.IMPOSSIBLE for k in range(5)}
    [boundary] = explored.boundaries
    assert boundary.held.at[0] < F("0.6") <= boundary.missed.at[0] < boundary.held.at[0] + F("0.03")
    assert boundary.missed.verdict is Verdict.IMPOSSIBLE
    assert boundary.missed.assuming == (f"rho = {float(boundary.missed.at[0]):g} s",)


def test_an_extreme_is_bracketed_by_proofs() -> None:
    search = search_for(f"{FAST.replace('= 30', '<= 30')} and v_lon(SV) >= 20 m/s", rho=F("0.5"))
    measure = read_measure(BASE, "least", "v_lon(SV)", "")
    extreme = find_extreme(ExtremeQuestion(search, measure, F(1, 10)))
    assert extreme.best is not None
    assert extreme.missed is not None
    assert F(25) < extreme.best.at[0] <= extreme.missed.at[0] + F(1, 10)
    assert extreme.missed.verdict is Verdict.IMPOSSIBLE
    assert extreme.missed.at[0] <= 25


@pytest.mark.parametrize(
    ("text", "proved"),
    [
        (f"{FAST} and rho >= 0.7 s", True),  # rho is 0.5 s
        ("v_lon(SV)^3 > v_lon(SV)^3 + 1*(1 m/s)*(1 m/s)*(1 m/s)", True),
        ("v_lon(SV) > v_lon(SV)", False),  # engines read it
        ("G v_lon(SV)^3 > v_lon(SV)^3 + 1*(1 m/s)*(1 m/s)*(1 m/s)", False),  # about more than an instant
        (FAST, False),
    ],
)
def test_what_is_proved_at_values(text: str, proved: bool) -> None:
    search = search_for(text, rho=F("0.5"))
    certificate = never.never(search, search.query, 2.0)
    assert (certificate is not None) == proved


def index_of(folder: Path) -> dict[str, object]:
    found: dict[str, object] = json.loads((folder / "index.json").read_text())
    return found


def test_a_proof_at_another_value_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What a proof assumes has to be the values of its entry, and what its file says."""
    folder = tmp_path / "explored"
    words = [
        "--vary",
        "rho=0:1.2",
        "--steps",
        "3",
        "--precision",
        "0.3",
        "--no-pictures",
        "--out",
        str(folder),
    ]
    assert main(["explore", FAST, *words]) == 0
    assert main(["check", str(folder)]) == 0
    index = index_of(folder)
    values = index["explored"][0]["values"]  # type: ignore[index]
    assert values[2]["assuming"] == ["rho = 1.2 s"]
    capsys.readouterr()

    def forged(change) -> str:  # type: ignore[no-untyped-def]
        content = index_of(folder)
        change(content["explored"][0]["values"])  # type: ignore[index]
        other = tmp_path / "forged"
        other.mkdir(exist_ok=True)
        for file in folder.glob("*.json"):
            (other / file.name).write_text(file.read_text())
        (other / "index.json").write_text(json.dumps(content))
        assert main(["check", str(other)]) == 10
        return capsys.readouterr().out

    def elsewhere(values: list[dict[str, object]]) -> None:
        values[0] = {**values[2], "at": ["0"]}

    def with_words(values: list[dict[str, object]]) -> None:
        values[0] = {**values[2], "at": ["0"], "assuming": ["rho = 0 s"]}

    def silently(values: list[dict[str, object]]) -> None:
        values[2] = {k: v for k, v in values[2].items() if k != "assuming"}

    def of_a_drive(values: list[dict[str, object]]) -> None:
        values[0] = {**values[0], "assuming": ["rho = 0 s"]}

    assert "assumes rho=6/5, where it is 0" in forged(elsewhere)
    assert "assumes rho = 0 s" in forged(with_words)
    assert "assumes nothing" in forged(silently)
    assert "WITNESSED assumes nothing" in forged(of_a_drive)
