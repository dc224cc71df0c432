"""Overlap: verdicts against the known list, and the evidence behind each checked apart."""

import json
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import pytest

from engine_calls import prove
from extensions.pages.report.edges import cut_off
from rejection import rejection_reason
from roadproof.engines.search.placing import place_on_known_roads
from roadproof.engines.solve.smt import check_sat
from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.certificate_file import read_certificate
from roadproof.evidence.judged import JudgedDrive, judge_file
from roadproof.extensions.surveys.report.overlap_picture import draw_overlap, sectors_among
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.figures import as_bytes
from roadproof.frontends.report.overlap import as_matrix, as_text, sheet_of
from roadproof.frontends.report.sheet import as_csv
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.scenario_references import read_numbers
from roadproof.library.scenarios import Scenario, without_sectors
from roadproof.library.specification import Query
from roadproof.library.words import Words, words_by_number
from roadproof.logic.formula import Not
from roadproof.logic.parts import parts_of
from roadproof.questions.basis import Basis
from roadproof.questions.decide import decide_claims
from roadproof.questions.overlap import Meeting, OverlapQuestion, PairVerdict, conjunctions, name_of, pairs_of
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

BASE = bundled_library().select("base")
WORDS = words_by_number(BASE)
BASIS = Basis(BASE)
PROOF = read_certificate(Path(__file__).parents[2] / "proofs/P4-scenario-03-base.json")


def node(number: int, set_name: str = "base") -> Scenario:
    return Scenario(number, set_name)


def texts(queries: tuple[Query, ...]) -> tuple[str, ...]:
    return tuple(query.text for query in queries)


@pytest.fixture(scope="module")
def entries() -> dict[tuple[int, int], PairVerdict]:
    """Pairs of every kind: exclusive, possible, and with one disturbance on two road sectors."""
    wanted = {(4, 5), (5, 12), (4, 8), (4, 16), (4, 24), (8, 12), (12, 24), (4, 12), (12, 20)}
    question = OverlapQuestion(BASIS, Meeting(among=(4, 5, 8, 12, 16, 20, 24)))
    pairs = tuple(x for x in question.pairs if (x[0].number, x[1].number) in wanted)
    vars(question)["pairs"] = pairs
    found = question.view(decide_claims(question, executor=1).answers).pairs
    return {(entry.a.number, entry.b.number): entry for entry in found}


def test_the_known_pairs_come_out(entries: dict[tuple[int, int], PairVerdict]) -> None:
    impossible = {pair for pair, entry in entries.items() if entry.verdict is Verdict.IMPOSSIBLE}
    assert impossible == {(4, 5), (5, 12)}
    assert {entry.verdict for pair, entry in entries.items() if pair not in impossible} == {Verdict.WITNESSED}
    assert len(entries) == 9


def test_every_drive_is_one_of_its_own_pair(entries: dict[tuple[int, int], PairVerdict]) -> None:
    for (a, b), entry in entries.items():
        if entry.verdict is Verdict.WITNESSED:
            assert entry.drive is not None
            file = entry.drive.file
            assert set(file.formula.split(" and ")) == {f"scenario_{n}(SV, POV, L)" for n in (a, b)}
            assert judge_file(file, bundled_library()).accepted


def test_every_certificate_proves_that_parts_of_its_pair_clash(
    entries: dict[tuple[int, int], PairVerdict],
) -> None:
    for entry in entries.values():
        if entry.verdict is Verdict.IMPOSSIBLE:
            [(name, answer)] = entry.evidence.items()
            proof = answer.certificate
            assert proof is not None
            assert rejection_reason(proof, bundled_library(), check_sat) is None
            denied = read_claim(BASE, proof.claim).formula
            assert isinstance(denied, Not)
            assert {*parts_of(denied.body)} <= {*parts_of(entry.claims[name].formula)}
            assert len({*parts_of(denied.body)}) < 8


BOTH_ROLES = Meeting(roles="any")


def decided(a: int, b: int) -> PairVerdict:
    """The answer for a pair in either role, which is two readings of how they meet."""
    question = OverlapQuestion(BASIS, replace(BOTH_ROLES, among=(a, b)))
    [pair] = question.view(decide_claims(question).answers).pairs
    return pair


