"""Whoever follows the remedy of an UNKNOWN gets no error, and not the same UNKNOWN again."""

import json
import os
import re
from functools import cache
from random import Random

import pytest

import roadproof as rp
from roadproof.engines.prove.unknown import NO_REMEDY, Cause, Remedy, StopPoint, UnknownReport, unknown_report
from roadproof.engines.search.batches import Engines
from roadproof.engines.search.remedy import find_remedy
from roadproof.frontends.cli.main import main
from roadproof.frontends.settings.option import Settings
from roadproof.frontends.settings.questions import Prove
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.motion import split_claim
from roadproof.questions import decide
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import Effort

HOME = bundled_library().select()
CLAIMS = (
    "atLane(POV,L) -> F atLane(POV,L) U onMainRoad(POV)",
    "s(POV) <= 0 m -> G[1 s, 1 s] s(POV) <= 9 m",
    "danger(SV,POV) -> F[0, 3 s] aheadOf(SV,POV)",
    "inMergeZone(SV) -> F onMainRoad(SV)",
    "G F atLane(SV,L) -> F G atLane(SV,L)",
    "(every M in lanes: not atLane(SV,M)) -> G not onMainRoad(SV)",
    "assuming motion: s(POV) <= 0 m -> G[1 s, 1 s] s(POV) <= 9 m",
    "assuming motion, v_lon(POV) <= 30 m/s: s(POV) <= 0 m -> G[1 s, 1 s] s(POV) <= 9 m",
    "assuming motion: atLane(SV,L) and F atLane(POV,L) -> atLane(SV,L) U atLane(POV,L)",
    "given x: m/s: v_lon(SV) > x -> F v_lon(SV) < x",
)
BY_ITSELF = (Cause.WORK, Cause.CLOCK, Cause.PROCESS)
BY_FORM = tuple(x for x in Cause if x not in BY_ITSELF)
RANDOM = 40
"""Claims that are put together by chance."""


def random_claim(random: Random) -> str:
    """A claim about one to three vehicles, with windows, quantifiers, parameters or assumptions."""
    names = random.sample(("SV", "POV", "POV1", "POV2"), random.randint(1, 3))

    def part() -> str:
        one, other = random.choice(names), random.choice(names)
        return random.choice(
            (
                f"v_lon({one}) > {random.randint(1, 40)} m/s",
                f"s({one}) < s({other}) + {random.randint(0, 90)} m",
                f"s({one}) - s({other}) < v_lon({one})*minSafe",
                f"a_lon({one}) <= 3 m/s^2",
                f"atLane({one},{random.choice(('L', 'L1'))})",
                f"inMergeZone({one})",
                f"(some M in lanes: atLane({one},M) and atLane({other},M))",
            )
        )

    def tree(depth: int) -> str:
        if depth == 0:
            return part()
        window = random.choice(("", "[0, 3 s]", "[1 s, 2 s]"))
        inner = [tree(depth - 1) for _ in range(2)]
        return random.choice(
            (
                f"F{window} ({inner[0]})",
                f"G{window} ({inner[0]})",
                f"(({inner[0]}) U{window} ({inner[1]}))",
                f"(({inner[0]}) and ({inner[1]}))",
                f"not ({inner[0]})",
            )
        )

    claim = f"{tree(random.randint(0, 1))} -> {tree(random.randint(0, 2))}"
    before = random.choice(("", "", "assuming motion: ", f"assuming motion, v_lon({names[0]}) <= 30 m/s: "))
    return before + claim


def generated() -> tuple[str, ...]:
    random = Random(39)
    return tuple(random_claim(random) for _ in range(RANDOM))


def doubtful(claim: str, cause: Cause) -> UnknownReport:
    """The doubt about a claim as a study has it; ``said``: what it is asked under."""
    said, claim_text = split_claim(claim)
    query = read_claim(HOME, claim_text)
    return UnknownReport(cause, ("proof",), 5.0, option=find_remedy(HOME, query, said, cause), seconds=30.0)


