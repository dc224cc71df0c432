"""The derived query says no more than the negated claim does, and enough; planted faults are caught."""

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

import pytest

import roadproof as rp
from evidence.folders import check, code, read, some_proofs, write
from evidence.probe import probe
from proving.claims import INVALID, VALID, specification, spelled
from roadproof.errors import InputError
from roadproof.evidence import atoms, derivation
from roadproof.evidence.answers.drive import MOST_INSTANTS
from roadproof.evidence.countermodel import Countermodel, Instant, Loop, read_trace, trace_data
from roadproof.evidence.derivation import _Derivation, _join
from roadproof.evidence.finding import NO_EVIDENCE
from roadproof.evidence.heading import heading
from roadproof.evidence.periodic import judge_periodic, unroll
from roadproof.evidence.refutation import fault_of
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Library, Source
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.questions.checking import OTHER_LIBRARY
from roadproof.questions.question import QUESTION
from roadproof.semantics.exact import judge
from roadproof.semantics.exact.truth import from_switches, interval
from roadproof.world.road import Lanelet, Road, adjacency

STATE_ONLY = ("given", "aheadOf", "dangerLeft", "F (v_lon", "G (s(SV)")  # these need lemmas
SLOW = "(p U[1,2] q) <-> F[1,1] (p U[0,1] q)"


@pytest.mark.parametrize("claim", INVALID)
def test_no_instances_prove_a_claim_that_is_false(claim):
    assert probe(specification(), spelled(claim)) in ("sat", "unknown")


@pytest.mark.parametrize("claim", [c for c in VALID if not c.startswith(STATE_ONLY) and c != SLOW])
def test_instances_at_all_moments_prove_what_is_valid_over_time(claim):
    """Else the probe would be too weak to show anything."""
    assert probe(specification(), spelled(claim)) == "unsat"


# --- planted faults ------------------------------------------------------------------------------

true_less, true_fails, true_expand = _Derivation._less, _Derivation._until_fails, _Derivation._expand
true_universal, true_literal, true_rename = _Derivation._universal, _Derivation.literal, atoms.rename
true_name = _Derivation._name


def phi_at_the_end(monkeypatch):
    """φ U ψ asks for φ also when ψ comes."""
    monkeypatch.setattr(_Derivation, "_less", _Derivation._at_most)


def failing_at_the_end(monkeypatch):
    """¬(φ U ψ) may have φ fail only when ψ comes."""
    inside = []

    def fails(self, *args):
        inside.append(True)
        try:
            return true_fails(self, *args)
        finally:
            inside.pop()

    monkeypatch.setattr(_Derivation, "_until_fails", fails)
    monkeypatch.setattr(
        _Derivation,
        "_less",
        lambda self, x, y: self._at_most(x, y) if inside else true_less(self, x, y),
    )


def classic_until(monkeypatch):
    """φ is asked for from 0 on."""

    def expand(self, formula, positive, moment):
        known = true_expand(self, formula, positive, moment)
        if not isinstance(formula, f.Until) or not positive or formula.interval.low == f.ZERO:
            return known
        early = f.Always(f.Interval(f.ZERO, formula.interval.low), formula.left)
        return f"(and {known} {self.truth(early, True, moment)})"

    monkeypatch.setattr(_Derivation, "_expand", expand)


def open_window(monkeypatch):
    """The upper end of a window is forgotten."""
    monkeypatch.setattr(
        _Derivation,
        "_within",
        lambda self, start, interval, when: [self._at_most(start + derivation.moment_of(interval.low), when)],
    )


def window_from_now(monkeypatch):
    """The lower end of a window is taken for 0."""

    def within(self, start, interval, when):
        high = (
            []
            if interval.high is None
            else [self._at_most(when, start + derivation.moment_of(interval.high))]
        )
        return [self._at_most(start, when), *high]

    monkeypatch.setattr(_Derivation, "_within", within)


def window_one_short(monkeypatch):
    """The end of a window is left out."""

    def within(self, start, interval, when):
        low = self._at_most(start + derivation.moment_of(interval.low), when)
        if interval.high is None:
            return [low]
        return [low, self._less(when, start + derivation.moment_of(interval.high))]

    monkeypatch.setattr(_Derivation, "_within", within)


def swapped_operators(monkeypatch):
    """F is read as G, and G as F."""

    def expand(self, formula, positive, moment):
        match formula:
            case f.Eventually(interval, body):
                formula = f.Always(interval, body)
            case f.Always(interval, body):
                formula = f.Eventually(interval, body)
        return true_expand(self, formula, positive, moment)

    monkeypatch.setattr(_Derivation, "_expand", expand)


