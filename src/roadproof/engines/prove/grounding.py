"""The negated claim as a growing set of ground clauses in a live solver session.

Each quantifier at a moment is an obligation with a Boolean name; asserting the name asserts what the
quantifier requires. Existentials get a witness name at once; universals wait to be instantiated.
Nothing rests on this: ``evidence.derivation`` derives proofs again and shares no grounding code.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from fractions import Fraction
from typing import TypeAlias, assert_never

from roadproof.engines.prove.roads import Roster
from roadproof.engines.prove.states import is_propositional
from roadproof.engines.solve.recall import RecallingSession
from roadproof.errors import InputError
from roadproof.evidence.atoms import Atoms, is_rigid
from roadproof.evidence.road_axioms import ZONES, membership, road_clauses
from roadproof.evidence.sites import Site, StateLemma, prefix_form
from roadproof.evidence.times import ZERO, Moment, compared_times, constant, moment_of, named_moment
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import rename
from roadproof.runtime.records import dataclass

# What speaks of other moments, or of elements of a road.
Timed: TypeAlias = f.Until | f.Eventually | f.Always | f.Some | f.Every


@dataclass(frozen=True)
class Window:
    """The moments from ``low`` to ``high`` (None: unbounded); ``strict`` excludes the end."""

    low: Moment
    high: Moment | None
    strict: bool = False

    def inside(self, instants: Iterable[Fraction], values: dict[str, Fraction]) -> list[Fraction]:
        """Return the ``instants`` inside the window, under the model ``values``."""
        low = self.low.value(values)
        if self.high is None:
            return [instant for instant in instants if low <= instant]
        high = self.high.value(values)
        return [x for x in instants if low <= x and (x < high if self.strict else x <= high)]

    def smt(self, when: Moment) -> list[str]:
        """Return the SMT conditions that ``when`` lies in the window."""
        guards = [f"(<= {self.low.smt()} {when.smt()})"]
        if self.high is not None:
            guards.append(f"({'<' if self.strict else '<='} {when.smt()} {self.high.smt()})")
        return guards


@dataclass
class Universal:
    """A universal over time: at every moment of ``window``, the condition ``body``.

    ``locally`` implies ``body`` and is a condition about that moment alone.
    """

    site: Site
    switch: str
    window: Window
    body: Callable[[Moment], str]
    is_flat: bool
    locally: Callable[[Moment], str]
    done: list[Moment] = field(default_factory=list)


@dataclass
class RoadUniversal:
    """A universal over lanes or lanelets."""

    site: Site
    switch: str
    domain: f.Domain
    body: Callable[[str], str]
    done: list[str] = field(default_factory=list)


@dataclass
class Grounding:
    """All text sent to the solver, by the reason for it.

    ``switches`` turn instance and lemma clauses on: assumption name to the instance or lemma.
    ``prefixes`` begin the names of times and of lanes or lanelets; no name of the claim begins so.
    ``timing`` are the parameters in interval bounds. ``origins`` gives the switch under which a name first
    occurred; '' is in the claim itself.
    ``wishes`` are assumptions that a named time falls on a moment known before it: models in which they hold
    have few instants, so instantiation ends soon.
    """

    atoms: Atoms
    bounds: dict[str, str]
    prefixes: tuple[str, str] = ("t", "M")
    timing: frozenset[str] = frozenset()
    prefer_known_times: bool = False
    names: dict[Site, str] = field(default_factory=dict)
    roster: Roster | None = None
    session: RecallingSession = field(default_factory=RecallingSession)
    universals: list[Universal] = field(default_factory=list)
    road_universals: list[RoadUniversal] = field(default_factory=list)
    moments: dict[Moment, None] = field(default_factory=lambda: {ZERO: None})
    elements: dict[str, f.Domain] = field(default_factory=dict)
    facts: dict[tuple[f.Domain, str], None] = field(default_factory=dict)
    switches: dict[str, tuple[Site, str] | StateLemma] = field(default_factory=dict)
    wishes: list[str] = field(default_factory=list)
    applied: dict[tuple[str, Moment], str] = field(default_factory=dict)
    origins: dict[str, str] = field(default_factory=dict)
    _known: dict[tuple[Formula, bool, Moment], str] = field(default_factory=dict)
    _atoms: dict[tuple[str, Moment], str] = field(default_factory=dict)
    _declared: set[str] = field(default_factory=set)

    def known_parameters(self) -> list[str]:
        """Return the parameters that occur in some clause."""
        return [name for name in self.bounds if name in self._declared]

    def deny(self, formula: Formula) -> None:
        """Assert the negation of an abstracted formula at time 0."""
        self.session.tell(f"(assert {self.truth(formula, False, ZERO)})")
        self.origins = dict.fromkeys(self.origins, "")

    def truth(self, formula: Formula, positive: bool, moment: Moment, locally: bool = False) -> str:
        """Return the SMT condition for ``formula`` to be true (or false, if not ``positive``) at ``moment``.

        ``locally``: a sufficient condition about that moment alone.
        """
        match formula:
            case f.Truth(value):
                return "true" if value == positive else "false"
            case f.Application(name, _, _):
                applied = self.atom(name, moment)
                return applied if positive else f"(not {applied})"
            case f.Not(body):
                return self.truth(body, not positive, moment, locally)
            case f.And(parts) | f.Or(parts):
                word = "and" if isinstance(formula, f.And) == positive else "or"
                return f"({word} {' '.join(self.truth(p, positive, moment, locally) for p in parts)})"
            case f.Until() | f.Eventually() | f.Always() | f.Some() | f.Every():
                return "false" if locally else self._obligation(formula, positive, moment)
            case f.Since():
                raise InputError(f.NO_PAST)
            case f.Compare() | f.Occupies():
                raise ValueError(f"no atom: {type(formula).__name__}; abstract the formula first")
            case _:
                assert_never(formula)

    def atom(self, name: str, moment: Moment) -> str:
        """Return the SMT term of an atom at a moment."""
        known = self._atoms.get((name, moment))
        if known is None:
            known = self._atoms[name, moment] = self._atom(name, moment)
        return known

    def _atom(self, name: str, moment: Moment) -> str:
        times = compared_times(self.atoms.meaning(name), self.timing)
        if times is not None:
            left, op, right = times
            return f"({op} {self.declare_moment(left)} {self.declare_moment(right)})"
        when = ZERO if is_rigid(self.atoms.meaning(name)) else moment
        if (name, when) not in self.applied:
            self._declare(f"|{name}|", f"(declare-fun |{name}| (Real) Bool)")
            self.applied[name, when] = f"(|{name}| {self.declare_moment(when)})"
        return self.applied[name, when]

    def declare_moment(self, moment: Moment) -> str:
        """Return the moment in SMT-LIB, with its parameters and their bounds declared to the solver."""
        for name, _ in moment.parts:
            if name in self.bounds:
                bound = self.bounds[name]
                known = f"(assert ({bound} {constant(name)} 0.0))" if bound else ""
                self._declare(name, f"(declare-const {constant(name)} Real){known}")
        return moment.smt()

    def _declare(self, name: str, command: str) -> None:
        if name not in self._declared:
            self._declared.add(name)
            self.session.tell(command)

    def _obligation(self, formula: Timed, positive: bool, moment: Moment) -> str:
        key = (formula, positive, moment)
        if key not in self._known:
            switch = f"q${len(self._known) + 1}"
            self._known[key] = switch
            self._declare(switch, f"(declare-const {switch} Bool)")
            self._unfold(formula, positive, moment, switch)
        return self._known[key]

    def _unfold(self, formula: Timed, positive: bool, moment: Moment, switch: str) -> None:
        site = Site(prefix_form(formula), positive, str(moment))
        match formula:
            case f.Eventually(interval, body) | f.Always(interval, body):
                window = self._window(moment, interval)
                if isinstance(formula, f.Eventually) == positive:
                    when = self._name_time(site, window.low)
                    self._require(switch, *window.smt(when), self.truth(body, positive, when))
                else:
                    self._wait(site, switch, window, body, positive)
            case f.Until(left, interval, right) if positive:
                window = self._window(moment, interval)
                end = self._name_time(site, window.low)
                self._require(switch, *window.smt(end), self.truth(right, True, end))
                before = Window(window.low, end, strict=True)
                self._wait(site, switch, before, left, True)
            case f.Until(_, interval, right):
                until = formula
                window = self._window(moment, interval)
                self.universals.append(
                    Universal(
                        site,
                        switch,
                        window,
                        lambda when: self._fails(until, site, window.low, when),
                        False,
                        lambda when: self.truth(right, False, when, locally=True),
                    )
                )
            case f.Some(variable, domain, body) | f.Every(variable, domain, body):

                def at_element(element: str) -> str:
                    instance = self.atoms.abstract(rename(body, variable, element))
                    return self.truth(instance, positive, moment)

                if self.roster is not None:
                    self._require(switch, self._over_roster(self.roster, formula, positive, at_element))
                elif isinstance(formula, f.Some) == positive:
                    element = self._name_element(site, domain)
                    self._require(switch, self._fact(domain, element), at_element(element))
                else:
                    self.road_universals.append(RoadUniversal(site, switch, domain, at_element))
            case _:
                assert_never(formula)

    def _over_roster(
        self, roster: Roster, formula: f.Some | f.Every, positive: bool, at_element: Callable[[str], str]
    ) -> str:
        """Expand a quantifier over all elements of the roster; there a lanelet has its lane and one zone."""
        domain, exists = formula.domain, isinstance(formula, f.Some) == positive
        parts = ["false" if exists else "true"]
        for element in roster.members(domain):
            fact = self._fact(domain, element)
            if domain.kind == "lanelets":
                self._declare(f"(assert {fact})", f"(assert {fact})")
            if domain.kind == "zone":
                for zone in ZONES:
                    self._fact(f.Domain("zone", zone), element)
            parts.append(f"({'and' if exists else '=>'} {fact} {at_element(element)})")
        return f"({'or' if exists else 'and'} {' '.join(parts)})"

    def _fails(self, until: f.Until, site: Site, low: Moment, when: Moment) -> str:
        failed = self._name_time(Site(site.formula, False, site.moment, str(when)), low)
        early = Window(low, when, strict=True).smt(failed)
        broken = f"(and {' '.join(early)} {self.truth(until.left, False, failed)})"
        return f"(or {self.truth(until.right, False, when)} {broken})"

    def _window(self, moment: Moment, interval: f.Interval) -> Window:
        low, high = moment_of(interval.low), interval.high
        for bound in (low, ZERO if high is None else moment_of(high)):
            self.declare_moment(bound)
        return Window(moment + low, None if high is None else moment + moment_of(high))

    def _require(self, switch: str, *parts: str) -> None:
        self.session.tell(f"(assert (=> {switch} (and {' '.join(parts)})))")

    def _wait(self, site: Site, switch: str, window: Window, body: Formula, positive: bool) -> None:
        flat = is_propositional(body)
        self.universals.append(
            Universal(
                site,
                switch,
                window,
                lambda when: self.truth(body, positive, when),
                flat,
                lambda when: self.truth(body, positive, when, locally=True),
            )
        )

    def _name_time(self, site: Site, earliest: Moment) -> Moment:
        name = self.names.setdefault(site, f"{self.prefixes[0]}{len(self.names) + 1}")
        self.origins.setdefault(name, self._next_switch())
        self._declare(name, f"(declare-const {name} Real)")
        if self.prefer_known_times:
            wish = f"w${name}"
            known = " ".join(f"(= {name} {m.smt()})" for m in dict.fromkeys([earliest, *self.moments]))
            self.session.tell(f"(declare-const {wish} Bool)(assert (=> {wish} (or {known})))")
            self.wishes.append(wish)
        self.moments[named_moment(name)] = None
        return named_moment(name)

    def _name_element(self, site: Site, domain: f.Domain) -> str:
        name = self.names.setdefault(site, f"{self.prefixes[1]}{len(self.names) + 1}")
        self.origins.setdefault(name, self._next_switch())
        self.elements[name] = domain
        return name

    def _fact(self, domain: f.Domain, element: str) -> str:
        if domain.kind == "lanes":
            return "true"
        fact = membership(domain, element)
        if (domain, element) not in self.facts:
            self.facts[domain, element] = None
            self._declare(f"|{fact}|", f"(declare-const |{fact}| Bool)")
            for axiom in road_clauses(self.facts):
                self._declare(f"(assert {axiom})", f"(assert {axiom})")
        return f"|{fact}|"

    # --- growing ---------------------------------------------------------------------------------

    def instantiate(self, universal: Universal, when: Moment) -> None:
        """Add the instance of ``universal`` at ``when``, under a switch of its own."""
        universal.done.append(when)
        guards = " ".join([universal.switch, *universal.window.smt(when)])
        self._add_clause((universal.site, str(when)), f"(=> (and {guards}) {universal.body(when)})")

    def instantiate_road(self, universal: RoadUniversal, element: str) -> None:
        """Add the instance of ``universal`` for a lane or lanelet."""
        universal.done.append(element)
        guards = f"{universal.switch} {self._fact(universal.domain, element)}"
        self._add_clause((universal.site, element), f"(=> (and {guards}) {universal.body(element)})")

    def add_lemma(self, literals: Sequence[tuple[str, bool]], when: Moment) -> None:
        """Add a clause that holds at every instant, at one moment."""
        clause = " ".join(
            self.atom(name, when) if positive else f"(not {self.atom(name, when)})"
            for name, positive in literals
        )
        self._add_clause(StateLemma(tuple(literals), (str(when),)), f"(or {clause})")

    def _add_clause(self, stands_for: tuple[Site, str] | StateLemma, clause: str) -> None:
        switch = self._next_switch()
        self.switches[switch] = stands_for
        self.session.tell(f"(declare-const {switch} Bool)(assert (=> {switch} {clause}))")

    def _next_switch(self) -> str:
        """The switch of the clause that is being made."""
        return f"i${len(self.switches) + 1}"