def test_impossible_is_proved_of_every_reading() -> None:
    entry = decided(5, 6)
    readings = conjunctions(BASE, node(5), node(6), BOTH_ROLES)
    assert entry.verdict is Verdict.IMPOSSIBLE
    assert len(readings) == len(entry.evidence) == 2
    assert [core.whole for core in entry.cores] == list(readings)


def test_one_reading_that_is_impossible_does_not_make_the_pair_so() -> None:
    first, second = conjunctions(BASE, node(3), node(8), BOTH_ROLES)
    assert prove(BASE, f"not ({first.text})", Effort(5.0)).verdict is Verdict.PROVED
    entry = decided(3, 8)
    assert (entry.verdict, entry.query) == (Verdict.WITNESSED, second)


def test_a_core_clashes_by_itself(entries: dict[tuple[int, int], PairVerdict]) -> None:
    for entry in entries.values():
        for core in entry.cores:
            claim = f"not ({' and '.join(f'({x})' for x in core.parts)})"
            assert prove(BASE, claim, Effort(5.0)).verdict is Verdict.PROVED


def test_pairs_that_differ_in_road_sectors_only_clash_in_the_words_of_the_first() -> None:
    question = OverlapQuestion(BASIS, Meeting(among=(1, 8, 16)))
    lanes, other = "not sameLane(POV, SV, L)", "atLane(SV, L)"
    parts = {
        "base-01-base-08": (lanes, "initialCondition_8(SV, POV, L)"),
        "base-01-base-16": (lanes, "initialCondition_16(SV, POV, L)"),
    }
    claims = {name: claim for named in question.claims.values() for name, claim in named.items()}

    def cores() -> list[tuple[str, ...]]:
        known = {
            name: ClaimAnswer(claims[name], replace(PROOF, claim=f"not ({' and '.join(x)})"))
            for name, x in parts.items()
        }
        return [x.core_texts for x in question.view(known).pairs if x.cores]

    assert cores() == [parts["base-01-base-08"]] * 2
    parts["base-01-base-16"] = (lanes, other)
    assert cores() == [*parts.values()]


def test_a_drive_is_not_taken_for_what_it_does_not_show(entries: dict[tuple[int, int], PairVerdict]) -> None:
    drive = entries[4, 8].drive
    assert drive is not None

    def shows(text: str) -> bool:
        return place_on_known_roads(drive.file, read_claim(BASE, text), bundled_library()) is not None

    assert shows("scenario_20(SV,POV,L) and scenario_8(SV,POV,L)")
    assert not shows("scenario_4(SV,POV,L) and not scenario_4(SV,POV,L)")
    assert not shows("scenario_3(SV,POV,L)")


def test_batches_leave_no_pair_out_and_are_36() -> None:
    question = OverlapQuestion(BASIS)
    batches = question.batches({})
    assert len(question.pairs) == 276
    assert len(batches) == 36
    every = sorted(name for batch in batches for claims in batch.pairs for name in claims)
    assert every == sorted(name for claims in question.claims.values() for name in claims)


def test_rows_that_differ_in_more_than_their_sector_are_kept_apart() -> None:
    bare = {n: without_sectors(apply_definition(BASE, f"scenario_{n}").formula) for n in range(1, 25)}
    assert bare[4] == bare[12] == bare[20]
    assert len(set(bare.values())) == 8


def test_how_scenarios_may_meet() -> None:
    assert texts(conjunctions(BASE, node(3), node(4), Meeting())) == (
        "scenario_3(SV, POV, L) and scenario_4(SV, POV, L)",
    )
    assert texts(conjunctions(BASE, node(3), node(2), Meeting())) == (
        "scenario_3(SV, POV1, L) and scenario_2(SV, POV1, POV2, L)",
        "scenario_3(SV, POV2, L) and scenario_2(SV, POV1, POV2, L)",
    )
    assert texts(conjunctions(BASE, node(1), node(4), Meeting(lanes="any", roles="any"))) == (
        "scenario_1(SV, POV, L) and scenario_4(SV, POV, L2)",
        "scenario_1(SV, POV, L) and scenario_4(POV, SV, L2)",
    )
    assert texts(conjunctions(BASE, node(1), node(4), Meeting(start="any"))) == (
        "scenario_1(SV, POV, L) and F scenario_4(SV, POV, L)",
        "scenario_4(SV, POV, L) and F scenario_1(SV, POV, L)",
    )
    across = conjunctions(BASE, node(1), node(1, "ext"), Meeting())
    assert texts(across) == ("scenario_1(SV, POV, L) and scenario_1@ext(SV, POV, L)",)
    assert len(conjunctions(BASE, node(2), node(10), Meeting(roles="any"))) == 6


