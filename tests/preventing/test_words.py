"""Words for symbols of initial values, and for parts of driver models in pictures."""

from fractions import Fraction

import pytest

import roadproof as rp
from roadproof.drivers.manoeuvres import MANOEUVRES
from roadproof.drivers.models import MODELS, unpreventable
from roadproof.drivers.words import _PARTS, legend, words_of_parts
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.report.drive_data import strips_of
from roadproof.frontends.report.preventable import as_text, shown_symbols
from roadproof.logic.formula import And, Application, subformulas


@pytest.fixture(scope="module")
def drivers() -> Definitions:
    return rp.load(specs=["driver"])


def test_all_words_are_of_definitions(drivers: Definitions) -> None:
    for name in _PARTS:
        assert name in drivers.specification.definitions


@pytest.mark.parametrize("manoeuvre", MANOEUVRES)
def test_the_side_of_each_model_has_words(manoeuvre: str, drivers: Definitions) -> None:
    """The first vehicle is the one that is driven, whatever it is called."""
    for model in (x for x in MODELS if manoeuvre in MODELS[x].manoeuvres and not MODELS[x].is_stepped):
        for vehicles in (MANOEUVRES[manoeuvre].vehicles, MANOEUVRES[manoeuvre].vehicles[::-1]):
            formula = drivers.read(unpreventable(manoeuvre, model, vehicles)).formula
            told = words_of_parts(formula)[formula]
            assert told.startswith(f"{vehicles[0]}, ")
            assert "cannot prevent a collision (unpreventable_" in told


def test_parts_speak_of_the_vehicles_around_them(drivers: Definitions) -> None:
    for one, other in (("SV", "POV"), ("POV", "SV")):
        formula = drivers.read(f"unpreventable_cutIn_careful({one}, {other})").formula
        words = {x.name.partition("@")[0]: told for x, told in words_of_parts(formula).items()}
        assert words["careful_hits"] == f"{one}, driven as the careful driver, hits {other} (careful_hits)"
        assert words["comesIn"] == f"{other}, ahead of {one} and beside its way, comes into it (comesIn)"
    both = drivers.read("unpreventable_cutIn_rss(SV, POV) or unpreventable_cutIn_rss(POV, SV)").formula
    hits = {told for x, told in words_of_parts(both).items() if x.name.startswith("rss_hits")}
    assert hits == {
        f"{a}, which responds as RSS asks, hits {b} (rss_hits)" for a, b in (("SV", "POV"), ("POV", "SV"))
    }


def test_other_parts_keep_their_names() -> None:
    formula = rp.load().read("scenario_4(SV,POV,L)").formula
    assert any(isinstance(x, Application) for x in subformulas(formula))
    assert words_of_parts(formula) == {}
    assert words_of_parts(And(())) == {}


def test_symbols_and_strips_of_a_plate() -> None:
    """The text ends with all symbols that it shows; strips of its drives have words in place of numbers."""
    found = rp.preventable(
        "cut-in", models=["careful"], at={"Ve0": "60km/h", "Vy": "1"}, lines=3, lemmas=False, jobs=1
    )
    told = as_text(found.study, found.plates, ()).splitlines()[-1]
    for symbol in (
        "Ve0: the speed of SV (km/h)",
        "dV0: how much faster SV is",
        "dx0: the gap along the road (m)",
    ):
        assert symbol in told
    assert {x.name for x in shown_symbols(found.study)} == {"Ve0", "dV0", "Vy", "dx0"}
    drives = [x.drive for plate in found.plates for x in plate.shown if x.drive is not None]
    assert len(drives) == 2
    for drive in drives:
        names = [x.name for x in strips_of(drive.judgement, Fraction(6))]
        assert "SV, driven as the careful driver, hits POV (careful_hits)" in names
        assert not any(name.startswith("careful_hits(") for name in names)


@pytest.mark.parametrize("manoeuvre", MANOEUVRES)
def test_every_symbol_has_words_and_a_unit(manoeuvre: str) -> None:
    told = legend(MANOEUVRES[manoeuvre].quantities.values())
    for name, x in MANOEUVRES[manoeuvre].quantities.items():
        assert f"{name}: {x.doc} ({x.unit})" in told.split("; ")
