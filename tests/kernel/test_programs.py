"""Coq accepts trees that refute programs, and refuses others."""

from evidence.test_none_within import QUESTIONS, none_within
from evidence.trees import RIGHT, WRONG
from kernel.needs import needs_coq
from roadproof.engines.search.none_within import derive
from roadproof.evidence.kernel.accept import AXIOMS, Word, judge
from roadproof.evidence.kernel.coq import ready
from roadproof.evidence.kernel.programs import prepare
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library


@needs_coq
def test_trees_are_accepted_or_refused_as_python_says():
    every = RIGHT | WRONG
    modules = {f"m{k}": prepare(f"m{k}", [told], [pair]) for k, (told, pair) in enumerate(every.items())}
    with ready() as coq:
        found = judge(coq, modules).rulings
    for told, name in zip(every, modules, strict=True):
        assert found[name].word is (Word.ACCEPTED if told in RIGHT else Word.REFUSED), (told, found[name])
    assert set(found["m0"].axioms) <= AXIOMS


@needs_coq
def test_questions_are_accepted_with_two_assignments_of_lanes_too():
    modules = {}
    for k, what in enumerate(QUESTIONS):
        file = none_within(what)
        derived = derive(file, bundled_library())
        trees = (tree for _, tree in file.refutations)
        modules[f"m{k}"] = prepare(f"m{k}", [what], [*zip(derived.programs, trees, strict=True)])
    with ready() as coq:
        found = judge(coq, modules).rulings
    assert [found[name].word for name in modules] == [Word.ACCEPTED] * len(QUESTIONS)


@needs_coq
def test_from_the_command_line(tmp_path, capsys):
    out = str(tmp_path / "out")
    main(["witness", "v_lon(SV) > 41 m/s", "--horizon", "1.8", "--out", out, "--jobs", "1"])
    assert main(["check", out, "--kernel", "coq", "--jobs", "1"]) == 0
    assert "NONE-WITHIN base  v_lon(SV) > 41 m/s  [kernel: accepted; no drive" in capsys.readouterr().out
