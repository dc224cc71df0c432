"""Distributions of parameters of OpenSCENARIO: the scenarios of logical ones, as recordings and as tests."""

import math
from collections.abc import Mapping
from pathlib import Path
from statistics import fmean, pvariance

import numpy as np
import pytest

import roadproof as rp
from extensions.traffic.board import at, init, lane, put, rows
from roadproof.errors import InputError
from roadproof.extensions.catalogue.reading import read_catalogue
from roadproof.extensions.exchange.openscenario import read_recording
from roadproof.extensions.exchange.storyboard.distributions import (
    MOST,
    numbered_scenario_path,
    read_distribution,
)
from roadproof.extensions.traffic.formats.sources import find_source, find_sources

DECLARED = (
    '<ParameterDeclarations><ParameterDeclaration name="v" parameterType="double" value="20">{0}'
    '</ParameterDeclaration><ParameterDeclaration name="where" parameterType="double" value="100"/>'
    '<ParameterDeclaration name="side" parameterType="integer" value="-2"/></ParameterDeclarations>'
)
SPEEDS = '<DistributionRange stepWidth="0.1"><Range lowerLimit="10" upperLimit="10.3"/></DistributionRange>'
SIDES = '<DistributionSet><Element value="-1"/><Element value="-3"/></DistributionSet>'


def one(name: str, inside: str) -> str:
    tag = "DeterministicSingleParameterDistribution"
    return f'<{tag} parameterName="{name}">{inside}</{tag}>'


def together(*sets: Mapping[str, object]) -> str:
    rows = "".join(
        "<ParameterValueSet>"
        + "".join(f'<ParameterAssignment parameterRef="{x}" value="{y}"/>' for x, y in values.items())
        + "</ParameterValueSet>"
        for values in sets
    )
    tag = "DeterministicMultiParameterDistribution"
    return f"<{tag}><ValueSetDistribution>{rows}</ValueSetDistribution></{tag}>"


def drawn(inside: str, runs: int = MOST, seed: str = ' randomSeed="3"') -> str:
    parameter = f'<StochasticDistribution parameterName="v">{inside}</StochasticDistribution>'
    return f'<Stochastic numberOfTestRuns="{runs}"{seed}>{parameter}</Stochastic>'


def logical(folder: Path, inside: str, constraints: str = "") -> Path:
    """A distribution beside the scenario that it varies, in which Ego drives with v from where on."""
    (folder / "scenario").mkdir()
    position = lane(0, 0).replace('laneId="0" s="0"', 'laneId="$side" s="$where"')
    put(folder / "scenario", {"Ego": init("Ego", position, "$v")}, more=DECLARED.format(constraints))
    path = folder / "cars.xosc"
    path.write_text(
        "<OpenSCENARIO><FileHeader/><ParameterValueDistribution>"
        f'<ScenarioFile filepath="scenario/story.xosc"/>{inside}</ParameterValueDistribution></OpenSCENARIO>',
        "utf-8",
    )
    return path


def values(path: Path) -> list[Mapping[str, str]]:
    found = read_distribution(path)
    return [found.values(x) for x in found.numbers]


def test_all_combinations(tmp_path: Path) -> None:
    """Four speeds, two sides, and two sets of one further value; the last parameter changes first."""
    exact = one("v", SPEEDS) + one("side", SIDES) + together({"where": 50}, {"where": 70})
    path = logical(tmp_path, f"<Deterministic>{exact}</Deterministic>")
    found = values(path)
    speeds, sides, places = (10, 10.1, 10.2, 10.3), (-1, -3), (50, 70)
    wanted = [(v, side, s) for v in speeds for side in sides for s in places]
    assert [tuple(float(x[y]) for y in ("v", "side", "where")) for x in found] == wanted
    ego = rows(numbered_scenario_path(path, 8))["Ego"]
    assert at(ego, 1, "v_lon") == pytest.approx(10.1)
    assert at(ego, 1, "s") == pytest.approx(72 + 10.1)
    assert at(ego, 1, "d") == pytest.approx(-9)


