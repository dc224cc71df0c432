"""Claims with their certificates as text for the extracted program (``proofs/kernel/ocaml/reader.ml``).

Trusted for ``--kernel extracted``, as ``printer.py`` is for Coq: BOUNDS, DEFINITIONS and CLAIM say what is
proved. The rest is a certificate, which the program checks.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from roadproof.evidence.kernels import Ruling, Word
from roadproof.extensions.kernel.accept import CoqModule, KernelRulings
from roadproof.extensions.kernel.constructors import Writer, term
from roadproof.extensions.kernel.derivation import Step, coq_derivation
from roadproof.extensions.kernel.drive import Shown
from roadproof.extensions.kernel.instant import Reason, reason
from roadproof.extensions.kernel.names import comment, literal, q, quoted
from roadproof.extensions.kernel.ocaml import Program
from roadproof.extensions.kernel.source import ClaimText, Module, own_bounds, own_signals
from roadproof.extensions.kernel.statement import Statement
from roadproof.extensions.kernel.tableau import Tableau, coq_tree
from roadproof.extensions.kernel.trace import Refuted
from roadproof.extensions.kernel.world import WORDS_OF_SIGNALS, Course, Steps, World, beside, courses
from roadproof.logic.rewrite import without_names
from roadproof.logic.terms import Own, Term, Varying
from roadproof.reasons import NO_REASON, Why
from roadproof.world.drive import Motion
from roadproof.world.road import Lanelet


def proof(name: str, statement: Statement, tableau: Tableau) -> Module:
    """A claim with its proof as a form. Raises ``InputError`` for what is not written."""
    writer = Writer()
    claim = writer.formula(statement.formula)
    word, supposed = _supposed(statement, writer)
    own = own_signals(statement.formula)
    lemmas = [
        f"({Writer().formula(without_names(x))} {_why(reason(x, statement.bounds, own))})"
        for x, _ in statement.lemmas
    ]
    values = (f"{literal(name)} {q(x)}" for name, x in statement.demanded.items())
    parts = [
        *_claimed(word, name, statement.claim, _bounds(statement.bounds, own), writer),
        f" {claim}",
        *supposed,
        f" {_list(lemmas)}",
        f" {_list(map(literal, statement.parameters))}",
        f" {_list(values)}",
        *coq_tree(tableau),
    ]
    return Module(name, "\n".join(parts) + ")\n", (), 0)


def _supposed(statement: Statement, writer: Writer) -> tuple[str, Sequence[str]]:
    """The word of a form, and what its tableau proves where that is not the claim alone."""
    if not statement.instances:
        return "proof", ()
    made = (
        f"{x.schema} {' '.join(term(y) if isinstance(y, Term) else writer.formula(y) for y in x.arguments)}"
        for x in statement.instances
    )
    word = "traces" if all(x.is_induction for x in statement.instances) else "motions"
    return word, (f" {_list(made)}", f" {writer.formula(statement.supposed)}")


def drive(name: str, shown: Shown, printed: ClaimText, derivation: Step) -> Module:
    """A drive file as a form; its claim is ``printed`` for Coq. Raises ``InputError``."""
    writer = Writer()
    claim = writer.formula(shown.formula)
    head = _claimed("drive", name, shown.file.formula, _bounds(shown.bounds, printed.own), writer)
    return _on_a_world(name, head, claim, shown.world, derivation)


def trace(name: str, refuted: Refuted, printed: ClaimText, derivation: Step) -> Module:
    """That the opposite of a claim is true of a trace, as a form. Raises ``InputError``."""
    writer = Writer()
    claim = writer.formula(refuted.formula)
    head = _claimed("drive", name, refuted.claim, _bounds(refuted.bounds, printed.own), writer)
    return _on_a_world(name, head, f"(Not {claim})", refuted.world, derivation)


def _on_a_world(name: str, head: Iterable[str], claim: str, world: World, derivation: Step) -> Module:
    """A form that says that a claim is true of a drive or trace."""
    parts = [*head, f" {claim}", *_world(world), *coq_derivation(derivation)]
    return Module(name, "\n".join(parts) + ")\n", (), 0)


def _world(world: World) -> Iterator[str]:
    """The fields of ``drive`` in Drive.v."""
    yield f" ({_list(_body(name, motion) for name, motion in world.vehicles.items())}"
    yield f"  {_list(map(_rectangle, world.road.lanelets))}"
    yield f"  {_list(f'{quoted(a)} {quoted(b)}' for a, b in beside(world.road))}"
    yield f"  {_list(f'{literal(a)} {quoted(b)}' for a, b in sorted(world.lanes.items()))}"
    yield f"  {_list(f'{literal(a)} {q(x)}' for a, x in sorted(world.values.items()))}"
    yield f"  {_list(_signal(*x) for x in world.steps.items())}"
    yield f"  {_list(f'{literal(a)} {q(x)}' for a, x in sorted(world.numbers.items()))}"
    loop = world.repeats
    yield f"  {'None' if loop is None else f'({q(loop.start)} {q(loop.period)})'})"


def _signal(signal: Varying, steps: Steps) -> str:
    word = f"(Own {literal(signal.name)})" if isinstance(signal, Own) else WORDS_OF_SIGNALS[signal.name]
    return f"{word} {quoted(signal.vehicle)} {_list(' '.join(map(q, x)) for x in steps)}"


def _rectangle(x: Lanelet) -> str:
    low, high = ("None" if y is None else q(y) for y in x.s)
    return f"{quoted(x.lane)} {x.zone} {low} {high} {q(x.d[0])} {q(x.d[1])}"


def _body(name: str, motion: Motion) -> str:
    along, across = map(_course, courses(motion))
    sizes = f"{q(motion.length)} {q(motion.width)}"
    return f"{literal(name)} {motion.kind or 'other'} {sizes} {along} {across}"


def _course(course: Course) -> str:
    shown = (" ".join(map(q, piece)) for piece in course.pieces)
    return f"({q(course.place)} {q(course.speed)} {_list(shown)} {q(course.last)})"


# --- verdicts ------------------------------------------------------------------------------------


def judge(program: Program, prepared: Mapping[str, CoqModule]) -> KernelRulings:
    """What the program says of each, by name; where it fails on several, each is put to it alone."""
    judged = KernelRulings({name: x.refusal for name, x in prepared.items() if x.refusal is not None})
    asked = {name: x.module for name, x in prepared.items() if x.module is not None}
    if not asked:
        return judged
    ran = program.run("".join(x.text for x in asked.values()))
    judged.seconds = ran.seconds
    said = [line.partition(" ") for line in ran.said.splitlines()]
    if ran.code == 0 and [name for name, _, _ in said] == list(asked):
        judged.rulings |= {name: _ruling(word, prepared[name].limits) for name, _, word in said}
    elif len(asked) > 1:
        for name in asked:
            alone = judge(program, {name: prepared[name]})
            judged.rulings |= alone.rulings
            judged.seconds += alone.seconds
    else:
        why = " ".join(ran.complained.split())[:200] or f"exit code {ran.code}"
        failed = Ruling(Word.UNKNOWN, Why.PROGRAM_ENDED(why))
        judged.rulings |= dict.fromkeys(asked, failed)
    return judged


def _ruling(said: str, limits: int) -> Ruling:
    match said.partition(" "):
        case "accepted", "", "":
            return Ruling(Word.ACCEPTED, NO_REASON, None, limits)
        case "refused", "", "":
            return Ruling(Word.REFUSED, Why.NOT_BY_PROGRAM())
        case "lemma", _, number:
            return Ruling(Word.UNKNOWN, Why.LEMMA_TACTICS(number), int(number))
        case _:
            return Ruling(Word.UNKNOWN, Why.PROGRAM_DOES_NOT_READ(said))


def _why(found: Reason | None) -> str:
    """Why a fact about one instant holds; one without a reason may be known by name."""
    return "known" if found is None else f"{_list(map(term, found.atoms))} {found.written}"


def _bounds(bounds: Mapping[str, bool], own: Iterable[Own]) -> Iterator[str]:
    yield from (f"{_BOUND[strict]} {literal(p)}" for p, strict in bounds.items())
    yield from own_bounds(own, q)


def _claimed(word: str, name: str, claim: str, bounds: Iterable[str], writer: Writer) -> Iterator[str]:
    """The begin of a form, up to its definitions."""
    yield f'({word} {name} "{comment(claim)}"'
    yield f" {_list(bounds)}"
    between = ";\n  "
    yield f" [{between.join(writer.definitions)}]"


_BOUND = {True: "above_0", False: "at_least_0"}


def _list(items: Iterable[str]) -> str:
    return f"[{'; '.join(items)}]"
