"""The ground query of a certificate, derived from the claim and a list of instances alone.

The negated claim is read as a first-order sentence over real time (predicates as functions of
time). Every existential gets a name of its own; every universal is replaced by the conjunction of
its listed instances. Both steps only weaken the sentence, so when the result is unsatisfiable,
the negated claim is, and the claim is valid on all traces (Herbrand). Lemmas are clauses that hold
at every instant; each has a query of its own, about one instant, that must be unsatisfiable too.
"""

import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms, is_rigid
from roadproof.evidence.cases import split
from roadproof.evidence.road_axioms import membership, true_of_roads
from roadproof.evidence.sites import Lemma, Site, prefix_form
from roadproof.evidence.times import (
    ZERO,
    Moment,
    at,
    bound_parameters,
    compared_times,
    constant,
    moment_of,
    read_moment,
)
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import rename, road_names

_NEW_NAME = re.compile(r"[tM]_*[0-9]{1,9}", re.ASCII)

# What an instance says at a moment: its guards, and the body that they guard.
Instance: TypeAlias = Callable[[Moment], tuple[list[str], str]]


def derive_query(
    claim: Formula,
    atoms: Atoms,
    instances: Mapping[Site, Sequence[str]],
    names: Mapping[Site, str],
    lemmas: Sequence[Lemma],
    bounds: Mapping[str, str],
    lanes: Collection[str] = (),
) -> str:
    """SMT-LIB script that is unsatisfiable only if ``claim``, abstracted by ``atoms``, is valid at time 0.

    ``instances`` lists for each universal the moments (or lanes) to try; ``names`` calls the
    existentials that instances speak of; ``lanes`` are the claim's own. Raises ``InputError`` where an
    instance or a name belongs to no quantifier that the claim meets, and where a name is not new.
    """
    derivation = _start(claim, atoms, instances, names, bounds, lanes)
    goal = derivation.truth(claim, False, ZERO)
    clauses = [
        _join("or", [derivation.literal(name, positive, moment) for name, positive in lemma.literals])
        for lemma in lemmas
        for moment in map(read_moment, lemma.moments)
    ]
    derivation.refuse_strangers()
    return "\n".join(
        [
            "(set-logic QF_UFLRA)",
            *derivation.declarations(bounds),
            *derivation.definitions,
            f"(assert {goal})",
            *(f"(assert {clause})" for clause in clauses),
            "(check-sat)",
            "",
        ]
    )


def met_sites(
    claim: Formula,
    atoms: Atoms,
    instances: Mapping[Site, Sequence[str]],
    names: Mapping[Site, str],
    bounds: Mapping[str, str],
    lanes: Collection[str],
) -> tuple[dict[Site, tuple[str, ...]], dict[Site, str]]:
    """The entries of ``instances``, and of ``names``, whose quantifier is met when only these are made."""
    derivation = _start(claim, atoms, instances, names, bounds, lanes)
    derivation.truth(claim, False, ZERO)
    met = {site: tuple(texts) for site, texts in instances.items() if site in derivation.instanced}
    return met, {site: name for site, name in names.items() if site in derivation.named}


def _start(
    claim: Formula,
    atoms: Atoms,
    instances: Mapping[Site, Sequence[str]],
    names: Mapping[Site, str],
    bounds: Mapping[str, str],
    lanes: Collection[str],
) -> "_Derivation":
    """Refuses names that are not new: an existential that shares one would say too much."""
    taken = {*lanes, *road_names(claim), *bounds}
    for name in names.values():
        if name in taken or not _NEW_NAME.fullmatch(name):
            raise InputError(f"'{name[:60]}' is no new name: times are called t1, t2, …, lanes M1, M2, …")
    if len({*names.values()}) != len(names):
        raise InputError("two existentials of the certificate have the same name")
    elements = frozenset({*lanes, *road_names(claim), *names.values()})
    prefixes = free_prefix("u", taken), free_prefix("q", taken)
    return _Derivation(atoms, instances, names, elements, bound_parameters(claim), *prefixes)


def free_prefix(prefix: str, taken: Collection[str]) -> str:
    """``prefix``, longer by underscores until no name in ``taken`` begins with it."""
    while any(name.startswith(prefix) for name in taken):
        prefix += "_"
    return prefix