def test_it_is_a_folder_of_recordings(tmp_path: Path) -> None:
    path = logical(tmp_path, f"<Deterministic>{one('v', SPEEDS)}</Deterministic>")
    sources = find_sources(tmp_path)
    assert [x.name for x in sources] == ["cars#1", "cars#2", "cars#3", "cars#4"]
    assert sources == find_sources(path)
    assert [len(x.files) for x in sources] == [4] * 4, "map, distribution, scenario, and its own name"
    assert find_source(tmp_path / "cars#3.xosc").read().vehicles == 1
    notes = read_recording(tmp_path / "cars#3.xosc").notes
    assert "values: v=10.2; 4 of 4 scenarios of cars.xosc are read" in notes
    with pytest.raises(InputError, match="4 recordings; name the file of one, such as cars#1"):
        find_source(path)
    with pytest.raises(InputError, match="there is no scenario 5; they are 1 to 4"):
        read_recording(tmp_path / "cars#5.xosc")
    with pytest.raises(InputError, match=r"name one of its scenarios, such as cars#1\.xosc"):
        read_recording(path)


def test_it_is_a_folder_of_tests(tmp_path: Path) -> None:
    path = logical(tmp_path, f"<Deterministic>{one('side', SIDES)}</Deterministic>")
    for given in (path, tmp_path):
        found = read_catalogue([given], rp.load("base").specification)
        assert [x.id for x in found.entries if "story" not in x.id] == ["cars#1", "cars#2"]
    assert rp.monitor("v_lon(SV) > 19 m/s", tmp_path / "cars#2.xosc").verdict == "true"


def test_constraints_leave_sets_out(tmp_path: Path) -> None:
    """Speeds of exactly 10.1, or of more than 10.15 and less than 10.25."""
    groups = (
        '<ConstraintGroup><ValueConstraint rule="equalTo" value="10.1"/></ConstraintGroup><ConstraintGroup>'
        '<ValueConstraint rule="greaterThan" value="10.15"/><ValueConstraint rule="lessThan" value="10.25"/>'
        "</ConstraintGroup>"
    )
    path = logical(tmp_path, f"<Deterministic>{one('v', SPEEDS)}</Deterministic>", groups)
    assert [x["v"] for x in values(path)] == ["10.1", "10.2"]
    assert [x.name for x in find_sources(path)] == ["cars#2", "cars#3"]
    assert read_distribution(path).note == "2 of 4 scenarios of cars.xosc are read"


def test_constraints_may_use_other_parameters(tmp_path: Path) -> None:
    """Of 61 and 70 m only 61, and that with speeds of more than 61 / 6 = 10.17 m/s."""
    inside = f"<Deterministic>{one('where', SIDES.replace('-1', '61').replace('-3', '70'))}{one('v', SPEEDS)}"
    path = logical(tmp_path, f"{inside}</Deterministic>")
    scenario = tmp_path / "scenario/story.xosc"
    where = '<ParameterDeclaration name="where" parameterType="double" value="100"/>'
    limit = '<ConstraintGroup><ValueConstraint rule="lessThan" value="${$v * 6}"/></ConstraintGroup>'
    text = scenario.read_text("utf-8")
    assert where in text
    scenario.write_text(text.replace(where, where.replace("/>", f">{limit}</ParameterDeclaration>")), "utf-8")
    assert [(x["where"], x["v"]) for x in values(path)] == [("61", "10.2"), ("61", "10.3")]


