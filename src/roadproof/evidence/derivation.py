"""The ground query of a certificate, derived from the claim and a list of instances alone.

The negated claim is read as a first-order sentence over real time, with predicates as functions of time.
Every existential gets a new name; every universal becomes the conjunction of its listed instances. Both steps
only weaken the sentence. So if the result is unsatisfiable, the negated claim is, and the claim is valid on
all traces (Herbrand). Lemmas are clauses that hold at every instant; each has a query of its own, about one
instant, that must be unsatisfiable too.
"""

import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.evidence.atoms import Atoms, is_rigid
from roadproof.evidence.road_axioms import membership, road_clauses
from roadproof.evidence.sites import Site, StateLemma, prefix_form
from roadproof.evidence.times import (
    ZERO,
    Moment,
    bound_parameters,
    compared_times,
    constant,
    moment_of,
    named_moment,
    read_moment,
)
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import rename, road_names

_NEW_NAME = re.compile(r"[tM]_*[0-9]{1,9}", re.ASCII)

# The instance of a universal at a moment: its guards, and the body that they guard.
Instance: TypeAlias = Callable[[Moment], tuple[list[str], str]]


def derive_query(
    claim: Formula,
    atoms: Atoms,
    instances: Mapping[Site, Sequence[str]],
    names: Mapping[Site, str],
    lemmas: Sequence[StateLemma],
    bounds: Mapping[str, str],
    lanes: Collection[str] = (),
) -> str:
    """Return an SMT-LIB script that denies the abstracted claim at time 0.

    If it is unsatisfiable and the lemmas hold, the claim is valid. Quantifiers are those of the negated
    claim.

    Args:
        claim: the claim, abstracted by ``atoms``.
        instances: the moments or lanes to instantiate each universal with; without any, it becomes true.
        names: new names (t1, M1) of the existentials that instances mention; others are named here.
        lemmas: clauses taken as true, with the moments at which they are added.
        bounds: the declared bound of each parameter against 0 (``>``, ``>=`` or "").
        lanes: the free lanes of the claim.

    Raises:
        InputError: an instance or a name has no quantifier, a name is not new, a moment or lane is unknown.
    """
    derivation = _new_derivation(claim, atoms, instances, names, bounds, lanes)
    goal = derivation.truth(claim, False, ZERO)
    clauses = [
        _join("or", [derivation.literal(name, positive, moment) for name, positive in lemma.literals])
        for lemma in lemmas
        for moment in map(read_moment, lemma.moments)
    ]
    derivation.require_known_sites()
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
    """Return the entries of ``instances`` and ``names`` whose quantifiers the instantiated claim has."""
    derivation = _new_derivation(claim, atoms, instances, names, bounds, lanes)
    derivation.truth(claim, False, ZERO)
    met = {site: tuple(texts) for site, texts in instances.items() if site in derivation.met_universals}
    return met, {site: name for site, name in names.items() if site in derivation.met_existentials}


def _new_derivation(
    claim: Formula,
    atoms: Atoms,
    instances: Mapping[Site, Sequence[str]],
    names: Mapping[Site, str],
    bounds: Mapping[str, str],
    lanes: Collection[str],
) -> "_Derivation":
    """Return a derivation. Raises ``InputError`` for names that are not new: sharing one would be unsound."""
    taken = {*lanes, *road_names(claim), *bounds}
    for name in names.values():
        if name in taken or not _NEW_NAME.fullmatch(name):
            raise InputError(f"'{name[:60]}' is no new name: times are called t1, t2, …, lanes M1, M2, …")
    if len({*names.values()}) != len(names):
        raise InputError("two existentials of the certificate have the same name")
    lanes_and_names = frozenset({*lanes, *road_names(claim), *names.values()})
    prefixes = free_prefix("u", taken), free_prefix("q", taken)
    return _Derivation(atoms, instances, names, lanes_and_names, bound_parameters(claim), *prefixes)


def free_prefix(prefix: str, taken: Collection[str]) -> str:
    """Return ``prefix``, extended by underscores until no name in ``taken`` begins with it."""
    while any(name.startswith(prefix) for name in taken):
        prefix += "_"
    return prefix


