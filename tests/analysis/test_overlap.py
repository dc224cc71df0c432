"""Overlap: verdicts against the known list, and the evidence behind each checked apart."""

import json
from pathlib import Path

import pytest

from planting import plant
from roadproof.analysis import overlap
from roadproof.analysis.meeting import Meeting, Node, conjunctions, read_numbers
from roadproof.analysis.overlap import Asked, Entry, decide_group, groups_of, pairs_of, without_sectors
from roadproof.analysis.placing import Shown, show_elsewhere
from roadproof.cli.main import main
from roadproof.effort import Effort
from roadproof.errors import InputError, UsageError
from roadproof.evidence.certificate import read_certificate, refusal
from roadproof.evidence.witness import from_json, judge_file
from roadproof.prove.prover import prove
from roadproof.report.overlap import as_csv, as_matrix, draw_overlap
from roadproof.solve.smt import ask
from roadproof.spec.elaborate import apply_definition
from roadproof.spec.library import bundled_library
from roadproof.verdict import Verdict

BASE = bundled_library().select("base")


def node(number: int, set_name: str = "base") -> Node:
    return Node(number, set_name)


@pytest.fixture(scope="module")
def entries() -> dict[tuple[int, int], Entry]:
    """Pairs of every kind: exclusive, possible, and with one disturbance on two road sectors."""
    asked = Asked()
    wanted = {(4, 5), (5, 12), (4, 8), (4, 16), (4, 24), (8, 12), (12, 24), (4, 12), (12, 20)}
    pairs = [pair for pair in pairs_of(asked) if (pair[0].number, pair[1].number) in wanted]
    found = [entry for seed, group in groups_of(asked, pairs) for entry in decide_group(asked, seed, group)]
    return {(entry.a.number, entry.b.number): entry for entry in found}


def test_the_known_pairs_come_out(entries: dict[tuple[int, int], Entry]) -> None:
    impossible = {pair for pair, entry in entries.items() if entry.verdict is Verdict.IMPOSSIBLE}
    assert impossible == {(4, 5), (5, 12)}
    assert {entry.verdict for pair, entry in entries.items() if pair not in impossible} == {Verdict.WITNESSED}
    assert len(entries) == 9


def test_every_drive_is_one_of_its_own_pair(entries: dict[tuple[int, int], Entry]) -> None:
    for (a, b), entry in entries.items():
        if entry.verdict is Verdict.WITNESSED:
            assert entry.drive is not None
            file = from_json(dict(entry.drive), "drive")
            assert set(file.formula.split(" and ")) == {f"scenario_{n}(SV,POV,L)" for n in (a, b)}
            assert judge_file(file, bundled_library()).accepted


def test_every_certificate_proves_its_own_pair(entries: dict[tuple[int, int], Entry], tmp_path: Path) -> None:
    for (a, b), entry in entries.items():
        if entry.verdict is Verdict.IMPOSSIBLE:
            assert entry.certificate is not None
            path = tmp_path / "certificate.json"
            path.write_text(entry.certificate)
            certificate = read_certificate(path)
            assert f"scenario_{a}(SV,POV,L)" in certificate.claim
            assert f"scenario_{b}(SV,POV,L)" in certificate.claim
            assert certificate.claim.startswith("not (")
            assert refusal(certificate, bundled_library(), ask) is None


BOTH_ROLES = Asked(meeting=Meeting(roles="any"))


def decided(a: int, b: int) -> Entry:
    """The answer for a pair in either role, which is two readings of how they meet."""
    ((seed, group),) = groups_of(BOTH_ROLES, [(node(a), node(b))])
    return decide_group(BOTH_ROLES, seed, group)[0]


def is_proved_of_every_reading(entry: Entry) -> bool:
    """Whether the certificate is about every way in which the pair might meet, and so are the cores."""
    assert entry.certificate is not None
    readings = conjunctions(BASE, entry.a, entry.b, BOTH_ROLES.meeting)
    claim = json.loads(entry.certificate)["claim"]
    cores = [core.formula for core in entry.cores]
    return claim == " and ".join(f"not ({x})" for x in readings) and cores == list(readings)


def test_impossible_is_proved_of_every_reading() -> None:
    entry = decided(5, 6)
    assert entry.verdict is Verdict.IMPOSSIBLE
    assert len(conjunctions(BASE, node(5), node(6), BOTH_ROLES.meeting)) == 2
    assert is_proved_of_every_reading(entry)


