"""Certificates of several kinds go through a file unchanged, and are refused once they are touched."""

import json
import re
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from functools import cache

import pytest

from engine_calls import prove
from evidence.test_drive_file import FILE, LIBRARY
from proving.claims import specification
from rejection import rejection_reason
from roadproof.engines.solve.smt import check_sat
from roadproof.errors import InputError
from roadproof.evidence import derivation, judged
from roadproof.evidence.atoms import Atoms
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import read_certificate, to_json
from roadproof.evidence.certify import certify
from roadproof.evidence.judged import judge_file
from roadproof.evidence.sites import Site, StateLemma
from roadproof.evidence.times import ZERO
from roadproof.library import bind
from roadproof.library.bind import default_values, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Library, Source
from roadproof.runtime.budget import Effort
from roadproof.runtime.package_data import shipped_folder
from roadproof.world.units import UNITS
from tables import read_table

library = bundled_library()
# A template property, one from set to set, one in two directions, and one with a lemma of many cases.
SHIPPED = ("P1-scenario-04-base", "P3-scenario-08-base", "P4-scenario-03-base", "P9-base")
# Lemmas used in time, and lanes with names.
OWN = (
    "G (s(SV) <= s(POV) - length(POV)) -> G[0,minSafe] (s(SV) < s(POV))",
    "(some M in lanes: G inAdjLanes(SV,POV,M)) -> G (some M in lanes: inAdjLanes(SV,POV,M))",
)


@cache
def certificate(name: str) -> Certificate:
    if name in SHIPPED:
        return read_certificate(shipped_folder("proofs") / f"{name}.json")
    made = prove(specification(), name, Effort(10)).certificate
    assert made is not None
    return made


def check(tampered: Certificate) -> str | None:
    return rejection_reason(tampered, library, lambda query: check_sat(query, meter=Effort(20).meter()))


def rederived(changed: Certificate) -> Certificate:
    """``changed`` with the queries that its own claim and instances give: only a solver can object."""
    chosen = library.select(changed.set_name, changed.options)
    query = read_claim(chosen, changed.claim)
    atoms = Atoms()
    goal = atoms.abstract(query.formula)
    bounds = {name: p.bound for name, p in library.parameters.items()}
    names, instances = dict(changed.names), dict(changed.instances)
    for _ in range(5):
        walk = derivation._new_derivation(goal, atoms, instances, names, bounds, query.lanes)
        with suppress(InputError):
            walk.truth(goal, False, ZERO)
        names = {site: name for site, name in names.items() if site in walk.met_existentials}
        known = {*names.values(), *bounds, *query.lanes}
        instances = {
            site: tuple(text for text in texts if set(re.findall(r"[A-Za-z_]\w*", text)) <= known)
            for site, texts in instances.items()
            if site in walk.met_universals
        }
    return certify(
        chosen,
        read_claim(chosen, changed.claim),
        (instances, names),
        changed.lemmas,
        changed.property,
        changed.scenario,
    )


@pytest.mark.parametrize("name", [*SHIPPED, *OWN])
def test_a_certificate_goes_through_a_file_and_is_accepted(name, tmp_path):
    path = tmp_path / "certificate.json"
    path.write_text(to_json(certificate(name)), "utf-8")
    assert read_certificate(path) == certificate(name)
    assert check(read_certificate(path)) is None


@pytest.mark.parametrize("name", SHIPPED)
def test_cvc5_accepts_it_too(name):
    pytest.importorskip("cvc5", reason="cvc5 is not installed: pip install cvc5")
    assert (
        rejection_reason(
            certificate(name), library, lambda query: check_sat(query, "cvc5", Effort(20).meter())
        )
        is None
    )


def with_one_instance_less(whole: Certificate):
    for site, texts in whole.instances.items():
        for text in texts:
            left = tuple(other for other in texts if other != text)
            yield replace(whole, instances={**whole.instances, site: left})


@pytest.mark.parametrize("name", ["P1-scenario-04-base", "P3-scenario-08-base", *OWN])
def test_each_instance_is_needed(name):
    changed = list(with_one_instance_less(certificate(name)))
    assert changed
    for shorter in changed:
        assert check(shorter) is not None
        assert "answered sat" in check(rederived(shorter))