def derive_lemma_queries(
    atoms: Atoms, literals: Sequence[tuple[str, bool]], bounds: Mapping[str, str]
) -> list[str]:
    """Return SMT-LIB scripts about one instant that are all unsatisfiable only if the clause always holds.

    Each script is one case of the maxima and minima in the clause.
    """
    from roadproof.evidence import state  # here: few proofs have lemmas
    from roadproof.evidence.cases import split

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
    """The state of a derivation, with the universals and existentials met so far.

    ``timing_parameters``: the parameters in interval bounds; comparisons among them are encoded as
    arithmetic, not as atoms.
    """

    known: Atoms
    instances: Mapping[Site, Sequence[str]]
    names: Mapping[Site, str]
    elements: frozenset[str]
    timing_parameters: frozenset[str]
    fresh_prefix: str
    definition_prefix: str
    definitions: list[str] = field(default_factory=list)
    defined: dict[tuple[Formula, bool, Moment], str] = field(default_factory=dict)
    atoms: set[str] = field(default_factory=set)
    facts: set[tuple[f.Domain, str]] = field(default_factory=set)
    times: list[str] = field(default_factory=list)
    moments: set[str] = field(default_factory=set)
    met_universals: set[Site] = field(default_factory=set)
    met_existentials: set[Site] = field(default_factory=set)
    fresh_count: int = 0

    def truth(self, formula: Formula, positive: bool, moment: Moment) -> str:
        """Return an SMT-LIB formula that follows from the truth, or falsity, of the formula at a moment."""
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
            case f.Since():
                raise InputError(f.NO_PAST)
            case f.Compare() | f.Occupies():
                raise ValueError("abstract the formula first")
            case _:
                assert_never(formula)

    def literal(self, name: str, positive: bool, moment: Moment) -> str:
        """Return the SMT-LIB literal of an atom at a moment."""
        meaning = self.known.meaning(name)
        times = compared_times(meaning, self.timing_parameters)
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
            self.defined[key] = f"{self.definition_prefix}{len(self.definitions) + 1}"
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
        """Encode ¬(φ U ψ): whenever ψ is true in the window, φ was false before within the window."""
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
        self.met_universals.add(site)
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
        self.met_existentials.add(site)
        if site in self.names:
            return self.names[site]
        self.fresh_count += 1
        return f"{self.fresh_prefix}{self.fresh_count}_"

    def _existential(self, site: Site) -> Moment:
        name = self._name(site)
        self.times.append(name)
        return named_moment(name)

    def _universal(self, site: Site, instance: Instance) -> str:
        self.met_universals.add(site)
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

    def require_known_sites(self) -> None:
        """Raise ``InputError`` if a listed instance or name belongs to no quantifier that was met."""
        for kind, sites, met in (
            ("an instance", self.instances, self.met_universals),
            ("a name", self.names, self.met_existentials),
        ):
            for site in sites:
                if site not in met:
                    raise InputError(
                        f"{kind} at moment {site.moment[:60]} belongs to no quantifier of the claim: "
                        f"{site.formula[:120]}"
                    )

    def declarations(self, bounds: Mapping[str, str]) -> list[str]:
        """Return the declarations of the script; raises ``InputError`` for a moment with an unknown name."""
        parameters = sorted(self.moments & set(bounds))
        unknown = self.moments - set(bounds) - set(self.times)
        if unknown:
            raise InputError(f"the moment '{min(unknown)}' is no time of the certificate and no parameter")
        return [
            *(f"(declare-const {constant(name)} Real)" for name in parameters),
            *(f"(assert ({bounds[name]} {constant(name)} 0.0))" for name in parameters if bounds[name]),
            *(f"(declare-const {name} Real)" for name in dict.fromkeys(self.times)),
            *(f"(declare-const |{name}| Bool)" for name in sorted(membership(*x) for x in self.facts)),
            *(f"(assert {axiom})" for axiom in sorted(road_clauses(self.facts))),
            *(f"(declare-fun |{name}| (Real) Bool)" for name in sorted(self.atoms)),
        ]


def _join(word: str, parts: Sequence[str]) -> str:
    if not parts:
        return "true" if word == "and" else "false"
    return parts[0] if len(parts) == 1 else f"({word} {' '.join(parts)})"