def test_across_sets_every_scenario_meets_every_other() -> None:
    basis = Basis(BASE, ("base", "ext"))
    assert len(pairs_of(basis)) == 576
    question = OverlapQuestion(basis, Meeting(among=(1, 3)))
    vars(question)["pairs"] = ((node(1), node(3, "ext")),)
    [entry] = question.view(decide_claims(question).answers).pairs
    assert (entry.a.set_name, entry.b.set_name) == ("base", "ext")
    assert entry.verdict in (Verdict.WITNESSED, Verdict.IMPOSSIBLE)


def test_numbers() -> None:
    assert read_numbers(BASE, "1,3-5, scenario_7") == (1, 3, 4, 5, 7)
    with pytest.raises(InputError, match="25"):
        read_numbers(BASE, "20-25")
    with pytest.raises(UsageError, match="range"):
        read_numbers(BASE, "one")


def test_the_command_writes_what_it_promises_and_goes_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    line = ["overlap", "--among", "4-6", "--out", str(out), "--jobs", "1", "--json", "-", "--no-pictures"]
    assert main(line) == 0
    data = json.loads(capsys.readouterr().out)
    assert (data["schema"], data["set"]) == ("roadproof/overlap/2", "base")
    by_pair = {(x["a"], x["b"]): x for x in data["verdicts"]}
    assert {pair: x["verdict"] for pair, x in by_pair.items()} == {
        (4, 5): "IMPOSSIBLE",
        (4, 6): "WITNESSED",
        (5, 6): "IMPOSSIBLE",
    }
    assert by_pair[5, 6]["core"] == ["not sameLane(POV, SV, L)", "sameLane(POV, SV, L)"]
    assert main(["check", str(out), "--jobs", "1"]) == 0
    assert "3 of 3 accepted" in capsys.readouterr().out
    # One answer lost, one file cut short: both are asked again, the third is not.
    files = {pair: Path(x["evidence"][0]) for pair, x in by_pair.items()}
    before = {pair: (path.read_bytes(), path.stat().st_mtime_ns) for pair, path in files.items()}
    files[4, 5].unlink()
    files[5, 6].write_text(files[5, 6].read_text()[:50])
    assert main(line) == 0
    again = {(x["a"], x["b"]): x for x in json.loads(capsys.readouterr().out)["verdicts"]}
    assert again == by_pair
    after = {pair: (path.read_bytes(), path.stat().st_mtime_ns) for pair, path in files.items()}
    assert {pair: x for pair, (x, _) in after.items()} == {pair: x for pair, (x, _) in before.items()}
    assert after[4, 6] == before[4, 6]
    assert main([*line, "--start", "any"]) == 2
    assert "another question" in capsys.readouterr().err


def verdict(a: int, b: int, name: str, *core: str) -> PairVerdict:
    """A pair with a verdict; of an IMPOSSIBLE the parts that clash."""
    parts = core or ("aheadOf(SV, POV)", "not aheadOf(SV, POV)")
    query = read_claim(BASE, " and ".join((*parts, "true")))
    claim = BASIS.claim(query)
    match Verdict(name):
        case Verdict.WITNESSED:
            drive: JudgedDrive = object.__new__(JudgedDrive)
            answer = ClaimAnswer(claim, drive)
        case Verdict.IMPOSSIBLE:
            denied = f"not ({' and '.join(parts)})"
            answer = ClaimAnswer(claim, replace(PROOF, claim=denied))
        case _:
            answer = undecided(claim, ReasonKind.TOLD("why"))
    pair = name_of(node(a), node(b))
    return PairVerdict(node(a), node(b), {pair: claim}, {pair: answer})


