"""Claims at values of parameters: put in before anything is asked, said in every answer, checked, forged."""

import json
from dataclasses import replace

import pytest

import roadproof as rp
from roadproof.engines.solve.smt import ask
from roadproof.errors import InputError, UsageError
from roadproof.evidence.certificate import read_certificate, refusal, to_json
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library

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
    drive, trace = (x.settled for x in answers.answers)
    assert drive.drive is not None
    assert str(drive.drive.file.values["minDanger"]) == "9/10"
    assert trace.result.countermodel is not None
    assert str(trace.result.countermodel.parameters["minDanger"]) == "9/10"
    assert answers.check().accepted
    index = json.loads((tmp_path / "index.json").read_text("utf-8"))
    text = json.dumps(index).replace("minDanger = 0.9 s", "minDanger = 0.8 s")
    (tmp_path / "index.json").write_text(text, "utf-8")
    (tmp_path / "answers").rename(tmp_path.parent / "away")
    findings = rp.check(tmp_path).findings
    assert [x.outcome for x in findings] == ["rejected"] * len(findings)


def forged(certificate, **changes):
    return refusal(replace(certificate, **changes), bundled_library(), lambda script: ask(script))


def test_other_values_than_those_that_were_proved_are_refused(tmp_path):
    [plain] = rp.prove(AT, jobs=1).evidence
    [pinned] = rp.prove(PINNED, jobs=1).evidence
    for made in (plain, pinned):
        (tmp_path / "x.json").write_text(to_json(made), "utf-8")
        assert read_certificate(tmp_path / "x.json") == made
        assert forged(made) is None
    others = replace(plain.assumed, said=("minDanger = 0.5 s",))
    assert "the query cannot be derived" in forged(plain, assumed=others)
    assert forged(plain, assumed=replace(plain.assumed, said=()))
    assert "written otherwise" in forged(plain, assumed=replace(plain.assumed, said=("minDanger = 600 ms",)))
    assert "written otherwise" in forged(
        plain, assumed=replace(plain.assumed, said=(*plain.assumed.said, "thwLimit = 2 s"))
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
