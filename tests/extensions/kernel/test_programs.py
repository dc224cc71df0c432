"""Coq and the extracted program accept trees that refute programs, and refuse others."""

from collections import Counter
from dataclasses import replace
from functools import cache

import pytest

from evidence.test_none_within import QUESTIONS, none_within
from evidence.trees import RIGHT, WRONG
from extensions.kernel.needs import needs_coq, needs_ocaml
from extensions.kernel.reading import sort_out
from roadproof.engines.search.none_within import derive
from roadproof.evidence.kernels import KernelVerdict
from roadproof.evidence.program import CaseSplit, ColumnSplit, WeightedSum, refutes
from roadproof.extensions.kernel import accept, coq, extracted, ocaml
from roadproof.extensions.kernel.accept import AXIOMS
from roadproof.extensions.kernel.programs import form, prepare
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library

ONE = next(iter(RIGHT.items()))
KERNELS = [pytest.param("coq", marks=needs_coq), pytest.param("extracted", marks=needs_ocaml)]


def rulings(kernel, questions):
    """What a kernel says of each list of programs with their trees, in their order."""
    written = prepare if kernel == "coq" else form
    modules = {f"m{k}": written(f"m{k}", [told], pairs) for k, (told, pairs) in enumerate(questions)}
    if kernel == "coq":
        with coq.ready() as found:
            said = accept.judge(found, modules).rulings
    else:
        with ocaml.ready() as program:
            said = extracted.judge(program, modules).rulings
    return [said[name] for name in modules]


@cache
def asked():
    """The questions with the programs of each and its trees."""
    found = []
    for what in QUESTIONS:
        file = none_within(what)
        trees = (tree for _, tree in file.refutations)
        found.append((what, [*zip(derive(file, bundled_library()).programs, trees, strict=True)]))
    return found


@needs_ocaml
def test_the_program_accepts_or_refuses_trees_as_python_says():
    every = RIGHT | WRONG
    found = rulings("extracted", [(told, [pair]) for told, pair in every.items()])
    for told, ruling in zip(every, found, strict=True):
        assert ruling.verdict is (KernelVerdict.ACCEPTED if told in RIGHT else KernelVerdict.REFUSED), (
            told,
            ruling,
        )


@needs_coq
def test_coq_accepts_or_refuses_trees_as_python_says():
    first = next(iter(WRONG))
    refused, *accepted = rulings("coq", [(x, [(RIGHT | WRONG)[x]]) for x in (first, *RIGHT)])
    assert refused.verdict is KernelVerdict.REFUSED, first
    assert [x.verdict for x in accepted] == [KernelVerdict.ACCEPTED] * len(RIGHT)
    assert set(accepted[0].axioms) <= AXIOMS
    right, *wrong = (
        prepare(f"m{k}", [x], [pair]).module for k, (x, pair) in enumerate([ONE, *WRONG.items()])
    )
    sort_out([right], wrong)
    with pytest.raises(AssertionError, match="The command has not failed"):
        sort_out([], [*wrong, right])


@pytest.mark.parametrize("kernel", KERNELS)
def test_questions_are_accepted_with_two_assignments_of_lanes_too(kernel):
    assert max(len(pairs) for _, pairs in asked()) > 1
    assert [x.verdict for x in rulings(kernel, asked())] == [KernelVerdict.ACCEPTED] * len(QUESTIONS)


def branches(tree):
    match tree:
        case WeightedSum():
            return ()
        case CaseSplit(_, trees):
            return trees
        case ColumnSplit(_, _, low, high):
            return (low, high)


def with_branches(tree, found):
    if isinstance(tree, CaseSplit):
        return replace(tree, trees=found)
    return replace(tree, low=found[0], high=found[1])


def spoiled(tree):
    """The tree with each multiplier left out or negated, with each branch missing, with other cuts."""
    if isinstance(tree, WeightedSum):
        for k, (fact, weight) in enumerate(tree.weights):
            for other in (0, -weight):
                yield "multiplier", WeightedSum((*tree.weights[:k], (fact, other), *tree.weights[k + 1 :]))
    if isinstance(tree, ColumnSplit):
        yield "cut", replace(tree, column=tree.column + 1)
    each = branches(tree)
    for k, part in enumerate(each):
        if isinstance(tree, CaseSplit):
            yield "branch", replace(tree, trees=(*each[:k], *each[k + 1 :]))
        for kind, other in spoiled(part):
            yield kind, with_branches(tree, (*each[:k], other, *each[k + 1 :]))


def widened(program):
    """The program with more room for one column."""
    for k, (low, high) in enumerate(program.box):
        for ends in ((low - 1000 * program.scale, high), (low, high + 1000 * program.scale)):
            yield "bound", replace(program, box=(*program.box[:k], ends, *program.box[k + 1 :]))


@needs_ocaml
def test_with_another_multiplier_branch_or_bound_the_program_refuses_what_python_does():
    others = []
    for what, pairs in asked():
        *rest, (program, tree) = pairs
        others += [(kind, what, [*rest, (program, other)]) for kind, other in spoiled(tree)]
        others += [(kind, what, [*rest, (other, tree)]) for kind, other in widened(program)]
    truths = [all(refutes(*pair) for pair in pairs) for _, _, pairs in others]
    said = rulings("extracted", [(what, pairs) for _, what, pairs in others])
    assert [x.verdict for x in said] == [
        KernelVerdict.ACCEPTED if right else KernelVerdict.REFUSED for right in truths
    ]
    refused = Counter(kind for (kind, _, _), right in zip(others, truths, strict=True) if not right)
    assert min(refused[kind] for kind in ("multiplier", "branch", "bound")) >= 7, refused


@pytest.mark.parametrize("kernel", KERNELS)
def test_from_the_command_line(kernel, tmp_path, capsys):
    out = str(tmp_path / "out")
    main(["witness", "v_lon(SV) > 41 m/s", "--horizon", "1.8", "--out", out, "--jobs", "1"])
    assert main(["check", out, "--kernel", kernel, "--jobs", "1"]) == 0
    assert "NONE-WITHIN base  v_lon(SV) > 41 m/s  [kernel: accepted; no drive" in capsys.readouterr().out
