"""Every question once, through both doors: the answers are the same, and can do what every answer can."""

import json
import os
import shlex
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, dataclass, fields, replace
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import pytest

import roadproof as rp
from api.both_interfaces import (
    ASKED,
    FALSE,
    MINE,
    SYMMETRIC,
    InterfaceCase,
    tell,
    without_clock,
    without_seconds,
)
from rejection import rejection_reason
from roadproof.engines.solve.smt import check_sat
from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import read_certificate, to_json
from roadproof.evidence.countermodel import Countermodel
from roadproof.evidence.judged import JudgedDrive
from roadproof.frontends.api.answer import BaseAnswer
from roadproof.frontends.api.proofs import claims_question
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library
from roadproof.questions import decide
from roadproof.verdict import Verdict

pytestmark = pytest.mark.usefixtures("searched_once")

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
    asked: InterfaceCase
    answer: BaseAnswer
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
        line = shlex.split(asked.line)
        if request.param == "explore-values":  # beside a file of JSON, its evidence is in files, too
            data = tell([*line, "--json", "-"])[1]
            code, text, _ = tell(line)
        else:
            code, text, _ = tell([*line, "--json", "said.json"])
            data = Path("said.json").read_text("utf-8")
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
    assert drawn.png.startswith(b"\x89PNG")
    assert [drawn._repr_png_(), drawn._repr_svg_()] == (
        [drawn.png, None] if "png" in drawn.formats else [None, drawn.svg.decode()]
    )
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
        specs = [] if (folder / "question.json").exists() else [folder / "mine-1.spec"]
        assert rp.check(folder, specs=specs, jobs=1).accepted
        (folder / "mine-1.spec").write_text("def fast(a: vehicle) := v_lon(a) > 10 m/s")
        assert not rp.check(folder, jobs=1).accepted


def test_progress_is_told() -> None:
    told: list[tuple[int, int, str]] = []
    rp.prove("P4", jobs=2, progress=lambda *x: told.append(x))
    asked = [x for x in told if x[2] != "claims looked up"]  # these are told where they take long
    assert asked == [(k, 3, "claims") for k in range(4)]


def test_look_ups_that_take_long_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(decide, "SOON", 0.0)
    told: list[tuple[int, int, str]] = []
    rp.overlap("3,4,5", jobs=1, progress=lambda *x: told.append(x))
    assert told[0] == (0, 3, "groups of pairs looked up")
    assert (2, 3, "groups of pairs looked up") in told


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
    [answer] = (tmp_path / "kept").glob("base-*.json")
    answer.write_text(answer.read_text().replace('"base"', '"ext"'))
    assert not rp.check(tmp_path / "kept", jobs=1).accepted
    assert rp.overlap("3,4", **asked).verdicts == first.verdicts
    assert len(told) == 1


# --- planted faults ---------------------------------------------------------------------------------


def test_a_planted_certificate_is_noticed() -> None:
    proved = rp.prove(SYMMETRIC, jobs=1)
    [answered] = proved.answers
    certificate = answered.certificate
    assert certificate is not None
    question = claims_question(rp.load(), [FALSE], None)
    [(name, claim)] = question.claims.items()
    lie = ClaimAnswer(claim, replace(certificate, claim=FALSE))
    planted = replace(proved.found, answers={name: lie})
    assert not replace(proved, question=question, found=planted).check().accepted
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
    assert [x["outcome"] for x in checked.rows()].count("rejected") == 1
    assert checked.to_frame().height == 2, "a file that is refused is said once"
    assert "rejected" in repr(checked)
    assert "<pre>" in checked._repr_html_()


# --- Claims at values of parameters: put in before anything is asked, said in every answer, checked, forged

LASTS = "danger(SV,POV) -> G[0, 0.6 s] rssViolation(SV,POV)"
AT = f"at minDanger = 0.6 s: {LASTS}"
PINNED = f"rssViolation(SV,POV) and minDanger = 0.6 s and danger(SV,POV) -> {LASTS.partition('-> ')[2]}"


