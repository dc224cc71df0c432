"""Claims with certificates as text for the extracted program (``proofs/kernel/ocaml/reader.ml``).

Trusted with ``--kernel extracted``, like ``printer.py`` with Coq: BOUNDS, DEFINITIONS and CLAIM state the
theorem. The rest is a certificate, which the program checks.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from roadproof.evidence.kernels import KernelRuling, KernelVerdict
from roadproof.extensions.kernel.accept import CoqModule, KernelRulings
from roadproof.extensions.kernel.constructors import Writer, term
from roadproof.extensions.kernel.derivation import DerivationStep, coq_derivation
from roadproof.extensions.kernel.drive import DriveStatement
from roadproof.extensions.kernel.instant import InstantProof, find_instant_proof
from roadproof.extensions.kernel.names import comment, literal, q, quoted
from roadproof.extensions.kernel.ocaml import ExtractedProgram
from roadproof.extensions.kernel.source import (
    ClaimText,
    Module,
    bounds_of_custom_signals,
    custom_signals_in_order,
)
from roadproof.extensions.kernel.statement import Statement
from roadproof.extensions.kernel.tableau import Tableau, coq_tree
from roadproof.extensions.kernel.trace import TraceStatement
from roadproof.extensions.kernel.world import (
    WORDS_OF_SIGNALS,
    AxisTrajectory,
    Steps,
    World,
    adjacent_pairs,
    axis_trajectories,
)
from roadproof.logic.rewrite import without_names
from roadproof.logic.terms import CustomSignal, Term, Varying
from roadproof.reasons import NO_REASON, ReasonKind
from roadproof.world.drive import Motion
from roadproof.world.road import Lanelet


def proof(name: str, statement: Statement, tableau: Tableau) -> Module:
    """Return a claim with its proof as a form. Raises ``InputError`` if it cannot be written."""
    writer = Writer()
    claim = writer.formula(statement.formula)
    word, supposed = _supposed(statement, writer)
    custom_signals = custom_signals_in_order(statement.formula)
    facts = [x for x, _ in statement.lemmas]
    proofs = [_fact_proof(find_instant_proof(x, statement.bounds, custom_signals)) for x in facts]
    lemmas = [f"({Writer().formula(without_names(x))} {y})" for x, y in zip(facts, proofs, strict=True)]
    values = (f"{literal(name)} {q(x)}" for name, x in statement.demanded.items())
    parts = [
        *_claimed(word, name, statement.claim, _bounds(statement.bounds, custom_signals), writer),
        f" {claim}",
        *supposed,
        f" {_list(lemmas)}",
        f" {_list(map(literal, statement.parameters))}",
        f" {_list(values)}",
        *coq_tree(tableau),
    ]
    return Module(name, "\n".join(parts) + ")\n", (), 0)


def _supposed(statement: Statement, writer: Writer) -> tuple[str, Sequence[str]]:
    """Return the keyword of a form, and its tableau's formula if that is not the claim alone."""
    if not statement.instances:
        return "proof", ()
    instances = (
        f"{x.schema} {' '.join(term(y) if isinstance(y, Term) else writer.formula(y) for y in x.arguments)}"
        for x in statement.instances
    )
    word = "traces" if all(x.is_induction for x in statement.instances) else "motions"
    return word, (f" {_list(instances)}", f" {writer.formula(statement.supposed)}")


def drive(name: str, statement: DriveStatement, printed: ClaimText, derivation: DerivationStep) -> Module:
    """Return a drive file as a form; the claim ``printed`` for Coq has its signals. Raises ``InputError``."""
    writer = Writer()
    claim = writer.formula(statement.formula)
    head = _claimed("drive", name, statement.file.formula, _bounds(statement.bounds, printed.custom), writer)
    return _on_a_world(name, head, claim, statement.world, derivation)


def trace(name: str, statement: TraceStatement, printed: ClaimText, derivation: DerivationStep) -> Module:
    """Return the form that states that a claim is false on a trace. Raises ``InputError``."""
    writer = Writer()
    claim = writer.formula(statement.formula)
    head = _claimed("drive", name, statement.claim, _bounds(statement.bounds, printed.custom), writer)
    return _on_a_world(name, head, f"(Not {claim})", statement.world, derivation)


def _on_a_world(
    name: str, head: Iterable[str], claim: str, world: World, derivation: DerivationStep
) -> Module:
    """Return a form that states that a claim holds on a drive or trace."""
    parts = [*head, f" {claim}", *_world(world), *coq_derivation(derivation)]
    return Module(name, "\n".join(parts) + ")\n", (), 0)