def test_of_many_combinations_some_are_drawn(tmp_path: Path) -> None:
    many = '<DistributionRange stepWidth="1"><Range lowerLimit="1" upperLimit="100"/></DistributionRange>'
    path = logical(tmp_path, f"<Deterministic>{one('v', many)}{one('where', many)}</Deterministic>")
    found = read_distribution(path)
    assert found.total == 10_000
    assert len(set(found.numbers)) == MOST
    assert found.numbers == read_distribution(path).numbers
    assert found.note == f"{MOST} of 10000 scenarios of cars.xosc are read, of {MOST} that were drawn"
    speeds = [float(found.values(x)["v"]) for x in found.numbers]
    assert fmean(speeds) == pytest.approx(50.5, abs=4)


@pytest.mark.parametrize(
    ("inside", "mean", "variance"),
    [
        ('<NormalDistribution expectedValue="20" variance="9"/>', 20, 9),
        (
            '<NormalDistribution expectedValue="20" variance="9"><Range lowerLimit="20" upperLimit="80"/>'
            "</NormalDistribution>",
            20 + 3 * math.sqrt(2 / math.pi),
            9 * (1 - 2 / math.pi),
        ),
        ('<UniformDistribution><Range lowerLimit="10" upperLimit="22"/></UniformDistribution>', 16, 12),
        ('<PoissonDistribution expectedValue="7"/>', 7, 7),
        (
            '<Histogram><Bin weight="1"><Range lowerLimit="0" upperLimit="6"/></Bin><Bin weight="3">'
            '<Range lowerLimit="10" upperLimit="16"/></Bin></Histogram>',
            0.25 * 3 + 0.75 * 13,
            3 + 0.25 * 0.75 * 100,
        ),
        (
            '<ProbabilityDistributionSet><Element value="1" weight="1"/><Element value="5" weight="3"/>'
            "</ProbabilityDistributionSet>",
            4,
            3,
        ),
    ],
)
def test_samples_have_the_moments_of_their_distribution(
    inside: str, mean: float, variance: float, tmp_path: Path
) -> None:
    """Within four standard errors of 500 samples."""
    path = logical(tmp_path, drawn(inside))
    found = [float(x["v"]) for x in values(path)]
    assert len(found) == MOST
    assert fmean(found) == pytest.approx(mean, abs=4 * math.sqrt(variance / MOST))
    assert pvariance(found) == pytest.approx(variance, rel=0.3)
    assert values(path) == values(path)


def test_a_seed_says_which_samples(tmp_path: Path) -> None:
    inside = '<UniformDistribution><Range lowerLimit="10" upperLimit="22"/></UniformDistribution>'
    path = logical(tmp_path, drawn(inside, 5))
    first = values(path)
    path.write_text(path.read_text("utf-8").replace('randomSeed="3"', 'randomSeed="4"'), "utf-8")
    assert values(path) != first
    speed = at(rows(numbered_scenario_path(path, 5))["Ego"], 0, "v_lon")
    assert np.isclose(speed, float(values(path)[4]["v"]))


@pytest.mark.parametrize(
    ("inside", "told"),
    [
        ("<Other/>", "Deterministic or Stochastic is needed"),
        (f"<Deterministic>{one('w', SIDES)}</Deterministic>", "declares no parameter w, which is varied"),
        (
            f"<Deterministic>{one('v', '<UserDefinedDistribution/>')}</Deterministic>",
            "one DistributionSet or DistributionRange is needed",
        ),
        (
            f"<Deterministic>{one('v', SPEEDS.replace('0.1', '-1'))}</Deterministic>",
            "stepWidth=-1 from 10 to 10.3 is no range",
        ),
        (drawn("<LogNormalDistribution/>"), "StochasticDistribution: LogNormalDistribution is not supported"),
        (drawn('<PoissonDistribution expectedValue="3"/>', 501), "numberOfTestRuns=501: from 1 to 500"),
        (drawn('<NormalDistribution expectedValue="3" variance="0"/>'), "variance=0 must be above 0"),
    ],
)
def test_refusals(inside: str, told: str, tmp_path: Path) -> None:
    path = logical(tmp_path, inside)
    with pytest.raises(InputError) as error:
        read_recording(numbered_scenario_path(path, 1))
    assert told in str(error.value)