def shared_name(monkeypatch):
    """One name for the existentials of all formulas."""

    def name(self, site):
        true_name(self, site)
        return "M1" if site.formula.startswith(("(some", "(every")) else "t1"

    monkeypatch.setattr(_Derivation, "_name", name)


def shared_between_moments(monkeypatch):
    """One name for the existentials of a formula at all moments."""

    def name(self, site):
        own = true_name(self, site)
        self.times.append(own)
        alike = [n for s, n in self.names.items() if (s.formula, s.positive) == (site.formula, site.positive)]
        return min(alike, default=own)

    monkeypatch.setattr(_Derivation, "_name", name)


def no_guard(monkeypatch):
    """A universal holds outside its window, too."""
    monkeypatch.setattr(
        _Derivation,
        "_universal",
        lambda self, site, instance: true_universal(self, site, lambda when: ([], instance(when)[1])),
    )


def no_membership(monkeypatch):
    """What holds for the neighbours of a lane holds for all lanes."""
    monkeypatch.setattr(_Derivation, "_fact", lambda self, domain, element: "true")


def frozen_atoms(monkeypatch):
    """Every atom is read at time 0."""
    monkeypatch.setattr(
        _Derivation,
        "literal",
        lambda self, name, positive, moment: true_literal(self, name, positive, derivation.ZERO),
    )


def negation_lost(monkeypatch):
    monkeypatch.setattr(
        _Derivation, "literal", lambda self, name, positive, moment: true_literal(self, name, True, moment)
    )


def weak_conjunction(monkeypatch):
    """A conjunction of instances is a disjunction."""
    monkeypatch.setattr(
        derivation, "_join", lambda word, parts: _join("or" if len(parts) == 2 else word, parts)
    )


def capturing_rename(monkeypatch):
    """Renames also what a quantifier inside calls by the old name."""

    def rename(formula, old, new):
        def visit(current):
            match current:
                case f.Occupies(vehicle, lanelet) if lanelet == old:
                    return f.Occupies(vehicle, new)
                case f.Some(variable, domain, body) | f.Every(variable, domain, body) if domain.of == old:
                    return type(current)(variable, f.Domain(domain.kind, new), body)
                case f.Application(name, arguments, body):
                    return f.Application(name, tuple(new if a == old else a for a in arguments), body)
            return current

        return f.transform(formula, visit)

    monkeypatch.setattr(derivation, "rename", rename)


FAULTS = [
    phi_at_the_end,
    failing_at_the_end,
    classic_until,
    open_window,
    window_from_now,
    window_one_short,
    swapped_operators,
    shared_name,
    shared_between_moments,
    no_guard,
    no_membership,
    frozen_atoms,
    negation_lost,
    weak_conjunction,
    capturing_rename,
]


def first_disagreement() -> str | None:
    for claim in INVALID:
        if probe(specification(), spelled(claim), 0.5) == "unsat":
            return claim
    for claim in VALID:
        wanted = not claim.startswith(STATE_ONLY) and claim != SLOW
        if wanted and probe(specification(), spelled(claim), 0.5) == "sat":
            return claim
    return None


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_a_planted_fault_is_caught(fault, monkeypatch):
    fault(monkeypatch)
    assert first_disagreement() is not None


# --- A countermodel is judged from its numbers and its road alone -----------------------------------

SPECIFICATION = bundled_library().select("base")
CLAIM = read_claim(SPECIFICATION, "given v: m/s: atLane(SV,L) -> F[0,minSafe] v_lon(SV) > v").formula


def number(text: str | int) -> Fraction:
    return Fraction(text)


def lanelet(name: str, lane: str, low: int, high: int, right: int) -> Lanelet:
    s, d = (number(low), number(high)), (number(right), number(right + 3))
    return Lanelet(name, lane, "main", "main", s, d)


ROAD = Road("r", (lanelet("a", "L", 0, 50, 0), lanelet("b", "K", 0, 50, 3)), adjacency([("L", "K")]))
STATE = {name: number(x) for name, x in {"s(SV)": 9, "d(SV)": 2, "v_lon(SV)": 5, "v": 5}.items()}
STATE |= {"length(SV)": number(4), "width(SV)": number(2)}
FASTER = STATE | {"v_lon(SV)": number(6)}
FOUND = Countermodel(
    (Instant(number(0), STATE, {}), Instant(number(1), FASTER, {})),
    {"minSafe": number("3/5")},
    "before",
    ROAD,
)


def fault(found: Countermodel) -> str | None:
    return fault_of(found, CLAIM, SPECIFICATION.library.bounds)


def with_road(*lanelets: Lanelet, beside: tuple[tuple[str, str], ...] = ()) -> Countermodel:
    return replace(FOUND, road=Road("r", lanelets, adjacency(beside)))