def test_the_matrix_is_symmetric_within_a_set_only() -> None:
    answers = [
        verdict(1, 4, "IMPOSSIBLE", "aheadOf(SV, POV)", "not aheadOf(SV, POV)"),
        verdict(1, 5, "WITNESSED"),
        verdict(4, 5, "UNKNOWN"),
    ]
    rows = as_matrix(answers, across=False).splitlines()
    assert rows[:4] == ["      1  4  5", "   1     .  #", "   4  .     ?", "   5  #  ?   "]
    assert as_matrix(answers, across=True).splitlines()[:3] == ["      4  5", "   1  .  #", "   4     ?"]
    assert as_csv(sheet_of(answers, WORDS)).splitlines()[1] == (
        '1,4,base,base,IMPOSSIBLE,"not (aheadOf(SV, POV) and not aheadOf(SV, POV) and true)",'
        '"aheadOf(SV, POV); not aheadOf(SV, POV)",,base-01-base-04.json,'
        '"cut-in, lane keep, main road","deceleration ahead, lane keep, main road"'
    )


def test_the_heat_map_shows_every_core_once() -> None:
    pytest.importorskip("matplotlib")
    core = ("initSafe(SV, POV)", "not sameLane(POV, SV, L)")
    answers = [
        verdict(1, 3, "IMPOSSIBLE", *core),
        verdict(1, 4, "IMPOSSIBLE", *core),
        verdict(3, 4, "WITNESSED"),
    ]
    drawn = as_bytes(draw_overlap(answers, "title", False, WORDS))
    assert drawn["png"].startswith(b"\x89PNG")
    assert drawn["svg"].count(b"not sameLane") == 1


def test_the_heat_map_is_one_triangle_with_names_in_groups() -> None:
    answers = [verdict(a, b, "WITNESSED") for a, b in combinations((1, 4, 9, 12), 2)]
    figure = draw_overlap(answers, "title", False, WORDS)
    assert cut_off(figure) == []
    axes, _ = figure.axes
    assert [x.get_text() for x in axes.get_yticklabels()] == [
        "4  deceleration ahead, lane keep",
        "9  cut-in, lane keep",
        "12  deceleration ahead, lane keep",
    ]
    assert [x.get_text() for x in axes.get_xticklabels()] == ["1", "4", "9"]
    assert len(axes.patches) == 6 + 1  # the cells, and what the colour means
    groups = ["main road", "merge zone"]
    assert [x.get_text() for x in axes.texts] == [*groups, *groups]
    across, _ = draw_overlap(answers, "title", True, WORDS).axes
    assert (across.get_ylabel(), across.get_xlabel()) == ("set base", "set base")
    assert sectors_among((1, 4, 9, 99), {**WORDS, 99: Words(99)}) == [
        (0, 2, "main road"),
        (2, 3, "merge zone"),
    ]


def test_the_text_says_what_numbers_mean() -> None:
    told = as_text([verdict(1, 4, "WITNESSED")], False, words_by_number(BASE, (1, 4))).splitlines()
    assert told[-3:] == ["  1: cut-in, lane keep", "  4: deceleration ahead, lane keep", "  1, 4: main road"]


def test_evidence_lies_beside_a_json_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "answers"
    assert main(["overlap", "--among", "5,6", "--jobs", "1", "--json", str(target)]) == 0
    (answer,) = json.loads(target.read_text())["verdicts"]
    [file] = answer["evidence"]
    assert Path(file).parent == tmp_path / "answers-evidence"
    assert main(["check", file]) == 0


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        (["--among", "4"], 2, "at least two scenarios"),
        (["--among", "4,99"], 3, "no scenario 99"),
        (["--set", "base", "--set", "base"], 2, "a spec set is repeated"),
        (["--set", "bas"], 3, "did you mean 'base'"),
        (["--timeout", "0"], 2, "greater than 0"),
    ],
)
def test_mistakes(line: list[str], code: int, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["overlap", *line]) == code
    assert said in capsys.readouterr().err
