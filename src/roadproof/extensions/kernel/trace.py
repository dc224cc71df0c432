"""A trace that refutes a claim, as a module of Coq: the claim, the trace, and that the claim is not valid.

Trusted, but for the derivation: it says what is proved. Numbers are those of the trace.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.evidence.countermodel import Countermodel, fault_of_states, read_trace
from roadproof.extensions.kernel.derivation import Step
from roadproof.extensions.kernel.drive import closed
from roadproof.extensions.kernel.printer import Formals, Printer
from roadproof.extensions.kernel.source import ClaimText, Module, claim_lines, claim_text, comment_lines
from roadproof.extensions.kernel.statement import bounds_of, formals_of
from roadproof.extensions.kernel.world import WORDS_OF_SIGNALS, Steps, World, road_with_lanelets, world_lines
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import under_limits
from roadproof.library.specification import Library
from roadproof.logic import terms as t
from roadproof.logic.custom_names import kind_of, own_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of, parameters_of
from roadproof.world.drive import Motion, Piece
from roadproof.world.road import Road

_ZERO, _ONE = Fraction(0), Fraction(1)


@dataclass(frozen=True)
class Refutation:
    """A claim that a trace, as data, refutes; ``assuming``: what the claim is said under."""

    claim: str
    set_name: str
    options: Mapping[str, str]
    assuming: tuple[str, ...]
    trace: object
    where: str


@dataclass(frozen=True)
class Refuted:
    """What a trace refutes: ``formula``. ``bounds`` (name: strictly above 0) are those of its parameters."""

    claim: str
    set_name: str
    trace: Countermodel
    formula: Formula
    world: World
    bounds: Mapping[str, bool]
    formals: Formals


def refuted(asked: Refutation, library: Library) -> Refuted:
    """What is to be proved of a trace. Raises ``InputError`` where it does not fit the library."""
    specification = library.select(asked.set_name, asked.options)
    query = under_limits(specification, read_claim(specification, asked.claim), asked.assuming)
    trace = read_trace(asked.trace, asked.where)
    fault = fault_of_states(trace)
    if fault is not None:
        raise InputError(fault)
    values = values_with(library, trace.parameters)
    spoken = parameters_of(query.formula)
    first = trace.instants[0].values
    variables = {x.name for x in leaves_of(query.formula) if isinstance(x, t.Variable)}
    if not variables <= {*first}:
        raise InputError(f"the trace does not say what {', '.join(sorted(variables - {*first}))} is")
    world = replace(
        world_of(
            trace,
            query.vehicles,
            own_of([query.formula]),
            road_with_lanelets(trace.road),
            {n: values[n] for n in spoken},
        ),
        lanes={name: name for name in query.lanes},
        numbers={name: first[name] for name in variables},
    )
    bounds, formals = bounds_of(specification, spoken), formals_of(specification)
    return Refuted(asked.claim, asked.set_name, trace, query.formula, world, bounds, formals)


def world_of(
    trace: Countermodel,
    vehicles: tuple[str, ...],
    own: tuple[t.Own, ...],
    road: Road,
    values: Mapping[str, Fraction],
) -> World:
    """The world of a trace, without names of lanes and numbers that a claim speaks of."""
    first = trace.instants[0].values
    bodies = {name: _vehicle(name, first) for name in vehicles}
    return World(bodies, road, {}, values, dict(_signals(trace, vehicles, own)), repeats=trace.loop)


def _vehicle(name: str, values: Mapping[str, Fraction]) -> Motion:
    """A vehicle of which only the sizes count: its signals are in steps."""
    length, width = (values.get(f"{x}({name})", _ONE) for x in ("length", "width"))
    kind = values.get(f"kind({name})")
    still = (Piece(None, _ZERO, _ZERO),)
    return Motion(length, width, *(_ZERO,) * 4, still, None if kind is None else kind_of(kind))


def _signals(
    trace: Countermodel, vehicles: tuple[str, ...], own: tuple[t.Own, ...]
) -> Iterator[tuple[t.Varying, Steps]]:
    """All that the trace says; of one that only some states have, ``InputError`` is raised."""
    named: dict[t.Varying, str] = {
        t.Signal(name, vehicle): f"{name}({vehicle})" for vehicle in vehicles for name in WORDS_OF_SIGNALS
    }
    named |= {signal: signal.told for signal in own}
    states = [x for at, after in states_of(trace) for x in (at, after)]
    for signal, name in named.items():
        having = sum(name in x for x in states)
        if 0 < having < len(states):
            raise InputError(f"not every state of the trace has {name}")
        if having:
            yield signal, steps_of(trace, name)
        elif isinstance(signal, t.Own):
            raise InputError(f"the trace does not say what {name} is")


def states_of(trace: Countermodel) -> list[tuple[Mapping[str, Fraction], Mapping[str, Fraction]]]:
    """The states at each instant and after it, up to the next."""
    at = [x.values for x in trace.instants]
    held = at if trace.held == "before" else [*at[1:], at[-1]]
    return [
        (x.values, usual if x.after is None else x.after)
        for x, usual in zip(trace.instants, held, strict=True)
    ]


def steps_of(trace: Countermodel, name: str) -> Steps:
    """What a signal is, without the instants at which it stays what it was."""
    found: list[tuple[Fraction, Fraction, Fraction]] = []
    for instant, (at, after) in zip(trace.instants, states_of(trace), strict=True):
        if not found or not at[name] == after[name] == found[-1][2]:
            found.append((instant.time, at[name], after[name]))
    return tuple(found)


def trace_claim(refuted: Refuted) -> ClaimText:
    """Raises ``InputError`` for what is not printed."""
    return claim_text(Printer(refuted.formals), refuted.formula)


def trace_module(name: str, refuted: Refuted, printed: ClaimText, derivation: Step) -> Module:
    """The module that proves it. Raises ``InputError`` for what is not printed."""
    out = [f"Module {name}.", "Import Roadproof.Drive Roadproof.Shown."]
    out += comment_lines([f"A trace that refutes a claim, set {refuted.set_name}:", refuted.claim])
    out += [*claim_lines(printed, refuted.bounds), "", "Open Scope Q_scope."]
    out += ["Definition the_trace : drive :=", *world_lines(refuted.world), ".", ""]
    said = "~ Roadproof.Meaning.valid bounds claim"
    return closed(name, out, said, "Roadproof.Shown.refuted the_trace bounds claim", derivation)