def with_first(**values: int) -> Countermodel:
    changed = STATE | {f"{name}(SV)" if name != "v" else name: number(x) for name, x in values.items()}
    return replace(FOUND, instants=(Instant(number(0), changed, {}), *FOUND.instants[1:]))


def test_a_countermodel():
    assert fault(FOUND) is None


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        (replace(FOUND, parameters={"minSafe": number(-1)}), "declared minSafe >= 0"),
        (replace(FOUND, parameters={"minSafe": number(1)}), "true on it"),
        (replace(FOUND, parameters={}), "still holds a parameter"),
        (replace(FOUND, interpolation="after"), "true on it"),
        (replace(FOUND, instants=FOUND.instants[1:]), "ascend from 0"),
        (replace(FOUND, instants=FOUND.instants[::-1]), "ascend from 0"),
        (replace(FOUND, instants=()), "ascend from 0"),
        (with_first(length=5), "length, width or kind changes"),
        (replace(with_first(width=0), instants=with_first(width=0).instants[:1]), "not greater than 0"),
        (with_first(d=9), "true on it"),
        (with_first(v=4), "true on it"),
        (replace(FOUND, road=None), "L"),
        (with_road(lanelet("a", "K", 0, 50, 0)), "L"),
        (with_road(lanelet("a", "L", 0, 50, 0), lanelet("a", "K", 0, 50, 9)), "given twice"),
        (with_road(lanelet("a", "L", 0, 50, 0), lanelet("b", "L", 60, 90, 0)), "does not begin where"),
        (with_road(*ROAD.lanelets), "share a boundary"),
        (with_road(lanelet("a", "L", 0, 50, 0), lanelet("b", "K", 0, 50, 9), beside=(("L", "K"),)), "share"),
    ],
)
def test_what_is_none(changed, said):
    assert said in str(fault(changed))


@pytest.mark.parametrize("road", [ROAD, None])
def test_a_trace_goes_through_plain_data(road):
    plain = trace_data(replace(FOUND, road=road))
    assert read_trace(plain, "here") == replace(FOUND, road=road)
    assert (plain["road"] is None) == (road is None)


def test_a_trace_of_too_many_instants_is_refused():
    plain = trace_data(FOUND)
    with pytest.raises(InputError, match=f"more than {MOST_INSTANTS} instants"):
        read_trace({**plain, "instants": plain["instants"][:1] * (MOST_INSTANTS + 1)}, "here")


def test_a_drive_is_no_trace():
    with pytest.raises(InputError, match="a drive is a file beside the index"):
        read_trace({"kind": "drive"}, "here")


# --- Truth on traces that repeat themselves, against the ordinary judge on the same traces written out

ATOMS = [f.Compare(t.Signal("v_lon", name), "<", t.number(0, (1, -1))) for name in ("A", "B")]


def formula(random, depth):
    if depth == 0 or random.random() < 0.15:
        return random.choice([*ATOMS, f.TRUE, f.FALSE])
    low = Fraction(random.randrange(4), 2)
    high = None if random.random() < 0.4 else low + Fraction(random.randrange(12), 2)
    window = f.Interval(t.number(low, (0, 1)), None if high is None else t.number(high, (0, 1)))
    one, other = (formula(random, depth - 1) for _ in range(2))
    return random.choice(
        [
            f.Not(one),
            f.And((one, other)),
            f.Or((one, other)),
            f.Eventually(window, one),
            f.Always(window, one),
            f.Until(one, window, other),
        ]
    )


def truths(random, times):
    return from_switches((time, random.random() < 0.5, random.random() < 0.5) for time in times)


@pytest.mark.parametrize("seed", range(300))
def test_as_the_ordinary_judge_on_the_trace_written_out(seed):
    """Written out over more rounds than nested operators can tell apart, and compared before they end."""
    random = Random(seed)
    prefix = Fraction(random.randrange(3), 2)
    loop = Loop(prefix, Fraction(random.randrange(1, 5), 2))
    times = [x for x in (Fraction(k, 2) for k in range(8)) if x < loop.end]
    given = {atom: truths(random, times) for atom in ATOMS}
    asked = formula(random, 2)
    written_out = {atom: unroll(truth, loop, Fraction(60)) for atom, truth in given.items()}
    expected = judge(asked, None, written_out).truth(asked)
    found = judge_periodic(asked, given, loop)
    points = [Fraction(k, 4) for k in range(int(4 * loop.end))]
    if all(x.high is not None for y in f.subformulas(asked) for x in f.intervals(y)):
        assert [found.at(x) for x in points] == [expected.at(x) for x in points]
    else:  # for ever is not 60 s: some suffix is asked for that the written-out trace does not have
        assert [found.at(x) for x in points] == [for_ever(asked, written_out).at(x) for x in points]


