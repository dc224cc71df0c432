"""The monitor: formulas compiled once, evaluated over batches of recorded traces.

All formulas of a monitor share equal sub-formulas, which are found by structure, not by the name of the
definition that they come from.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Generic, assert_never

import numpy as np
from numpy.typing import NDArray

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import custom_signals_of
from roadproof.logic.formula import Application, Compare, Formula
from roadproof.logic.rewrite import bounds_of, intervals_of, signals_of, terms_of, without_names
from roadproof.logic.terms import CustomSignal
from roadproof.semantics.sampled.answers import (
    Convention,
    Key,
    Margins,
    TruthArrays,
    Verdicts,
    When,
    check_starts,
    no_margin,
    read_bits,
    store_margin,
    views,
)
from roadproof.semantics.sampled.arithmetic import Bytecode, margin_program, truth_program
from roadproof.semantics.sampled.batch import Array, Batch, Integers, rows_from
from roadproof.semantics.sampled.boolean import BITS, TRUTH, observe_truth, pack, packed_inside, unpack
from roadproof.semantics.sampled.lattice import LatticeEvaluation, View
from roadproof.semantics.sampled.robustness import (
    MARGIN,
    as_margin,
    margin_inside,
    observe_margins,
    trace_blocks,
)
from roadproof.world.signals import SignalName


@dataclass(frozen=True)
class Observation:
    """The packed truth of state formulas over a batch, all that Boolean evaluation needs of it.

    ``composites`` caches the truth of formulas made of ``leaves``, once an evaluation has needed it.
    """

    dt: Fraction
    lengths: Integers
    samples: int
    leaves: Mapping[Formula, Array]
    composites: dict[Formula, Array] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def inside(self) -> NDArray[np.uint64] | None:
        """The mask of samples that belong to their traces; None where all do."""
        return packed_inside(self.lengths, self.samples)

    def cut(self, lengths: Integers) -> "Observation":
        """Return the observation of the first ``lengths`` samples of each trace."""
        if lengths.shape != self.lengths.shape or (lengths < 1).any() or (lengths > self.lengths).any():
            raise InputError("a trace is cut to a length from 1 to the one it has")
        return replace(self, lengths=lengths)

    def from_starts(self, starts: Integers) -> "Observation":
        """Return the observation without the samples before those at which each trace ``starts``."""
        traces = len(self.lengths)
        leaves = {x: pack(rows_from(unpack(words, traces), starts)) for x, words in self.leaves.items()}
        return Observation(self.dt, self.lengths - starts, self.samples, leaves)


@dataclass(frozen=True)
class Monitor(Generic[Key]):
    """A compiled set of formulas; ``plain`` are they without names of definitions, sharing sub-trees.

    ``named``: sub-formulas that have names, and each without its name. ``signals``: the signals they need, of
    any vehicle; custom signals of some vehicle stand for all.
    """

    formulas: Mapping[Key, Formula]
    plain: Mapping[Key, Formula]
    states: frozenset[Formula]
    signals: tuple[SignalName | CustomSignal, ...]
    programs: dict[tuple[Compare, ...], Bytecode] = field(default_factory=dict, repr=False, compare=False)

    @cached_property
    def _looks_back(self) -> bool:
        return any(map(f.looks_back, self.plain.values()))

    @cached_property
    def named(self) -> Mapping[Application, Formula]:
        nodes = [x for x in f.subformulas(*self.formulas.values()) if isinstance(x, Application)]
        return dict(zip(nodes, f.hash_cons(nodes, _unnamed), strict=True))

    def observe(self, batch: Batch, known: Observation | None = None, threads: int = 1) -> Observation:
        """Return the truth of all state formulas at all samples, reusing ``known`` where it has them."""
        leaves: dict[Formula, Array] = {}
        composites: dict[Formula, Array] = {}
        if known is not None:
            if known.dt != batch.dt or not np.array_equal(known.lengths, batch.lengths):
                raise InputError("an observation is only taken over for traces of the same dt and lengths")
            leaves |= known.leaves
        given = {g: values for g, values in _given(batch).items() if g not in leaves}
        if known is not None and not given:
            composites = known.composites
        leaves |= {g: pack(values[: batch.samples]) for g, values in given.items()}
        comparisons = tuple(self._comparisons(leaves))
        if comparisons not in self.programs:
            self.programs[comparisons] = truth_program(comparisons)
        leaves |= observe_truth(comparisons, self.programs[comparisons], batch, threads)
        return Observation(batch.dt, batch.lengths, batch.samples, leaves, composites)

    def evaluate(
        self,
        batch: Batch | Observation,
        semantics: Convention = "truncated",
        at: When = "start",
        starts: Integers | None = None,
        named: bool = False,
        threads: int = 1,
    ) -> Verdicts[Key]:
        """Return the answer to every formula at the start of each trace, or ``at`` all samples.

        ``starts``: the sample at which each trace starts (default 0), shape (traces,). With ``named``,
        named sub-formulas are answered too, at all samples. Raises ``InputError`` for interval bounds that
        are no multiple of the step, and for signals and lanes that the batch lacks.
        """
        seen = self.observe(batch, threads=threads) if isinstance(batch, Batch) else batch
        check_starts(starts, seen.lengths)
        if starts is not None and at == "start" and self._looks_back:
            return self.evaluate(seen.from_starts(starts), semantics, named=named)
        evaluation, traces = self._evaluation(seen), len(seen.lengths)

        def answer(formula: Formula, starts: Integers | None) -> TruthArrays:
            strong, weak = (evaluation.value(formula, view) for view in views(semantics))
            return TruthArrays(*(read_bits(x, evaluation.inside, traces, starts) for x in (strong, ~weak)))

        if at == "start" and starts is None:
            questions = [(formula, view) for formula in self.plain.values() for view in views(semantics)]
            known = _first_bits(evaluation, questions, traces)
            answers = [*map(TruthArrays, known[::2], ~known[1::2])]
        else:
            answers = [answer(x, starts if at == "start" else None) for x in self.plain.values()]
        return Verdicts(
            semantics,
            dict(zip(self.plain, answers, strict=True)),
            {name: answer(body, None) for name, body in self.named.items()} if named else {},
        )

    def holds(
        self, batch: Batch | Observation, semantics: Convention = "truncated", at: When = "start"
    ) -> dict[Key, NDArray[np.bool_]]:
        """Return where each formula is true for every continuation, for half the work of ``evaluate``."""
        seen = self.observe(batch) if isinstance(batch, Batch) else batch
        evaluation, traces, view = self._evaluation(seen), len(seen.lengths), views(semantics)[0]
        if at == "start":
            questions = [(formula, view) for formula in self.plain.values()]
            return dict(zip(self.plain, _first_bits(evaluation, questions, traces), strict=True))
        values = {name: evaluation.value(formula, view) for name, formula in self.plain.items()}
        return {name: read_bits(x, evaluation.inside, traces, None) for name, x in values.items()}

    def _evaluation(self, seen: Observation) -> LatticeEvaluation:
        shape = (seen.samples, -(-len(seen.lengths) // BITS))
        return LatticeEvaluation(
            TRUTH, seen.leaves, seen.inside, seen.dt, shape, self.states, seen.composites
        )

    def measure(
        self,
        batch: Batch,
        semantics: Convention = "truncated",
        at: When = "start",
        starts: Integers | None = None,
        named: bool = False,
        threads: int = 1,
        samples_in_block: int = 24_000,
    ) -> Margins[Key]:
        """Return the margin of every formula; arguments and errors as in ``evaluate``."""
        check_starts(starts, batch.lengths)
        if starts is not None and at == "start" and self._looks_back:
            return self.measure(batch.from_starts(starts), semantics, named=named, threads=threads)
        given = _given(batch)
        comparisons = tuple(self._comparisons(given))
        program = margin_program(comparisons)
        margins = {name: no_margin(batch, at) for name in self.plain}
        named_margins = {name: no_margin(batch, "all") for name in self.named} if named else {}

        def measure_block(columns: slice) -> None:
            """Measure the traces in ``columns`` and store their margins."""
            evaluation = self._margin_evaluation(batch, given, comparisons, program, columns)
            begin = None if starts is None else starts[columns]
            for name, formula in self.plain.items():
                store_margin(margins[name], evaluation, formula, semantics, batch, columns, at, begin)
            for node, made in named_margins.items():
                store_margin(made, evaluation, self.named[node], semantics, batch, columns, "all", begin)

        with ThreadPoolExecutor(threads) as pool:
            for _ in pool.map(measure_block, trace_blocks(batch, samples_in_block)):
                pass
        return Margins(semantics, margins, named_margins)

    def rests_on(self, given: Iterable[Formula]) -> bool:
        """Return whether a batch needs only the truth of these state formulas. Raises ``InputError``."""
        return not any(True for _ in self._comparisons({without_names(formula) for formula in given}))

    def _margin_evaluation(
        self,
        batch: Batch,
        given: Mapping[Formula, Array],
        comparisons: tuple[Compare, ...],
        program: Bytecode,
        columns: slice,
    ) -> LatticeEvaluation:
        samples = int(batch.lengths[columns].max())
        leaves: dict[Formula, Array] = {g: as_margin(v[:samples, columns]) for g, v in given.items()}
        leaves |= observe_margins(comparisons, program, batch, columns)
        shape = (samples, columns.stop - columns.start)
        return LatticeEvaluation(MARGIN, leaves, margin_inside(batch, columns), batch.dt, shape, self.states)

    def _comparisons(self, given: Collection[Formula]) -> Iterator[Compare]:
        """Yield comparisons outside ``given``, each once. Raises ``InputError`` for open lane predicates."""
        seen: set[Formula] = set()
        waiting = list(self.plain.values())
        while waiting:
            current = waiting.pop()
            if current in seen or current in given:
                continue
            seen.add(current)
            match current:
                case Compare():
                    yield current
                case f.Occupies() | f.Some() | f.Every():
                    raise InputError(
                        f"the batch does not say where {_shown(current)} holds: "
                        "add it to the given formulas of the batch, or bind the formula to a road"
                    )
                case f.Truth() | f.Not() | f.And() | f.Or() | f.Application():
                    waiting.extend(f.children(current))
                case f.Until() | f.Since() | f.Eventually() | f.Always():
                    waiting.extend(f.children(current))
                case _:
                    assert_never(current)


def compile(formulas: Mapping[Key, Formula], shared: dict[Formula, Formula] | None = None) -> Monitor[Key]:
    """Return a monitor for formulas under names or values of the caller's choice, used in error messages.

    Every parameter must have its value (``with_values``); lanes may be open where the batch gives the truth
    of the formulas about them. ``shared``: sub-formulas of other monitors of the same batches, to which this
    one adds its own, so look-ups compare objects alone. Raises ``InputError``.
    """
    _check_closed(formulas)
    plain = dict(zip(formulas, f.hash_cons(formulas.values(), _unnamed, shared), strict=True))
    own = {(x.name, not x.vehicle): x for x in custom_signals_of(formulas.values())}.values()
    states = frozenset(x for x in f.subformulas(*plain.values()) if f.is_state(x))
    return Monitor(dict(formulas), plain, states, (*signals_of(formulas.values()), *own))


def _first_bits(
    evaluation: LatticeEvaluation, questions: Sequence[tuple[Formula, View]], traces: int
) -> NDArray[np.bool_]:
    """Return the truth of each formula and view at the first sample, shape (questions, traces)."""
    words = np.zeros((len(questions), evaluation.shape[1]), "<u8")
    for row, (formula, view) in zip(words, questions, strict=True):
        row[:] = evaluation.first(formula, view)
    return unpack(words, traces)


def _unnamed(formula: Formula) -> Formula:
    return formula.body if isinstance(formula, Application) else formula


def _check_closed(formulas: Mapping[Key, Formula]) -> None:
    whole = tuple(formulas.values())
    fine = all(map(_has_value, terms_of(*whole))) and all(
        map(_is_interval, (bounds_of(x) for part in f.subformulas(*whole) for x in f.intervals(part)))
    )
    for name, formula in () if fine else formulas.items():
        for term in terms_of(formula):
            for leaf in t.leaves(term):
                if isinstance(leaf, t.Parameter | t.Variable):
                    raise InputError(
                        f"{name}: a monitor needs numbers, but {leaf.name} has no value; substitute one first"
                    )
        for low, high in map(bounds_of, intervals_of(formula)):
            if not _is_interval((low, high)):
                raise InputError(
                    f"{name}: the interval [{low}, {high}] s must not start in the past nor be empty"
                )


def _has_value(term: t.Term) -> bool:
    return not any(isinstance(leaf, t.Parameter | t.Variable) for leaf in t.leaves(term))


def _is_interval(bounds: tuple[Fraction, Fraction | None]) -> bool:
    low, high = bounds
    return low >= 0 and (high is None or high >= low)


def _given(batch: Batch) -> dict[Formula, Array]:
    return {without_names(formula): values for formula, values in batch.given.items()}


def _shown(formula: Formula) -> str:
    match formula:
        case f.Occupies(vehicle, lanelet):
            return f"occ({vehicle}, {lanelet})"
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            return (
                f"{type(formula).__name__.lower()} {variable} in {domain.kind}({domain.of}): {_shown(body)}"
            )
        case _:  # open: longer formulas are not shown
            return "…"
