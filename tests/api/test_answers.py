"""Every question once, through both doors: the answers are the same, and can do what every answer can."""

import json
import os
import shlex
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, dataclass, fields, replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

import roadproof as rp
from api.doors import ASKED, FALSE, MINE, SYMMETRIC, Asked, tell, without_clock, without_seconds
from roadproof.analysis.claims import name_of
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.refutation import Countermodel
from roadproof.frontends.api.answer import Answer
from roadproof.verdict import Verdict

# What each answer says and shows, in order.
SHOWS = {
    "prove": ("PROVED REFUTED", (Certificate, JudgedDrive)),
    "prove-property": ("PROVED PROVED PROVED", (Certificate,) * 3),
    "prove-bounded": ("PROVED-BOUNDED", ()),
    "witness": ("WITNESSED IMPOSSIBLE", (JudgedDrive, Certificate)),
    "witness-none": ("NONE-WITHIN", ()),
    "compare": ("PROVED PROVED", (Certificate, Certificate)),
    "compare-sets": ("PROVED REFUTED", (Certificate, JudgedDrive)),
    "overlap": ("IMPOSSIBLE", (Certificate,)),
    "order": ("REFUTED REFUTED", (JudgedDrive, JudgedDrive)),
    "redundancy": (" ".join(["REFUTED"] * 6), (JudgedDrive,) * 6),
    "coverage": (" ".join(["PROVED"] * 4), (Certificate,) * 4),
    "classify": ("WITNESSED WITNESSED PROVED PROVED PROVED", (JudgedDrive, JudgedDrive, *(Certificate,) * 3)),
    "explore-values": ("WITNESSED WITNESSED", (JudgedDrive, JudgedDrive)),
    "explore-measure": ("WITNESSED IMPOSSIBLE", (JudgedDrive, Certificate)),
}


@dataclass(frozen=True)
class Both:
    """An answer, and the command line's: exit code, text, and JSON."""

    name: str
    asked: Asked
    answer: Answer
    code: int
    text: str
    json: str


@pytest.fixture(scope="module", params=ASKED)
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Both]:
    here, before = tmp_path_factory.mktemp(request.param), Path.cwd()
    (here / "mine-1.spec").write_text(MINE)
    asked = ASKED[request.param]
    os.chdir(here)
    try:
        answer = asked.ask(Path("kept"))
        code, text, _ = tell(shlex.split(asked.line))
        _, data, _ = tell([*shlex.split(asked.line), "--json", "-"])
        yield Both(request.param, asked, answer, code, text, data)
    finally:
        os.chdir(before)


def test_it_is_what_the_command_line_prints(both: Both) -> None:
    assert without_clock(str(both.answer)) == without_clock(both.text)
    assert both.answer.exit_code == both.code


def test_its_data_are_the_json_of_the_command_line(both: Both) -> None:
    assert without_seconds(both.answer.as_data()) == without_seconds(json.loads(both.json))


def test_verdicts_and_evidence(both: Both) -> None:
    answer = both.answer
    assert all(isinstance(x, Verdict) for x in answer.verdicts.values())
    assert all(isinstance(x, Certificate | JudgedDrive | Countermodel) for x in answer.evidence)
    if both.name in SHOWS:
        verdicts, kinds = SHOWS[both.name]
        assert " ".join(answer.verdicts.values()) == verdicts
        assert tuple(map(type, answer.evidence)) == kinds
    if both.name == "coverage":
        assert answer.verdict is Verdict.COVERED
    elif len(answer.verdicts) == 1:
        assert answer.verdict is next(iter(answer.verdicts.values()))
    else:
        with pytest.raises(rp.UsageError, match=r"verdicts: use \.verdicts"):
            _ = answer.verdict


def test_what_is_saved_is_accepted(both: Both, tmp_path: Path) -> None:
    folder = both.answer.save(tmp_path / "saved", pictures=False)
    assert folder == tmp_path / "saved"
    if not [*folder.iterdir()]:
        assert not both.answer.evidence
        with pytest.raises(rp.UsageError, match="there is no evidence to check: 1 NONE-WITHIN"):
            both.answer.check()
        return
    checked = rp.check(folder, jobs=1)
    assert checked.accepted, str(checked)
    assert tell(["check", str(folder)])[1].strip() == str(checked)
    assert both.answer.check().counts == checked.counts


def test_frame(both: Both) -> None:
    rows, frame = both.answer.rows(), both.answer.to_frame()
    assert frame.columns == list(rows[0])
    assert frame.rows() == [tuple(row.values()) for row in rows]
    said = {str(x) for x in both.answer.verdicts.values()}
    assert {*frame["verdict"]} <= said