def test_an_answer_says_at_which_values_it_holds():
    here = rp.load(params={"minDanger": "600 ms", "thwLimit": 1})
    answer = rp.prove(LASTS, using=here, jobs=1)
    assert str(answer).startswith(f"PROVED  {AT}\n")
    [row], [said] = answer.rows(), answer.as_data()["verdicts"]
    assert (row["assuming"], said["assuming"]) == ("minDanger = 0.6 s", ["minDanger = 0.6 s"])
    assert AT in str(answer.check())
    assert rp.prove(AT, jobs=1).verdicts == answer.verdicts
    assert rp.prove(LASTS, jobs=1, drive=False).verdict is rp.Verdict.REFUTED


def test_at_the_declared_values_of_all_others():
    answer = rp.prove(4, using=rp.load("ext", params={"minDanger": 2}), declared=True, drive=False, jobs=1)
    said = [row["assuming"] for row in answer.rows()]
    assert all("minDanger = 2 s" in x and "rho = 0.6 s" in x for x in said)
    assert {x.verdict for x in answer.answers if x.task.id.startswith("P")} == {rp.Verdict.PROVED}
    assert "each at those of a_max = 5 m/s^2" in str(answer)
    assert "P1 scenario 4 ext  at a_max = 5 m/s^2" in str(answer.check())
    assert answer.check().accepted


def test_two_windows_of_one_length_are_no_doubt():
    """A proof from whose clauses one could be left out was none that a certificate could be made of."""
    claim = "at minDanger = 0.6 s, minSafe = 0.6 s: scenario_4(SV,POV,L) -> dangerArises(SV,POV)"
    assert rp.prove(claim, jobs=1).verdict is rp.Verdict.PROVED


def test_what_a_premise_pins_is_put_in_and_checked():
    answer = rp.prove(PINNED, jobs=1)
    [certificate] = answer.evidence
    assert answer.verdict is rp.Verdict.PROVED
    assert "lemmas, at minDanger = 0.6 s, for all a_max >= 0" in str(answer)
    assert certificate.pinned == ("minDanger = 0.6 s",)
    assert not [x for x in certificate.assumptions if "minDanger" in x]
    assert not any("minDanger" in script for _, script in certificate.queries)
    assert answer.check().accepted


def test_refuted_at_values_by_a_drive_or_a_trace_with_these_values(tmp_path):
    here = rp.load(params={"minDanger": "0.9"})
    claims = "danger(SV,POV) -> s(SV) < s(POV)", "danger(SV,POV) -> G[0, 1 s] rssViolation(SV,POV)"
    rp.prove(claims[1], using=here, out=tmp_path, drive=False, jobs=1)
    rp.prove(claims[0], using=here, out=tmp_path, jobs=1)
    answers = rp.prove(*claims, using=here, drive=False, out=tmp_path, jobs=1)
    first, second = answers.answers
    assert first.drive is not None
    assert str(first.drive.file.values["minDanger"]) == "9/10"
    assert second.trace is not None
    assert str(second.trace.parameters["minDanger"]) == "9/10"
    assert answers.check().accepted
    question = (tmp_path / "question.json").read_text("utf-8")
    (tmp_path / "question.json").write_text(question.replace("minDanger = 0.9 s", "minDanger = 0.8 s"))
    findings = rp.check(tmp_path).findings
    assert [x.outcome for x in findings if not x.claim] == ["rejected"] * 2
    assert {x.verdict for x in findings if x.claim} == {"UNKNOWN"}


def forged(certificate, **changes):
    return rejection_reason(
        replace(certificate, **changes), bundled_library(), lambda script: check_sat(script)
    )