def test_one_reading_that_is_impossible_does_not_make_the_pair_so() -> None:
    first, second = conjunctions(BASE, node(3), node(8), BOTH_ROLES.meeting)
    assert prove(BASE, f"not ({first})", Effort(5.0)).verdict is Verdict.PROVED
    entry = decided(3, 8)
    assert (entry.verdict, entry.formula) == (Verdict.WITNESSED, second)


@pytest.mark.parametrize("kept", ["texts[:1]", "texts[1:]"])
def test_a_proof_of_one_reading_only_is_noticed(kept: str, monkeypatch: pytest.MonkeyPatch) -> None:
    right = 'f"not ({x})" for x in texts'
    plant(monkeypatch, overlap._Deciding, "_impossible", right, right.replace("texts", kept))
    assert not is_proved_of_every_reading(decided(5, 6))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [("x for x in texts if", "x for x in texts[:1] if"), ("if not left:", "if len(left) < len(texts):")],
)
def test_a_reading_that_is_forgotten_is_noticed(
    right: str, wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    plant(monkeypatch, overlap._Deciding, "decide", right, wrong)
    assert decided(3, 8).verdict is not Verdict.WITNESSED


def test_a_core_clashes_by_itself(entries: dict[tuple[int, int], Entry]) -> None:
    for entry in entries.values():
        for core in entry.cores:
            claim = f"not ({' and '.join(f'({part})' for part in core.parts)})"
            assert prove(BASE, claim, Effort(5.0)).verdict is Verdict.PROVED
            assert len(core.parts) < 8


def test_a_drive_is_not_taken_for_what_it_does_not_show(entries: dict[tuple[int, int], Entry]) -> None:
    drive = entries[4, 8].drive
    assert drive is not None
    shown = Shown(entries[4, 8].formula, dict(drive))
    library = bundled_library()
    assert show_elsewhere(shown, "scenario_20(SV,POV,L) and scenario_8(SV,POV,L)", library) is not None
    assert show_elsewhere(shown, "scenario_4(SV,POV,L) and not scenario_4(SV,POV,L)", library) is None
    assert show_elsewhere(shown, "scenario_3(SV,POV,L)", library) is None


def test_groups_leave_no_pair_out_and_solve_36() -> None:
    asked = Asked()
    pairs = pairs_of(asked)
    groups = groups_of(asked, pairs)
    assert len(pairs) == 276
    assert len(groups) == 36
    grouped = [frozenset(pair) for _, group in groups for pair in group]
    assert len(grouped) == 276
    assert set(grouped) == {frozenset(pair) for pair in pairs}


def test_rows_that_differ_in_more_than_their_sector_are_kept_apart() -> None:
    bare = {n: without_sectors(apply_definition(BASE, f"scenario_{n}").formula) for n in range(1, 25)}
    assert bare[4] == bare[12] == bare[20]
    assert len(set(bare.values())) == 8


def test_how_scenarios_may_meet() -> None:
    assert conjunctions(BASE, node(3), node(4), Meeting()) == (
        "scenario_3(SV,POV,L) and scenario_4(SV,POV,L)",
    )
    assert conjunctions(BASE, node(3), node(2), Meeting()) == (
        "scenario_3(SV,POV1,L) and scenario_2(SV,POV1,POV2,L)",
        "scenario_3(SV,POV2,L) and scenario_2(SV,POV1,POV2,L)",
    )
    assert conjunctions(BASE, node(1), node(4), Meeting("any", "any")) == (
        "scenario_1(SV,POV,L) and scenario_4(SV,POV,L2)",
        "scenario_1(SV,POV,L) and scenario_4(POV,SV,L2)",
    )
    assert conjunctions(BASE, node(1), node(4), Meeting(start="any")) == (
        "scenario_1(SV,POV,L) and F scenario_4(SV,POV,L)",
        "scenario_4(SV,POV,L) and F scenario_1(SV,POV,L)",
    )
    across = conjunctions(BASE, node(1), node(1, "ext"), Meeting())
    assert across == ("scenario_1(SV,POV,L) and scenario_1@ext(SV,POV,L)",)
    assert len(conjunctions(BASE, node(2), node(10), Meeting(roles="any"))) == 6


def test_across_sets_every_scenario_meets_every_other() -> None:
    asked = Asked(sets=("base", "ext"))
    assert len(pairs_of(asked)) == 576
    entry = decide_group(asked, *groups_of(asked, [(node(1), node(3, "ext"))])[0])[0]
    assert (entry.a.set_name, entry.b.set_name) == ("base", "ext")
    assert entry.verdict in (Verdict.WITNESSED, Verdict.IMPOSSIBLE)


def test_numbers() -> None:
    assert read_numbers("1,3-5", BASE) == (1, 3, 4, 5)
    with pytest.raises(InputError, match="25"):
        read_numbers("20-25", BASE)
    with pytest.raises(UsageError, match="range"):
        read_numbers("one", BASE)


def test_the_command_writes_what_it_promises_and_goes_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    line = ["overlap", "--among", "4-6", "--out", str(out), "--jobs", "1", "--json", "-", "--no-pictures"]
    assert main(line) == 0
    data = json.loads(capsys.readouterr().out)
    assert (data["schema"], data["set"]) == ("roadproof/overlap/1", "base")
    by_pair = {(x["a"], x["b"]): x for x in data["verdicts"]}
    assert {pair: x["verdict"] for pair, x in by_pair.items()} == {
        (4, 5): "IMPOSSIBLE",
        (4, 6): "WITNESSED",
        (5, 6): "IMPOSSIBLE",
    }
    assert by_pair[5, 6]["core"] == ["not sameLane(POV, SV, L)", "sameLane(POV, SV, L)"]
    assert main(["check", str(out), "--jobs", "1"]) == 0
    assert "3 of 3 accepted" in capsys.readouterr().out
    # One answer lost with its evidence, one line cut short: both are asked again, the third is not.
    lines = (out / "answers.jsonl").read_text().splitlines()
    kept = json.loads(lines[3])["verdict"]
    Path(by_pair[4, 5]["certificate"]).unlink()
    (out / "answers.jsonl").write_text("\n".join([*lines[:2], lines[3], lines[2][:50]]))
    assert main(line) == 0
    again = {(x["a"], x["b"]): x for x in json.loads(capsys.readouterr().out)["verdicts"]}
    assert {pair: x["verdict"] for pair, x in again.items()} == {p: x["verdict"] for p, x in by_pair.items()}
    assert again[kept["a"], kept["b"]]["seconds"] == kept["seconds"]
    assert main([*line, "--start", "any"]) == 2
    assert "another question" in capsys.readouterr().err


def verdict(a: int, b: int, name: str, *core: str) -> dict[str, object]:
    cores = [{"formula": "", "parts": list(core)}] if core else []
    shown = {"a": a, "b": b, "set_a": "base", "set_b": "base", "verdict": name, "formula": "p and q"}
    return {**shown, "core": list(core), "cores": cores, "certificate": None, "drive": None, "reason": ""}


def test_the_matrix_is_symmetric_within_a_set_only() -> None:
    answers = [
        verdict(1, 4, "IMPOSSIBLE", "p", "not p"),
        verdict(1, 5, "WITNESSED"),
        verdict(4, 5, "UNKNOWN"),
    ]
    rows = as_matrix(answers, across=False).splitlines()
    assert rows[:4] == ["      1  4  5", "   1     .  #", "   4  .     ?", "   5  #  ?   "]
    assert as_matrix(answers, across=True).splitlines()[:3] == ["      4  5", "   1  .  #", "   4     ?"]
    assert as_csv(answers).splitlines()[1] == "1,4,base,base,IMPOSSIBLE,p and q,p; not p,,"


def test_the_heat_map_shows_every_core_once() -> None:
    pytest.importorskip("matplotlib")
    core = ("initSafe(SV, POV)", "not sameLane(POV, SV, L)")
    answers = [
        verdict(1, 3, "IMPOSSIBLE", *core),
        verdict(1, 4, "IMPOSSIBLE", *core),
        verdict(3, 4, "WITNESSED"),
    ]
    drawn = draw_overlap(answers, "title", across=False)
    assert drawn["png"].startswith(b"\x89PNG")
    assert drawn["svg"].count(b"not sameLane") == 1


def test_evidence_lies_beside_a_json_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "answers"
    assert main(["overlap", "--among", "5,6", "--jobs", "1", "--json", str(target)]) == 0
    (answer,) = json.loads(target.read_text())["verdicts"]
    assert Path(answer["certificate"]).parent == tmp_path / "answers-evidence"
    assert main(["check", answer["certificate"]]) == 0


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        (["--among", "4"], 2, "at least two scenarios"),
        (["--among", "4,99"], 3, "no scenario '99'"),
        (["--set", "base", "--set", "base"], 2, "two different ones"),
        (["--set", "bas"], 3, "did you mean 'base'"),
        (["--timeout", "0"], 2, "greater than 0"),
    ],
)
def test_mistakes(line: list[str], code: int, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["overlap", *line]) == code
    assert said in capsys.readouterr().err