class Tags(HTMLParser):
    """What is open, and what was said."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.said: list[str] = []

    def handle_starttag(self, tag: str, attributes: object) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.said.append(data)


def test_html_is_escaped(both: Both) -> None:
    tags = Tags()
    tags.feed(both.answer._repr_html_())
    assert tags.open == []
    rows = both.answer.rows()
    assert {str(x) for row in rows for x in row.values() if isinstance(x, str) and x} <= {*tags.said}


def test_repr_is_short(both: Both) -> None:
    assert repr(both.answer).startswith(f"<{type(both.answer).__name__}: ")
    assert len(repr(both.answer)) < 100


def test_it_is_frozen(both: Both) -> None:
    for part in fields(both.answer):  # type: ignore[arg-type]
        with pytest.raises(FrozenInstanceError):
            setattr(both.answer, part.name, None)


def test_plot(both: Both, tmp_path: Path) -> None:
    if not both.asked.drawn:
        if not both.answer.pictures():
            with pytest.raises(rp.UsageError, match="there is no picture of"):
                both.answer.plot()
        return
    drawn = both.answer.plot()
    assert drawn._repr_png_().startswith(b"\x89PNG")
    assert drawn.save(tmp_path / "x.svg").read_bytes() == drawn.svg
    assert drawn.save(tmp_path / "x.png").read_bytes() == drawn.png
    assert repr(drawn) == "Picture()"
    with pytest.raises(rp.UsageError, match=r"ends in \.png or \.svg"):
        drawn.save(tmp_path / "x.jpg")


def test_what_rests_on_definitions_of_ones_own_is_accepted(tmp_path: Path) -> None:
    mine = rp.load(specs=["def fast(a: vehicle) := v_lon(a) > 30 m/s"])
    for k, answer in enumerate(
        (
            rp.prove("fast(SV) -> v_lon(SV) > 20 m/s", "fast(SV) -> fast(POV)", using=mine, jobs=1),
            rp.witness("fast(SV)", "fast(SV) and v_lon(SV) < 20 m/s", using=mine, jobs=1),
            rp.compare("fast(SV)", "v_lon(SV) > 20 m/s", mine),
        )
    ):
        assert answer.check().accepted
        assert len(answer.check().findings) == len(answer.evidence) == 2
        folder = answer.save(tmp_path / str(k), pictures=False)
        named = any((folder / x).exists() for x in ("index.json", "question.json"))
        specs = [] if named else [folder / "mine-1.spec"]
        assert rp.check(folder, specs=specs, jobs=1).accepted
        (folder / "mine-1.spec").write_text("def fast(a: vehicle) := v_lon(a) > 10 m/s")
        assert not rp.check(folder, jobs=1).accepted


def test_progress_is_told() -> None:
    told: list[tuple[int, int, str]] = []
    rp.prove("P4", jobs=2, progress=lambda *x: told.append(x))
    assert told == [(k, 3, "claims") for k in range(4)]


def test_kept_answers_are_taken_up(tmp_path: Path) -> None:
    told: list[str] = []
    asked = {"out": tmp_path / "kept", "jobs": 1, "say": told.append}
    first = rp.overlap("3,4", **asked)
    kept = {path.name: path.read_bytes() for path in (tmp_path / "kept").rglob("*.json")}
    again = rp.overlap("3,4", **asked)
    assert again.verdicts == first.verdicts
    assert {path.name for path in (tmp_path / "kept").rglob("*.json")} == {*kept}
    with pytest.raises(rp.UsageError, match="holds the answers to another question"):
        rp.overlap("3,4", roles="any", **asked)
    [answer] = (tmp_path / "kept" / "answers").iterdir()
    answer.write_text(answer.read_text().replace("IMPOSSIBLE", "WITNESSED"))
    assert not rp.check(tmp_path / "kept", jobs=1).accepted
    assert rp.overlap("3,4", **asked).verdicts == first.verdicts
    assert len(told) == 1


# --- planted faults ---------------------------------------------------------------------------------


def test_a_planted_certificate_is_noticed() -> None:
    proved = rp.prove(SYMMETRIC, jobs=1)
    [answered] = proved.answers
    certificate = answered.settled.result.certificate
    assert certificate is not None
    forged = replace(certificate, claim=FALSE)
    result = replace(answered.settled.result, certificate=forged)
    task = replace(answered.task, claim=FALSE)
    lie = replace(answered, task=task, settled=replace(answered.settled, result=result))
    planted = replace(proved.found, answers={name_of(task): lie})
    assert not replace(proved, study=replace(proved.study, tasks=(task,)), found=planted).check().accepted
    assert proved.check().accepted


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        ("scenario-04-base.json", "scenario_4(SV, POV, L)", "scenario_3(SV, POV, L)"),
        ("formula-02-base.json", "F danger(SV,POV)", "G danger(SV,POV)"),
    ],
)
def test_a_planted_fault_in_a_folder_is_noticed(tmp_path: Path, file: str, old: str, new: str) -> None:
    rp.witness(4, "F danger(SV,POV)", jobs=1).save(tmp_path, pictures=False)
    path = tmp_path / file
    assert old in path.read_text()
    assert rp.check(tmp_path, jobs=1).accepted
    path.write_text(path.read_text().replace(old, new))
    checked = rp.check(tmp_path, jobs=1)
    assert not checked.accepted
    assert checked.exit_code == 10
    # The file, and the kept answer that names it.
    assert [x["outcome"] for x in checked.rows()].count("rejected") == 2
    assert checked.to_frame().height == 3
    assert "rejected" in repr(checked)
    assert "<pre>" in checked._repr_html_()
