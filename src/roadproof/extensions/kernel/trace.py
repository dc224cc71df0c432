"""A refuting trace as a Coq module: the claim, the trace, and the theorem that the claim is not valid.

Trusted, except for the derivation, since it states the theorem. Numbers are those of the trace.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.evidence.countermodel import Countermodel, fault_of_states, read_trace
from roadproof.extensions.kernel.derivation import DerivationStep
from roadproof.extensions.kernel.drive import proof_module
from roadproof.extensions.kernel.printer import Formals, Printer
from roadproof.extensions.kernel.source import ClaimText, Module, claim_lines, claim_text, comment_lines
from roadproof.extensions.kernel.statement import bounds_of, formals_of
from roadproof.extensions.kernel.world import WORDS_OF_SIGNALS, Steps, World, road_with_lanelets, world_lines
from roadproof.library.bind import values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import under_limits
from roadproof.library.specification import Library
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signals_of, kind_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import leaves_of, parameters_of
from roadproof.world.drive import Motion, Piece
from roadproof.world.road import Road

_ZERO, _ONE = Fraction(0), Fraction(1)


@dataclass(frozen=True)
class TraceQuestion:
    """A claim with a trace, as JSON, that refutes it; ``assuming``: the assumptions of the claim."""

    claim: str
    set_name: str
    options: Mapping[str, str]
    assuming: tuple[str, ...]
    trace: object
    where: str


@dataclass(frozen=True)
class TraceStatement:
    """The theorem that a trace refutes ``formula``; ``bounds`` (name: strictly above 0) of its parameters."""

    claim: str
    set_name: str
    trace: Countermodel
    formula: Formula
    world: World
    bounds: Mapping[str, bool]
    formals: Formals


def trace_statement(question: TraceQuestion, library: Library) -> TraceStatement:
    """Return the theorem to prove about a trace. Raises ``InputError`` if it does not fit the library."""
    specification = library.select(question.set_name, question.options)
    query = under_limits(specification, read_claim(specification, question.claim), question.assuming)
    trace = read_trace(question.trace, question.where)
    fault = fault_of_states(trace)
    if fault is not None:
        raise InputError(fault)
    values = values_with(library, trace.parameters)
    parameters = parameters_of(query.formula)
    first = trace.instants[0].values
    variables = {x.name for x in leaves_of(query.formula) if isinstance(x, t.Variable)}
    if not variables <= {*first}:
        raise InputError(f"the trace does not say what {', '.join(sorted(variables - {*first}))} is")
    world = replace(
        world_of(
            trace,
            query.vehicles,
            custom_signals_of([query.formula]),
            road_with_lanelets(trace.road),
            {n: values[n] for n in parameters},
        ),
        lanes={name: name for name in query.lanes},
        numbers={name: first[name] for name in variables},
    )
    bounds, formals = bounds_of(specification, parameters), formals_of(specification)
    return TraceStatement(question.claim, question.set_name, trace, query.formula, world, bounds, formals)


def world_of(
    trace: Countermodel,
    vehicles: tuple[str, ...],
    custom: tuple[t.CustomSignal, ...],
    road: Road,
    values: Mapping[str, Fraction],
) -> World:
    """Return the world of a trace, without the claim's lane names and variables."""
    first = trace.instants[0].values
    bodies = {name: _vehicle(name, first) for name in vehicles}
    return World(bodies, road, {}, values, dict(_signals(trace, vehicles, custom)), repeats=trace.loop)


def _vehicle(name: str, values: Mapping[str, Fraction]) -> Motion:
    """Return a vehicle with sizes only: its signals are in steps."""
    length, width = (values.get(f"{x}({name})", _ONE) for x in ("length", "width"))
    kind = values.get(f"kind({name})")
    still = (Piece(None, _ZERO, _ZERO),)
    return Motion(length, width, *(_ZERO,) * 4, still, None if kind is None else kind_of(kind))


def _signals(
    trace: Countermodel, vehicles: tuple[str, ...], custom: tuple[t.CustomSignal, ...]
) -> Iterator[tuple[t.Varying, Steps]]:
    """Yield all signals of a trace. Raises ``InputError`` for one that only some states have."""
    named: dict[t.Varying, str] = {
        t.Signal(name, vehicle): f"{name}({vehicle})" for vehicle in vehicles for name in WORDS_OF_SIGNALS
    }
    named |= {signal: signal.text for signal in custom}
    states = [x for at, after in states_of(trace) for x in (at, after)]
    for signal, name in named.items():
        having = sum(name in x for x in states)
        if 0 < having < len(states):
            raise InputError(f"not every state of the trace has {name}")
        if having:
            yield signal, steps_of(trace, name)
        elif isinstance(signal, t.CustomSignal):
            raise InputError(f"the trace does not say what {name} is")


def states_of(trace: Countermodel) -> list[tuple[Mapping[str, Fraction], Mapping[str, Fraction]]]:
    """Return for each instant the state at it and the state after it, up to the next."""
    at = [x.values for x in trace.instants]
    following = at if trace.interpolation == "before" else [*at[1:], at[-1]]
    return [
        (x.values, usual if x.after is None else x.after)
        for x, usual in zip(trace.instants, following, strict=True)
    ]


def steps_of(trace: Countermodel, name: str) -> Steps:
    """Return the values of a signal, without instants at which it does not change."""
    steps: list[tuple[Fraction, Fraction, Fraction]] = []
    for instant, (at, after) in zip(trace.instants, states_of(trace), strict=True):
        if not steps or not at[name] == after[name] == steps[-1][2]:
            steps.append((instant.time, at[name], after[name]))
    return tuple(steps)


def trace_claim_text(statement: TraceStatement) -> ClaimText:
    """Return the printed claim. Raises ``InputError`` if it cannot be printed."""
    return claim_text(Printer(statement.formals), statement.formula)


def trace_module(
    name: str, statement: TraceStatement, printed: ClaimText, derivation: DerivationStep
) -> Module:
    """Return the module that proves the theorem. Raises ``InputError`` if it cannot be printed."""
    lines = [f"Module {name}.", "Import Roadproof.Drive Roadproof.Shown."]
    lines += comment_lines([f"A trace that refutes a claim, set {statement.set_name}:", statement.claim])
    lines += [*claim_lines(printed, statement.bounds), "", "Open Scope Q_scope."]
    lines += ["Definition the_trace : drive :=", *world_lines(statement.world), ".", ""]
    theorem = "~ Roadproof.Meaning.valid bounds claim"
    return proof_module(name, lines, theorem, "Roadproof.Shown.refuted the_trace bounds claim", derivation)
