"""The sentences about what a proof uses: each is said where the certificate shows it, and only there."""

from dataclasses import replace

import pytest

import roadproof as rp
from cli.test_schemas import validator
from kernel.needs import needs_coq
from roadproof.engines.solve.smt import ask
from roadproof.evidence.certificate import certificate_data, read_certificate_data, refusal
from roadproof.frontends.api.checking import check
from roadproof.library.loading import bundled_library

LIMIT, OTHER = "a_lon(SV) <= 3 m/s^2", "a_lon(SV) >= -6 m/s^2"
NEITHER = "the proof uses neither a limit nor a fact about motion: the claim holds without them"
NO_FACT = "the proof uses no fact about motion: the claim holds without them"
GROWTH = "within(v_lon(SV), 4 m/s, 3 m/s^2, 1 s)"


def proved(claim: str, **asked):
    answer = rp.prove(claim, jobs=1, **asked)
    assert str(answer.verdict) == "PROVED"
    return answer, answer.answers[0].settled.result.certificate


@pytest.mark.parametrize(
    ("claim", "limits", "facts", "unused"),
    [
        (f"assuming motion, {LIMIT}: a_lon(SV) <= 4 m/s^2", (LIMIT,), 0, ()),
        (f"assuming motion, {LIMIT}, {OTHER}: a_lon(SV) <= 4 m/s^2", (LIMIT,), 0, (OTHER,)),
        (f"assuming motion, {LIMIT}: v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s", (), 0, (LIMIT,)),
        ("assuming motion: v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s", (), 0, ()),
        (f"assuming motion, {LIMIT}: v_lon(SV) <= 4 m/s -> G[0,1] v_lon(SV) <= 7 m/s", (LIMIT,), 1, ()),
        ("assuming motion: v_lon(SV) < 4 m/s and F v_lon(SV) > 4 m/s -> F v_lon(SV) = 4 m/s", (), 1, ()),
        # The claim says the same as the limit, so that its proof does without.
        (f"assuming motion, {LIMIT}: G {LIMIT} -> a_lon(SV) <= 5 m/s^2", (), 0, (LIMIT,)),
        (f"assuming motion, {LIMIT}, minDanger = 0.6 s: {LIMIT} or F[0,minDanger] true", (), 0, (LIMIT,)),
    ],
)
def test_premises_are_those_of_the_certificate(claim, limits, facts, unused):
    answer, certificate = proved(claim)
    assumed = certificate.assumed
    assert (assumed.limits, len(assumed.axioms), assumed.unused) == (limits, facts, unused)
    assert refusal(certificate, bundled_library(), ask) is None
    entry = answer.as_data()["verdicts"][0]
    assert entry["premises"] == [*limits, *map(str, assumed.axioms)]
    assert answer.rows()[0]["premises"] == "; ".join(entry["premises"])
    assert not [*validator("verdicts.json").iter_errors(answer.as_data())]
    data = certificate_data(certificate)
    assert not [*validator("certificate.json").iter_errors(data)]
    assert read_certificate_data(data, "it") == certificate
    text = str(answer)
    assert (NEITHER in text or NO_FACT in text) == (not limits and not facts)
    assert (f"of the limits: {', '.join(limits)}\n" in text + "\n") == bool(limits)
    assert ("of motion: " in text) == bool(facts)


def test_without_motion_nothing_is_said_of_it():
    answer, _ = proved("v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s")
    assert "motion" not in str(answer)


def test_limits_of_a_model_are_told_apart():
    answer, certificate = proved("a_lon(SV) <= 10 m/s^2", assume="motion", vehicles={"SV": "car"})
    assert certificate.assumed.limits == (LIMIT,)
    assert f"  of the limits: {LIMIT}\n  limits not used: {OTHER}" in str(answer)


def test_a_limit_that_is_used_cannot_be_called_unused():
    _, certificate = proved(f"assuming motion, {LIMIT}: a_lon(SV) <= 4 m/s^2")
    forged = replace(certificate, assumed=replace(certificate.assumed, unused=(LIMIT,)))
    assert refusal(forged, bundled_library(), ask) is not None


def test_only_a_limit_that_is_said_can_be_unused():
    _, certificate = proved(f"assuming motion, {LIMIT}: v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s")
    forged = replace(certificate, assumed=replace(certificate.assumed, unused=(LIMIT, OTHER)))
    assert "the claim does not say these limits" in refusal(forged, bundled_library(), ask)


def test_a_certificate_of_earlier_has_all_limits_as_premises():
    _, certificate = proved(f"assuming motion, {LIMIT}: a_lon(SV) <= 4 m/s^2")
    data = certificate_data(certificate)
    assert "unused" not in data
    assert read_certificate_data(data, "it").assumed.limits == (LIMIT,)


@pytest.mark.parametrize(
    "claim",
    ["v_lon(SV) <= 4 m/s -> v_lon(SV) <= 5 m/s", "a_lon(SV) <= 4 m/s^2", "a_lon(SV) <= 2 m/s^2"],
)
def test_limits_that_contradict_each_other_make_every_claim_vacuous(claim):
    """Also one that follows without them, or from one of them alone."""
    found = rp.prove(f"assuming motion, {LIMIT}, a_lon(SV) >= 5 m/s^2: {claim}", jobs=1)
    assert str(found.verdict) == "VACUOUS"
    assert found.rows()[0]["reason"] == "what is assumed contradicts itself, so every claim follows"


@needs_coq
def test_coq_names_limits_as_limits(tmp_path):
    claim = f"assuming motion, {LIMIT}: a_lon(SV) <= 4 m/s^2"
    rp.prove(claim, jobs=1, out=tmp_path / "limit")
    rp.prove(
        f"assuming motion, {LIMIT}: v_lon(SV) <= 4 m/s -> G[0,1] v_lon(SV) <= 7 m/s",
        jobs=1,
        out=tmp_path / "both",
    )
    rp.prove(f"assuming motion, {LIMIT}: a_lon(SV) > 0 or true", jobs=1, out=tmp_path / "none")
    told = {x: str(check(tmp_path / x, kernel="coq", jobs=1)) for x in ("limit", "both", "none")}
    assert "under 1 limit that is a premise; not checked: queries for solvers]" in told["limit"]
    assert "under 1 limit and 1 fact about motion that are premises;" in told["both"]
    assert "not checked: queries for solvers, that the facts are true of motion]" in told["both"]
    assert "premise" not in told["none"]