@pytest.mark.parametrize("name", ["P4-scenario-03-base"])
def test_a_missing_instance_is_noticed(name):
    for shorter in with_one_instance_less(certificate(name)):
        assert check(shorter) is not None


def test_a_missing_lemma_is_noticed():
    whole = certificate(OWN[0])
    assert whole.lemmas
    for place in range(len(whole.lemmas)):
        shorter = replace(whole, lemmas=whole.lemmas[:place] + whole.lemmas[place + 1 :])
        assert "not the one" in check(shorter)
        assert "answered sat" in check(rederived(shorter))


@pytest.mark.parametrize("name", [OWN[0], "P9-base"])
def test_a_lemma_that_does_not_always_hold_is_noticed(name):
    whole = certificate(name)
    for place, lemma in enumerate(whole.lemmas):
        for turned in range(len(lemma.literals)):
            literals = tuple((n, p != (k == turned)) for k, (n, p) in enumerate(lemma.literals))
            wrong = (*whole.lemmas[:place], StateLemma(literals, lemma.moments), *whole.lemmas[place + 1 :])
            altered = replace(whole, lemmas=wrong)
            assert "not the one" in check(altered)
            assert "answered" in check(rederived(altered))


def test_an_invented_lemma_proves_nothing():
    claim = "fasterThan(SV,POV) -> fasterThan(POV,SV)"
    faster, slower = "fasterThan(SV, POV)", "fasterThan(POV, SV)"
    invented = StateLemma(((faster, False), (slower, True)), ("0",))
    forged = certify(specification(), read_claim(specification(), claim), ({}, {}), (invented,))
    assert check_sat(forged.queries[0][1]) == "unsat"
    assert "'lemma 1, case 1 of 1' was answered sat" in check(forged)
    empty = certify(specification(), read_claim(specification(), claim), ({}, {}), (StateLemma((), ("0",)),))
    assert "lemma 1" in check(empty)


CLAIM = "scenario_4(SV,POV,L) -> dangerArises(SV,POV)"
ALTERED = read_table(__file__, "altered")


@pytest.mark.parametrize("claim", ALTERED)
def test_an_altered_claim_is_noticed(claim):
    assert check(replace(certificate(SHIPPED[0]), claim=claim)) is not None


def test_an_altered_bound_is_noticed_by_the_solver():
    claim = "G[0,minSafe] {0} -> F[0,minSafe] {0}".format("atLane(SV,L)")
    whole = prove(specification(), claim, Effort(5)).certificate
    narrow = claim.replace("F[0,minSafe]", "F[minSafe,minDanger]")
    texts = {
        site: site.formula.replace("F [0, minSafe]", "F [minSafe, minDanger]") for site in whole.instances
    }
    sites = {s: replace(s, formula=texts[s]) for s in whole.instances}
    altered = replace(whole, claim=narrow, instances={sites[s]: t for s, t in whole.instances.items()})
    assert check(whole) is None
    assert "answered sat" in check(rederived(altered))