def derive_lemma_queries(
    atoms: Atoms, literals: Sequence[tuple[str, bool]], bounds: Mapping[str, str]
) -> list[str]:
    """SMT-LIB scripts about one instant, all unsatisfiable only if the clause always holds.

    There is one for each way in which the maxima and minima of the clause can fall.
    """
    for name, _ in literals:
        if not f.is_state(atoms.meaning(name)):
            raise InputError(f"'{name[:60]}' speaks of several instants, and a lemma of one")
    against = [
        f.negation(atoms.meaning(name)) if positive else atoms.meaning(name) for name, positive in literals
    ]
    return [
        "\n".join(
            [
                "(set-logic QF_NRA)",
                *state.declarations(case, bounds),
                *(f"(assert {state.state(literal)})" for literal in case),
                "(check-sat)",
                "",
            ]
        )
        for case in split(against)
    ]


@dataclass
class _Derivation:
    """``instanced`` and ``named`` are the universals and the existentials met so far.

    ``timing`` are the parameters in interval bounds: comparisons of these are read as what they are.
    """

    known: Atoms
    instances: Mapping[Site, Sequence[str]]
    names: Mapping[Site, str]
    elements: frozenset[str]
    timing: frozenset[str]
    unnamed: str
    defining: str
    definitions: list[str] = field(default_factory=list)
    defined: dict[tuple[Formula, bool, Moment], str] = field(default_factory=dict)
    atoms: set[str] = field(default_factory=set)
    facts: set[tuple[f.Domain, str]] = field(default_factory=set)
    times: list[str] = field(default_factory=list)
    moments: set[str] = field(default_factory=set)
    instanced: set[Site] = field(default_factory=set)
    named: set[Site] = field(default_factory=set)
    fresh: int = 0

    def truth(self, formula: Formula, positive: bool, moment: Moment) -> str:
        """What follows from ``formula`` (or its negation) being true at ``moment``."""
        match formula:
            case f.Truth(value):
                return "true" if value == positive else "false"
            case f.Application(name, _, _):
                return self.literal(name, positive, moment)
            case f.Not(body):
                return self.truth(body, not positive, moment)
            case f.And(parts) | f.Or(parts):
                word = "and" if isinstance(formula, f.And) == positive else "or"
                return _join(word, [self.truth(part, positive, moment) for part in parts])
            case f.Until() | f.Eventually() | f.Always() | f.Some() | f.Every():
                return self._quantifier(formula, positive, moment)
            case f.Compare() | f.Occupies():
                raise ValueError("abstract the formula first")
            case _:
                assert_never(formula)

    def literal(self, name: str, positive: bool, moment: Moment) -> str:
        meaning = self.known.meaning(name)
        times = compared_times(meaning, self.timing)
        if times is not None:
            left, op, right = times
            self.moments |= {part for side in (left, right) for part, _ in side.parts}
            compared = f"({op} {left.smt()} {right.smt()})"
            return compared if positive else f"(not {compared})"
        self.atoms.add(name)
        if is_rigid(meaning):
            moment = ZERO
        self.moments |= {part for part, _ in moment.parts}
        applied = f"(|{name}| {moment.smt()})"
        return applied if positive else f"(not {applied})"

    def _quantifier(
        self, formula: f.Until | f.Eventually | f.Always | f.Some | f.Every, positive: bool, moment: Moment
    ) -> str:
        key = (formula, positive, moment)
        if key not in self.defined:
            body = self._expand(formula, positive, moment)
            self.defined[key] = f"{self.defining}{len(self.definitions) + 1}"
            self.definitions.append(f"(define-fun {self.defined[key]} () Bool {body})")
        return self.defined[key]

    def _expand(
        self, formula: f.Until | f.Eventually | f.Always | f.Some | f.Every, positive: bool, moment: Moment
    ) -> str:
        site = Site(prefix_form(formula), positive, str(moment))
        match formula:
            case f.Eventually(interval, body) | f.Always(interval, body):
                if isinstance(formula, f.Eventually) == positive:
                    when = self._existential(site)
                    return _join(
                        "and", [*self._within(moment, interval, when), self.truth(body, positive, when)]
                    )
                return self._universal(
                    site,
                    lambda when: (self._within(moment, interval, when), self.truth(body, positive, when)),
                )
            case f.Until(left, interval, right) if positive:
                end = self._existential(site)
                before = self._universal(
                    site,
                    lambda when: (
                        [self._at_most(moment + moment_of(interval.low), when), self._less(when, end)],
                        self.truth(left, True, when),
                    ),
                )
                return _join(
                    "and", [*self._within(moment, interval, end), self.truth(right, True, end), before]
                )
            case f.Until():
                return self._universal(site, lambda when: self._until_fails(formula, site, moment, when))
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):
                return self._road_quantifier(formula, site, variable, domain, body, positive, moment)
            case _:
                assert_never(formula)

    def _until_fails(
        self, formula: f.Until, site: Site, moment: Moment, when: Moment
    ) -> tuple[list[str], str]:
        """¬(φ U ψ): at each moment of the window ψ fails, or φ has failed before within it."""
        failed = self._existential(Site(site.formula, False, site.moment, str(when)))
        earlier = _join(
            "and",
            [
                self._at_most(moment + moment_of(formula.interval.low), failed),
                self._less(failed, when),
                self.truth(formula.left, False, failed),
            ],
        )
        guard = self._within(moment, formula.interval, when)
        return guard, _join("or", [self.truth(formula.right, False, when), earlier])

    def _road_quantifier(
        self,
        formula: Formula,
        site: Site,
        variable: str,
        domain: f.Domain,
        body: Formula,
        positive: bool,
        moment: Moment,
    ) -> str:
        def at_element(element: str) -> str:
            instance = self.known.abstract(rename(body, variable, element))
            return self.truth(instance, positive, moment)

        if isinstance(formula, f.Some) == positive:
            element = self._name(site)
            return _join("and", [self._fact(domain, element), at_element(element)])
        self.instanced.add(site)
        listed = self.instances.get(site, ())
        for element in listed:
            if element not in self.elements:
                raise InputError(f"'{element[:60]}' is no lane of the claim and none that it speaks of")
        return _join("and", [f"(=> {self._fact(domain, e)} {at_element(e)})" for e in listed])

    def _fact(self, domain: f.Domain, element: str) -> str:
        if domain.kind == "lanes":
            return "true"
        self.facts.add((domain, element))
        return f"|{membership(domain, element)}|"

    def _name(self, site: Site) -> str:
        self.named.add(site)
        if site in self.names:
            return self.names[site]
        self.fresh += 1
        return f"{self.unnamed}{self.fresh}_"

    def _existential(self, site: Site) -> Moment:
        name = self._name(site)
        self.times.append(name)
        return at(name)

    def _universal(self, site: Site, instance: Instance) -> str:
        self.instanced.add(site)
        clauses: list[str] = []
        for moment in map(read_moment, self.instances.get(site, ())):
            guard, body = instance(moment)
            clauses.append(f"(=> {_join('and', guard)} {body})")
        return _join("and", clauses)

    def _within(self, start: Moment, interval: f.Interval, when: Moment) -> list[str]:
        bounds = [self._at_most(start + moment_of(interval.low), when)]
        if interval.high is not None:
            bounds.append(self._at_most(when, start + moment_of(interval.high)))
        return bounds

    def _at_most(self, left: Moment, right: Moment) -> str:
        self.moments |= {name for m in (left, right) for name, _ in m.parts}
        return f"(<= {left.smt()} {right.smt()})"

    def _less(self, left: Moment, right: Moment) -> str:
        self.moments |= {name for m in (left, right) for name, _ in m.parts}
        return f"(< {left.smt()} {right.smt()})"

    def refuse_strangers(self) -> None:
        """Every listed instance and name must belong to a quantifier that was met."""
        for what, sites, met in (
            ("an instance", self.instances, self.instanced),
            ("a name", self.names, self.named),
        ):
            for site in sites:
                if site not in met:
                    raise InputError(
                        f"{what} at moment {site.moment[:60]} belongs to no quantifier of the claim: "
                        f"{site.formula[:120]}"
                    )

    def declarations(self, bounds: Mapping[str, str]) -> list[str]:
        parameters = sorted(self.moments & set(bounds))
        strangers = self.moments - set(bounds) - set(self.times)
        if strangers:
            raise InputError(f"the moment '{min(strangers)}' is no time of the certificate and no parameter")
        return [
            *(f"(declare-const {constant(name)} Real)" for name in parameters),
            *(f"(assert ({bounds[name]} {constant(name)} 0.0))" for name in parameters if bounds[name]),
            *(f"(declare-const {name} Real)" for name in dict.fromkeys(self.times)),
            *(f"(declare-const |{name}| Bool)" for name in sorted(membership(*x) for x in self.facts)),
            *(f"(assert {axiom})" for axiom in sorted(true_of_roads(self.facts))),
            *(f"(declare-fun |{name}| (Real) Bool)" for name in sorted(self.atoms)),
        ]


def _join(word: str, parts: Sequence[str]) -> str:
    if not parts:
        return "true" if word == "and" else "false"
    return parts[0] if len(parts) == 1 else f"({word} {' '.join(parts)})"