def test_other_values_than_those_that_were_proved_are_refused(tmp_path):
    [plain] = rp.prove(AT, jobs=1).evidence
    [pinned] = rp.prove(PINNED, jobs=1).evidence
    for made in (plain, pinned):
        (tmp_path / "x.json").write_text(to_json(made), "utf-8")
        assert read_certificate(tmp_path / "x.json") == made
        assert forged(made) is None
    others = replace(plain.assumed, texts=("minDanger = 0.5 s",))
    assert "the query cannot be derived" in forged(plain, assumed=others)
    assert forged(plain, assumed=replace(plain.assumed, texts=()))
    assert "written otherwise" in forged(plain, assumed=replace(plain.assumed, texts=("minDanger = 600 ms",)))
    assert "written otherwise" in forged(
        plain, assumed=replace(plain.assumed, texts=(*plain.assumed.texts, "thwLimit = 2 s"))
    )
    assert forged(pinned, pinned=())
    assert "no premise of the claim" in forged(pinned, pinned=(*pinned.pinned, "rho = 1 s"))
    assert "no premise of the claim" in forged(pinned, pinned=("minDanger = 1 s",))
    assert "written otherwise" in forged(pinned, pinned=("minDanger = 600 ms",))
    assert "no premise of the claim" in forged(pinned, claim=LASTS)


@pytest.mark.parametrize(
    ("claim", "wrong"),
    [
        ("at minDanger = -1 s: danger(SV,POV)", "demands minDanger >= 0"),
        ("at minDanger = 1 m: danger(SV,POV)", "column 1"),
        ("at minDangr = 1 s: danger(SV,POV)", "did you mean 'minDanger'"),
        ("at minDanger = rho: danger(SV,POV)", "is no value of a parameter"),
        ("at minDanger = 1 s, minDanger = 2 s: danger(SV,POV)", "cannot have two values"),
        ("at minDanger = 1 s, v_lon(SV) <= 3 m/s: danger(SV,POV)", "only motion can be assumed"),
    ],
)
def test_mistakes_are_named(claim, wrong):
    with pytest.raises((InputError, UsageError), match=wrong):
        rp.prove(claim, jobs=1)


def test_the_command_line_asks_the_same(capsys):
    assert main(["prove", LASTS, "--param", "minDanger=0.6", "--jobs", "1"]) == 0
    assert capsys.readouterr().out.startswith(f"PROVED  {AT}\n")
    moving = "v_lon(SV) <= 20 m/s -> F[0, minDanger] v_lon(SV) <= 23 m/s"
    asked = ["--assume", "motion", "--vehicle", "SV=car", "--param", "minDanger=1"]
    assert main(["prove", moving, *asked, "--jobs", "1"]) == 0
    assert "a_lon(SV) <= 3 m/s^2, minDanger = 1 s: v_lon" in capsys.readouterr().out


# --- What claims assume, from Python and at the command line: words, limits, mistakes ---------------

BEHIND = "G v_lon(SV) <= v_lon(POV) and s(SV) < s(POV) -> G s(SV) <= s(POV)"
FAST = "v_lon(SV) <= 20 m/s -> G[0, 2 s] v_lon(SV) <= 26 m/s"
OF_A_CAR = (
    "assuming motion, v_lon(SV) >= 15 m/s, v_lon(SV) <= 40 m/s, a_lon(SV) >= -6 m/s^2, a_lon(SV) <= 3 m/s^2"
)


@cache
def behind():
    return rp.prove(BEHIND, assume="motion", jobs=1)


def test_an_answer_says_what_it_assumes():
    answer = behind()
    assert str(answer).startswith(f"PROVED  assuming motion: {BEHIND}\n")
    [row], [said] = answer.rows(), answer.as_data()["verdicts"]
    assert (row["assuming"], row["refuted_by"]) == ("motion", None)
    assert (said["claim"], said["assuming"]) == (BEHIND, ["motion"])
    assert "assuming motion: " in str(answer.check())


def test_a_claim_may_say_itself_what_it_assumes():
    assert rp.prove(f"assuming motion: {BEHIND}", jobs=1).verdicts == behind().verdicts
    iso = rp.load()
    built = rp.G(rp.SV.v_lon <= rp.POV.v_lon) & (rp.SV.s < rp.POV.s)
    assert rp.prove(built >> rp.G(rp.SV.s <= rp.POV.s), using=iso, assume="motion", jobs=1).verdict is (
        Verdict.PROVED
    )