CHANGES = {
    "set": lambda c: replace(c, set_name="extA"),
    "unknown set": lambda c: replace(c, set_name="extZ"),
    "option": lambda c: replace(c, options={**c.options, "rss_form": "robust"}),
    "unknown option": lambda c: replace(c, options={**c.options, "lateral": "none"}),
    "assumption removed": lambda c: replace(c, assumptions=c.assumptions[1:]),
    "assumption added": lambda c: replace(c, assumptions=(*c.assumptions, "minSafe > minDanger")),
    "no instances": lambda c: replace(c, instances={}),
    "no names": lambda c: replace(c, names={}),
    "no queries": lambda c: replace(c, queries=()),
    "another query": lambda c: replace(c, queries=(("claim", "(assert false)\n(check-sat)\n"),)),
    "one more query": lambda c: replace(c, queries=(*c.queries, c.queries[0])),
    "names swapped": lambda c: replace(
        c, names=dict(zip(c.names, [*list(c.names.values())[1:], next(iter(c.names.values()))], strict=True))
    ),
    "one name for all": lambda c: replace(c, names=dict.fromkeys(c.names, "t1")),
    "an instance of no quantifier": lambda c: replace(
        c, instances={**c.instances, Site("(F [0, inf] |atLane(SV, L)|)", False, "0"): ("0",)}
    ),
    "an instance at another moment": lambda c: replace(
        c, instances={replace(site, moment="minSafe + 1"): texts for site, texts in c.instances.items()}
    ),
    "an instance at an unknown time": lambda c: replace(
        c, instances={site: (*texts, "t99") for site, texts in c.instances.items()}
    ),
    "an instance that is no moment": lambda c: replace(
        c, instances=dict.fromkeys(c.instances, ("(assert false)",))
    ),
    "a division by zero": lambda c: replace(c, instances=dict.fromkeys(c.instances, ("1/0",))),
    "a number of many digits": lambda c: replace(c, instances=dict.fromkeys(c.instances, ("1" * 5000,))),
    "an instance of an existential": lambda c: replace(
        c, instances={**c.instances, **dict.fromkeys(c.names, ("0",))}
    ),
    "a name for a universal": lambda c: replace(
        c, names={**c.names, **{site: f"t{90 + k}" for k, site in enumerate(c.instances)}}
    ),
    "a lemma over no atom": lambda c: replace(c, lemmas=(StateLemma((("atLane(SV, L9)", True),), ("0",)),)),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
def test_a_change_is_noticed(change):
    whole = certificate(SHIPPED[0])
    assert change(whole) != whole
    assert check(change(whole)) is not None


def test_a_refusal_says_what_should_stand_there_and_what_does():
    whole = certificate(SHIPPED[0])
    derived = ", ".join(whole.assumptions)
    told = check(replace(whole, assumptions=("minSafe > minDanger",)))
    assert told == f"the assumptions are {derived}, not minSafe > minDanger"


# --- false claims with forged certificates -------------------------------------------------------


def forge(claim: str, names: list[tuple[Site, str]], instances: list[tuple[Site, str]]) -> str | None:
    """Why a forged certificate is refused, be it when it is made or when it is checked."""
    listed: dict[Site, tuple[str, ...]] = {}
    for site, text in instances:
        listed[site] = (*listed.get(site, ()), text)
    try:
        return check(certify(specification(), read_claim(specification(), claim), (listed, dict(names)), ()))
    except InputError as error:
        return str(error)


SV_IN, POV_IN = "|atLane(SV, L)|", "|atLane(POV, L)|"
F_SV, F_POV = f"(F [0, inf] {SV_IN})", f"(F [0, inf] {POV_IN})"
F_BOTH = f"(F [0, inf] (and {SV_IN} {POV_IN}))"
MEET = "F atLane(SV,L) and F atLane(POV,L) -> F (atLane(SV,L) and atLane(POV,L))"


@pytest.mark.parametrize("one", ["u1_", "u2_", "t1"])
@pytest.mark.parametrize("other", ["u1_", "u2_", "t1", None])
def test_two_existentials_are_never_the_same_moment(one, other):
    names = [(Site(F_SV, True, "0"), one)] + ([] if other is None else [(Site(F_POV, True, "0"), other)])
    moments = dict.fromkeys(["u1_", "u2_", "t1"])
    for moment in moments:
        assert forge(MEET, names, [(Site(F_BOTH, False, "0"), moment)]) is not None


@pytest.mark.parametrize("name", ["minSafe", "minDanger", "0", "-1", "t1 + t2", "q1", "let", "true", "T", ""])
def test_a_named_time_is_new(name):
    claim = "F atLane(SV,L) -> F[minSafe,minSafe] atLane(SV,L)"
    site = Site(f"(F [minSafe, minSafe] {SV_IN})", False, "0")
    assert forge(claim, [(Site(F_SV, True, "0"), name)], [(site, "minSafe")]) is not None


ESCAPES = [
    "t1 Real)(assert false)(check-sat)(exit)(declare-const t2",
    "x| (Real) Bool)(assert false)(check-sat)(exit)",
    "t1 Real)\n(assert false)\n(check-sat)\n(exit)\n;",
    "M| Bool)(assert false)(check-sat)(exit)",
    "t1\n",
]


@pytest.mark.parametrize("text", ESCAPES)
def test_nothing_of_a_certificate_is_read_as_commands(text):
    road = "(some M in lanes: atLane(SV, M))"
    assert forge("F atLane(SV,L)", [], [(Site(F_SV, False, "0"), text)]) is not None
    assert forge("not F atLane(SV,L)", [(Site(F_SV, True, "0"), text)], []) is not None
    assert forge("some M in lanes: atLane(SV,M)", [], [(Site(road, False, "0"), text)]) is not None
    assert forge("not (some M in lanes: atLane(SV,M))", [(Site(road, True, "0"), text)], []) is not None
    near = "(some M in adjacentLanes(L): atLane(SV, M))"
    assert forge("some M in adjacentLanes(L): atLane(SV,M)", [], [(Site(near, False, "0"), text)]) is not None


@pytest.mark.parametrize("name", ["L", "M", "M1", "L1"])
def test_a_named_lane_is_new(name):
    claim = "(some M in adjacentLanes(L): atLane(SV,M)) -> atLane(SV,L)"
    site = Site("(some M in adjacentLanes(L): atLane(SV, M))", True, "0")
    assert forge(claim, [(site, name)], []) is not None


def test_a_road_may_have_no_lane():
    claim = "(every M in lanes: atLane(SV,M)) -> (some M in lanes: atLane(SV,M))"
    every = Site("(every M in lanes: atLane(SV, M))", True, "0")
    some = Site("(some M in lanes: atLane(SV, M))", False, "0")
    assert forge(claim, [], [(every, "K"), (some, "K")]) is not None


# --- damaged files -------------------------------------------------------------------------------


def write(tmp_path, text: str | bytes):
    path = tmp_path / "damaged.json"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def whole_text() -> str:
    return to_json(certificate(SHIPPED[0]))


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "null",
        "[]",
        "{}",
        '"roadproof/certificate/1"',
        b"\xff\xfe\x00",
        "[" * 100_000,
        '{"a":' * 50_000,
        "1" * 10_000,
        '{"schema": "roadproof/certificate/1"}',
        '{"schema": "roadproof/certificate/2"}',
        '{"schema": "roadproof/drive/1"}',
    ],
    ids=lambda text: repr(text[:20]),
)
def test_what_is_no_certificate_is_refused(text, tmp_path):
    with pytest.raises(InputError):
        read_certificate(write(tmp_path, text))