def ask(claim: str, options: tuple[str, ...], capsys) -> dict:
    """The entry of an answer; it is no error to ask so."""
    code = main(["prove", claim, *options, "--json", "-"])
    printed = capsys.readouterr()
    assert code in (0, 10, 20), (claim, options, printed.err)
    (entry,) = json.loads(printed.out)["verdicts"]
    return entry


def followed(claim: str, remedy: Remedy, given: tuple[str, ...], capsys) -> dict:
    """The answer to a claim with the options of a remedy, in the place of those that were ``given``."""
    asked = split_claim(claim)[1] if remedy.without_assumptions else claim
    return ask(asked, (*given, *remedy.options), capsys)


@cache
def accepted() -> set[tuple[str, Remedy]]:
    return set()


def check(claim: str, capsys) -> None:
    """For each cause that a claim can have: a remedy is about the claim, whatever its cause is."""
    for remedy in {doubtful(claim, x).remedy for x in BY_FORM} - {None}:
        assert remedy.options
        assert all(x in remedy.text for x in remedy.options)
        before, entry = (
            split_claim(claim)[0],
            followed(claim, remedy, ("--effort", "0.02", "--jobs", "1"), capsys),
        )
        is_bounded = "--engine" in remedy.options
        assert is_bounded or "--declared" in remedy.options or len(entry["assuming"]) > len(before)
        assert not remedy.without_assumptions or not entry.get("assuming")
        accepted().add((claim, remedy))


@pytest.mark.parametrize("claim", [*CLAIMS, *generated()[:4]])
def test_every_remedy_is_accepted_and_asks_something_else(claim, capsys):
    check(claim, capsys)


@pytest.mark.parametrize("claim", generated()[4:])
def test_every_remedy_of_further_claims_is_accepted(claim, capsys):
    check(claim, capsys)


def test_remedies_of_all_kinds_were_followed():
    if not accepted():
        pytest.skip("the tests of remedies were not run")
    flags = {x for _, remedy in accepted() for x in remedy.options if x.startswith("--")}
    assert flags == {"--assume", "--vehicle", "--engine", "--road", "--declared"}
    assert any(x.without_assumptions for _, x in accepted())


UNKNOWN = (
    "assuming motion, a_lon(SV) <= 2 m/s^2: v_lon(SV) <= 0 m/s and s(SV) <= 0 m -> G[4, 4] s(SV) <= 15.9 m",
    "assuming motion: G F[0, 3 s] v_lon(SV) > 9 m/s -> F G[0, 1 s] v_lon(SV) > 2 m/s",
)


@pytest.mark.parametrize("claim", UNKNOWN)
def test_the_remedy_of_a_claim_that_ends_unknown_changes_the_answer(claim, capsys):
    given = ("--effort", "5", "--jobs", "1")
    entry = ask(claim, (*given, "--no-drive"), capsys)
    assert entry["verdict"] == "UNKNOWN"
    doubt = entry["doubt"]
    assert not doubt["effort_helps"]
    remedy = Remedy(doubt["remedy"], tuple(doubt["options"]), doubt["without_assumptions"])
    again = followed(claim, remedy, given, capsys)
    assert again["verdict"] != "UNKNOWN" or (again.get("doubt") or {}).get("cause") != doubt["cause"]


def test_more_work_is_more_work(capsys):
    claim = "assuming motion: scenario_4(SV,POV,L) -> G s(SV) < s(POV) + 9 m"
    entry = ask(claim, ("--effort", "0.1", "--no-drive", "--jobs", "1"), capsys)
    doubt = entry["doubt"]
    assert (doubt["cause"], doubt["options"]) == ("work", ["--effort", "0.4"])
    again = ask(claim, ("--no-drive", "--jobs", "1", *doubt["options"]), capsys)
    assert again["verdict"] != "UNKNOWN" or "0.4 units of work" in again["reason"]