def test_limits_of_a_model_are_what_is_printed():
    for vehicles in ("car", {"SV": "car"}):
        answer = rp.prove(FAST, assume="motion", vehicles=vehicles, jobs=1)
        assert str(answer).startswith(f"PROVED  {OF_A_CAR}: {FAST}\n")
    again = rp.prove(str(answer).splitlines()[0].removeprefix("PROVED  "), jobs=1)
    assert again.verdicts == answer.verdicts


@pytest.mark.parametrize(
    ("claims", "asked", "wrong"),
    [
        ((BEHIND,), {"assume": "rest"}, "write 'motion'"),
        (("P1",), {"assume": "motion"}, "claims of your own"),
        ((), {"assume": "motion"}, "claims of your own"),
        ((BEHIND,), {"vehicles": "car"}, "limits of vehicles require assume=motion"),
        ((BEHIND,), {"assume": "motion", "vehicles": {"POV2": "car"}}, "the claim mentions POV, SV"),
        ((BEHIND,), {"assume": "motion", "engine": "smt"}, "is about drives anyway"),
        ((f"assuming motion: {BEHIND}",), {"engine": "smt"}, "is about drives anyway"),
        ((f"assuming motion, s(SV) < s(POV): {BEHIND}",), {}, "is no limit"),
        ((f"assuming motion, v_lon(POV2) < 3 m/s: {BEHIND}",), {}, "speaks of POV2"),
        ((f"assuming motion and rest: {BEHIND}",), {}, "only motion can be assumed"),
    ],
)
def test_mistakes_in_assumptions_are_named(claims, asked, wrong):
    with pytest.raises((UsageError, InputError), match=wrong):
        rp.prove(*claims, jobs=1, **asked)


def test_places_of_mistakes_stay_where_they_are_behind_what_is_assumed():
    with pytest.raises(InputError, match="line 1, column 20"):
        rp.prove("assuming motion: G dangr(SV,POV)", jobs=1)


def test_the_command_line_assumes_the_same(capsys, tmp_path):
    (tmp_path / "claims.txt").write_text(f"# of motions\nassuming motion: {BEHIND}\n\n{BEHIND}\n", "utf-8")
    claims = ["--claims", str(tmp_path / "claims.txt"), "--no-drive", "--jobs", "1", "--json", "-"]
    assert main(["prove", *claims]) == 10
    found = json.loads(capsys.readouterr().out)["verdicts"]
    assert [x["verdict"] for x in found] == ["PROVED", "REFUTED"]
    assert [x["assuming"] for x in found] == [["motion"], []]
    assert [x["refuted_by"] for x in found] == [None, "trace"]
    assert main(["prove", "--assume", "motion", "--vehicle", "SV=car", FAST, "--jobs", "1"]) == 0
    assert capsys.readouterr().out.startswith(f"PROVED  {OF_A_CAR}: {FAST}\n")
    assert main(["prove", "--vehicle", "car", FAST]) == 2


def test_a_none_within_is_saved_with_its_tree(tmp_path: Path) -> None:
    """As ``witness --out`` writes it."""
    asked = {"horizon": 1.8, "jobs": 1}
    found = rp.witness("v_lon(SV) > 41 m/s", out=tmp_path / "out", **asked)
    saved = rp.witness("v_lon(SV) > 41 m/s", **asked).save(tmp_path / "saved", pictures=False)
    for folder in (tmp_path / "out", saved, found.save(tmp_path / "again")):
        (tree,) = folder.glob("none-within-*.json")
        assert tree.read_bytes() == (saved / tree.name).read_bytes()
    assert str(rp.check(saved, jobs=1)).endswith("1 of 1 accepted by exact integer arithmetic")
    assert found.check().accepted