def test_a_folder_or_nothing_is_refused(tmp_path):
    for path in (tmp_path, tmp_path / "missing.json"):
        with pytest.raises(InputError):
            read_certificate(path)


@pytest.mark.parametrize("share", range(1, 20))
def test_a_truncated_file_is_refused(share, tmp_path):
    text = whole_text()
    with pytest.raises(InputError):
        read_certificate(write(tmp_path, text[: len(text) * share // 20]))


WRONG = [None, True, 7, -1, 1e400, "text", "", [], [1], ["a", "b"], [[[]]], {}, {"a": 1}]


@pytest.mark.parametrize(
    "key", ["view", "claim", "set", "options", "assumptions", "formulas", "times", "instances", "queries"]
)
def test_a_field_of_another_kind_is_refused(key, tmp_path):
    data = json.loads(whole_text())
    for value in [*WRONG, ...]:
        changed = {k: v for k, v in data.items() if k != key} if value is ... else {**data, key: value}
        try:
            read = read_certificate(write(tmp_path, json.dumps(changed)))
        except InputError:
            continue
        assert check(read) is not None, value


@pytest.mark.parametrize("key", ["lemmas", "scenario", "property"])
def test_a_label_of_another_kind_leads_to_no_traceback(key, tmp_path):
    data = json.loads(whole_text())
    for value in WRONG:
        try:
            read = read_certificate(write(tmp_path, json.dumps({**data, key: value})))
        except InputError:
            continue
        check(read)


# --- The values that a drive is judged with: those of its file, within their bounds and in their units

# The declared values in other units than SI; 130 km/h are 36 1/9 m/s.
MINE = """
param limit = 130 km/h where limit > 0 "as signs say"
param blink = 500 ms where blink >= 0 "as eyes do"
def slow(a: vehicle) := v_lon(a) < limit
def soon(a: vehicle) := F[0, blink] v_lon(a) < 29.6 m/s
"""


def mine() -> Library:
    return build_library([Source("mine.spec", MINE)], LIBRARY)


# SV brakes with 1 m/s² from 30 m/s on for 0.6 s.
SPEEDS = [
    ("slow(SV)", {}, True),
    ("slow(SV)", {"limit": 30}, False),
    ("slow(SV)", {"limit": 31}, True),
    ("v_lon(SV) + 7 m/s < limit", {}, False),
    ("soon(SV)", {}, True),
    ("G[0, blink] v_lon(SV) > 29.45 m/s", {}, True),
    ("soon(SV)", {"blink": Fraction(2, 5)}, False),
    ("G[0, minDanger] v_lon(SV) > 29.5 m/s", {"minDanger": Fraction(1, 2)}, False),
    ("G[0, minDanger] v_lon(SV) > 29.5 m/s", {"minDanger": Fraction(2, 5)}, True),
]


def first_wrong() -> str | None:
    for formula, values, expected in SPEEDS:
        given = {name: Fraction(value) for name, value in values.items()}
        file = replace(FILE, formula=formula, values=given, scenario=None)
        if judge_file(file, mine()).accepted is not expected:
            return f"{formula} with {values}"
    return None


def test_a_drive_is_judged_with_the_values_of_its_file_in_their_units() -> None:
    assert first_wrong() is None
    assert default_values(mine())["limit"] == Fraction(325, 9)
    assert default_values(mine())["blink"] == Fraction(1, 2)


def without_units(monkeypatch: pytest.MonkeyPatch) -> None:
    """The unit of a declared parameter is ignored."""
    monkeypatch.setattr(bind, "UNITS", {unit: (Fraction(1), x) for unit, (_, x) in UNITS.items()})


def declared_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """The values of a drive file are ignored."""
    monkeypatch.setattr(judged, "values_with", lambda library, given: default_values(library))


def file_only_where_undeclared(monkeypatch: pytest.MonkeyPatch) -> None:
    """The declared values come after those of the file."""
    monkeypatch.setattr(judged, "values_with", lambda library, given: {**given, **default_values(library)})


def first_value_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """A value of the file is taken for the declared one in its own unit."""
    monkeypatch.setattr(
        judged,
        "values_with",
        lambda library, given: {
            **default_values(library),
            **{n: v * UNITS[library.parameters[n].unit][0] for n, v in given.items()},
        },
    )


@pytest.mark.parametrize(
    "fault",
    [without_units, declared_only, file_only_where_undeclared, first_value_only],
    ids=lambda fault: fault.__name__,
)
def test_a_planted_fault_is_caught(fault, monkeypatch) -> None:
    fault(monkeypatch)
    assert first_wrong() is not None


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"rho": -3}, r"rho=-3: iso34502.spec, line \d+, column 1: the library demands rho >= 0"),
        ({"b_max": -8}, r"b_max=-8: iso34502.spec, line \d+, column 1: the library demands b_max > 0"),
        ({"b_max": 0}, "the library demands b_max > 0"),
        ({"bmax": 8}, "there is no parameter 'bmax'; did you mean 'b_max'"),
    ],
)
def test_values_out_of_bounds_and_unknown_names_are_refused(values, message) -> None:
    given = {name: Fraction(value) for name, value in values.items()}
    with pytest.raises(InputError, match=message):
        values_with(LIBRARY, given)
    ruling = judge_file(replace(FILE, values={**FILE.values, **given}), LIBRARY)
    assert not ruling.accepted
    assert next(iter(values)) in ruling.reason


def test_a_value_at_its_bound_is_accepted() -> None:
    assert values_with(LIBRARY, {"rho": Fraction(0)})["rho"] == 0