@pytest.mark.parametrize(
    ("cause", "options"),
    [
        (Cause.WORK, ("--effort", "20")),
        (Cause.CLOCK, ("--timeout", "120")),
        (Cause.PROCESS, ("--jobs", "1")),
    ],
)
def test_what_more_work_helps_gets_more_work_or_time_or_a_process_of_its_own(cause, options, capsys):
    doubt = doubtful(CLAIMS[0], cause)
    assert doubt.option is None
    assert doubt.remedy.options == doubt.data.options == options
    assert ask("v_lon(SV) > 9 m/s -> v_lon(SV) > 8 m/s", options, capsys)["verdict"] == "PROVED"


def test_the_seconds_of_a_doubt_are_those_of_the_clock():
    query = read_claim(HOME, CLAIMS[0])
    told = [
        unknown_report(query, (), StopPoint.CLOCK, x, True).remedy.options for x in (Effort(5, 7), Effort(60))
    ]
    assert told == [("--timeout", "28"), ("--timeout", "14400")]


def test_a_claim_whose_process_ended_is_asked_alone(monkeypatch):
    monkeypatch.setattr(Engines, "answer_claim", lambda *_: os._exit(7))
    monkeypatch.setattr(decide, "is_fork_unsafe", lambda: False)
    found, _ = rp.prove("v_lon(SV) > 9 m/s", "v_lon(SV) > 8 m/s", jobs=2, fresh=True).as_data()["verdicts"]
    assert (found["verdict"], found["doubt"]["cause"]) == ("UNKNOWN", "process")
    assert found["doubt"]["options"] == ["--jobs", "1"]


@pytest.mark.parametrize("cause", BY_FORM)
def test_no_remedy_is_named_where_none_is_known(cause):
    """No search for drives reads a number that is given for every value."""
    doubt = doubtful("given x: m/s: v_lon(SV) > x -> F v_lon(SV) < x", cause)
    if doubt.remedy is None:
        assert str(doubt).endswith(f"more work does not help, and {NO_REMEDY}")
        assert (doubt.data.remedy, doubt.data.options) == ("", ())
    else:
        assert str(doubt).endswith(f"more work does not help: {doubt.remedy.text}")


def test_every_option_that_a_reason_names_is_one_of_a_command():
    def every(settings: type[Settings]):
        yield settings
        for other in settings.__subclasses__():
            yield from every(other)

    flags = {x.flag for settings in every(Settings) for x in settings.options().values()}
    assert {y.flag for y in Prove.options().values()} <= flags
    for kind in ReasonKind:
        for flag in re.findall(r"(?<![\w-])--[a-z][a-z-]*", kind.value):
            assert flag in flags, (kind.name, flag)


def test_limits_are_those_of_a_vehicle_that_the_claim_mentions():
    for name in ("SV", "POV", "POV2"):
        query = read_claim(HOME, f"s({name}) <= 0 m -> G[1 s, 1 s] s({name}) <= 9 m")
        assert f"{name}=car" in find_remedy(HOME, query, ("motion",), Cause.FACTS).options


def test_motion_that_is_assumed_is_not_named_again():
    query = read_claim(HOME, CLAIMS[0])
    assert "motion" in find_remedy(HOME, query, (), Cause.FIRST_INSTANT).options
    assert "motion" not in find_remedy(HOME, query, ("motion",), Cause.FIRST_INSTANT).options


def test_limits_that_are_there_are_not_named_again():
    query = read_claim(HOME, "s(SV) <= 0 m -> G[1 s, 1 s] s(SV) <= 9 m")
    found = find_remedy(HOME, query, ("motion", "v_lon(SV) <= 30 m/s"), Cause.FACTS)
    assert "--vehicle" not in found.options


def test_options_of_limits_stand_beside_assuming_motion_in_the_claim(capsys):
    code = main(["prove", CLAIMS[6], "--vehicle", "POV=car", "--jobs", "1", "--effort", "3"])
    assert code in (0, 10, 20)
    assert "requires" not in capsys.readouterr().err
    assert main(["prove", CLAIMS[1], "--vehicle", "POV=car"]) == 2
    assert "assuming motion:" in capsys.readouterr().err