def _world(world: World) -> Iterator[str]:
    """Yield the fields of ``drive`` in Drive.v."""
    yield f" ({_list(_body(name, motion) for name, motion in world.vehicles.items())}"
    yield f"  {_list(map(_rectangle, world.road.lanelets))}"
    yield f"  {_list(f'{quoted(a)} {quoted(b)}' for a, b in adjacent_pairs(world.road))}"
    yield f"  {_list(f'{literal(a)} {quoted(b)}' for a, b in sorted(world.lanes.items()))}"
    yield f"  {_list(f'{literal(a)} {q(x)}' for a, x in sorted(world.values.items()))}"
    yield f"  {_list(_signal(*x) for x in world.steps.items())}"
    yield f"  {_list(f'{literal(a)} {q(x)}' for a, x in sorted(world.numbers.items()))}"
    loop = world.repeats
    yield f"  {'None' if loop is None else f'({q(loop.start)} {q(loop.period)})'})"


def _signal(signal: Varying, steps: Steps) -> str:
    word = (
        f"(Own {literal(signal.name)})" if isinstance(signal, CustomSignal) else WORDS_OF_SIGNALS[signal.name]
    )
    return f"{word} {quoted(signal.vehicle)} {_list(' '.join(map(q, x)) for x in steps)}"


def _rectangle(x: Lanelet) -> str:
    low, high = ("None" if y is None else q(y) for y in x.s)
    return f"{quoted(x.lane)} {x.zone} {low} {high} {q(x.d[0])} {q(x.d[1])}"


def _body(name: str, motion: Motion) -> str:
    along, across = map(_course, axis_trajectories(motion))
    sizes = f"{q(motion.length)} {q(motion.width)}"
    return f"{literal(name)} {motion.kind or 'other'} {sizes} {along} {across}"


def _course(course: AxisTrajectory) -> str:
    shown = (" ".join(map(q, piece)) for piece in course.pieces)
    return f"({q(course.place)} {q(course.speed)} {_list(shown)} {q(course.last)})"


# --- verdicts ------------------------------------------------------------------------------------


def judge(program: ExtractedProgram, prepared: Mapping[str, CoqModule]) -> KernelRulings:
    """Return the program's rulings by name; if a run on several forms fails, each is checked alone."""
    judged = KernelRulings({name: x.refusal for name, x in prepared.items() if x.refusal is not None})
    modules = {name: x.module for name, x in prepared.items() if x.module is not None}
    if not modules:
        return judged
    run = program.run("".join(x.text for x in modules.values()))
    judged.seconds = run.seconds
    answers = [line.partition(" ") for line in run.output.splitlines()]
    if run.code == 0 and [name for name, _, _ in answers] == list(modules):
        judged.rulings |= {name: _ruling(word, prepared[name].limits) for name, _, word in answers}
    elif len(modules) > 1:
        for name in modules:
            alone = judge(program, {name: prepared[name]})
            judged.rulings |= alone.rulings
            judged.seconds += alone.seconds
    else:
        why = " ".join(run.errors.split())[:200] or f"exit code {run.code}"
        failed = KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.PROGRAM_ENDED(why))
        judged.rulings |= dict.fromkeys(modules, failed)
    return judged


def _ruling(answer: str, limits: int) -> KernelRuling:
    match answer.partition(" "):
        case "accepted", "", "":
            return KernelRuling(KernelVerdict.ACCEPTED, NO_REASON, None, limits)
        case "refused", "", "":
            return KernelRuling(KernelVerdict.REFUSED, ReasonKind.NOT_BY_PROGRAM())
        case "lemma", _, number:
            return KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.LEMMA_TACTICS(number), int(number))
        case _:  # open: lines of a program
            return KernelRuling(KernelVerdict.UNKNOWN, ReasonKind.PROGRAM_DOES_NOT_READ(answer))


def _fact_proof(proof: InstantProof | None) -> str:
    """Return the proof of a fact about one instant; without one, the program may know it by name."""
    return "known" if proof is None else f"{_list(map(term, proof.atoms))} {proof.proof_text}"


def _bounds(bounds: Mapping[str, bool], custom_signals: Iterable[CustomSignal]) -> Iterator[str]:
    yield from (f"{_BOUND[strict]} {literal(p)}" for p, strict in bounds.items())
    yield from bounds_of_custom_signals(custom_signals, q)


def _claimed(word: str, name: str, claim: str, bounds: Iterable[str], writer: Writer) -> Iterator[str]:
    """Yield the beginning of a form, up to its definitions."""
    yield f'({word} {name} "{comment(claim)}"'
    yield f" {_list(bounds)}"
    between = ";\n  "
    yield f" [{between.join(writer.definitions)}]"


_BOUND = {True: "above_0", False: "at_least_0"}


def _list(items: Iterable[str]) -> str:
    return f"[{'; '.join(items)}]"