def for_ever(asked, written_out):
    """Unbounded operators look 12 s ahead, which is more than prefix and round."""

    def bounded(current):
        match current:
            case f.Eventually(window, body) | f.Always(window, body) if window.high is None:
                return type(current)(cut(window), body)
            case f.Until(left, window, right) if window.high is None:
                return f.Until(left, cut(window), right)
            case _:
                return current

    def cut(window):
        low = t.constant_value(window.low)
        return f.Interval(window.low, t.number(low + 12, (0, 1)))

    made = f.transform(asked, bounded)
    return judge(made, None, written_out).truth(made)


def test_an_alternation_that_never_ends():
    loop = Loop(Fraction(0), Fraction(2))
    given = {ATOMS[0]: interval(Fraction(0), Fraction(1), "[)")}
    again_and_again = f.Always(f.FOREVER, f.Eventually(f.FOREVER, ATOMS[0]))
    in_the_end = f.Eventually(f.FOREVER, f.Always(f.FOREVER, ATOMS[0]))
    assert judge_periodic(again_and_again, given, loop).at(Fraction(0))
    assert not judge_periodic(in_the_end, given, loop).at(Fraction(0))


def test_too_many_rounds_are_refused():
    window = f.Interval(t.number(10_000, (0, 1)), None)
    with pytest.raises(InputError, match="rounds"):
        judge_periodic(
            f.Eventually(window, ATOMS[0]),
            {ATOMS[0]: interval(Fraction(0), None)},
            Loop(*map(Fraction, (0, 1))),
        )


# --- How answers begin: the version, and a fingerprint of the library, in indices too, where it is checked


def with_text(text: str) -> Library:
    return build_library([Source("mine.spec", text)], bundled_library())


def test_the_heading_names_version_and_library() -> None:
    told = heading("roadproof/any/1", bundled_library())
    assert [*told] == ["schema", "roadproof", "library"]
    assert told == {
        "schema": "roadproof/any/1",
        "roadproof": rp.__version__,
        "library": bundled_library().fingerprint,
    }


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("# a remark\n", True),
        ("def mine(a: vehicle) := true", False),
        ("param rho = 1 s where rho >= 0", False),
        ("option lateral_sign = literal | rss", False),
        ("set mine extends base { def danger(a, b: vehicle) := true }", False),
    ],
)
def test_the_fingerprint_is_that_of_what_is_declared(text: str, same: bool) -> None:
    assert (with_text(text).fingerprint == bundled_library().fingerprint) == same


def test_the_fingerprint_is_not_that_of_places() -> None:
    text = "def mine(a: vehicle) := v_lon(a) > 0 m/s"
    moved = f"\n# a remark\n\n  {text}\n"
    assert with_text(text).fingerprint == with_text(moved).fingerprint


def heads() -> dict[str, Any]:
    return {"roadproof": rp.__version__, "library": bundled_library().fingerprint}


def test_another_library_is_told_and_no_reason_to_reject(tmp_path: Path) -> None:
    folder = some_proofs(tmp_path / "proofs")
    index = read(folder / QUESTION)
    write(folder / QUESTION, {**index, **heads(), "library": "0" * 16})
    assert code(folder) == 0
    found = check(folder)
    assert all(OTHER_LIBRARY in x.unchecked for x in found if x.kind != NO_EVIDENCE)
    assert "not checked" in str(found[0])


@pytest.mark.parametrize(
    "library", [None, 7, True, [], {}, "", "0" * 15, "0" * 17, "G" * 16, "0" * 15 + "\n"]
)
def test_a_fingerprint_of_another_kind_is_refused(library: object, tmp_path: Path) -> None:
    folder = some_proofs(tmp_path / "proofs")
    write(folder / QUESTION, {**read(folder / QUESTION), "library": library})
    assert code(folder) == 10
    assert any("library" in x.reason for x in check(folder))


@pytest.mark.parametrize("version", [None, 7, [], {}])
def test_a_version_of_another_kind_is_refused(version: object, tmp_path: Path) -> None:
    folder = some_proofs(tmp_path / "proofs")
    write(folder / QUESTION, {**read(folder / QUESTION), "roadproof": version})
    assert code(folder) == 10


def test_planted_fingerprints_that_are_not_compared_are_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.questions.checking.library_of", lambda data: bundled_library().fingerprint)
    with pytest.raises(AssertionError):
        test_another_library_is_told_and_no_reason_to_reject(tmp_path)


def test_the_folder_of_prove_says_both(tmp_path: Path) -> None:
    rp.prove("danger(SV,POV) -> danger(SV,POV)", jobs=1).save(tmp_path / "out")
    index = json.loads((tmp_path / "out" / QUESTION).read_text("utf-8"))
    assert {name: index[name] for name in heads()} == heads()
