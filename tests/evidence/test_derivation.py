"""The derived query says no more than the negated claim does, and enough; planted faults are caught."""

import pytest

from evidence.probe import probe
from proving.claims import INVALID, VALID, specification, spelled
from roadproof.evidence import atoms, derivation
from roadproof.evidence.derivation import _Derivation, _join
from roadproof.logic import formula as f

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
