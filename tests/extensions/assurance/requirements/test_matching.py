"""What evidence of each kind says of a link, on findings that are put together here."""

import shutil
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from random import Random
from typing import get_args

import pytest

import roadproof as rp
from roadproof.errors import InputError, TextError
from roadproof.evidence.finding import Acceptance, Finding, Kind
from roadproof.evidence.subject import DriverSide, SubjectKind, TestedSide
from roadproof.extensions.assurance.answers.trace import LinkKind, LinkState, RequirementPlace
from roadproof.extensions.assurance.requirements.checked_evidence import CheckedEvidence, read_findings
from roadproof.extensions.assurance.requirements.fingerprints import TraceContext, differences, parts_of
from roadproof.extensions.assurance.requirements.matching import combined_state, findings_of_link, read_target
from roadproof.extensions.assurance.requirements.requirement import Link, Requirement
from roadproof.library.loading import bundled_library
from roadproof.reasons import NO_REASON, ReasonKind

HOME = bundled_library().select()
GOOD = Acceptance.ACCEPTED
PLATE = Finding(
    "p.json",
    "drive",
    GOOD,
    NO_REASON,
    "WITNESSED",
    "careful-Vy-1, unpreventable",
    "v_lon(SV) > 1 m/s",
    subject=SubjectKind.PLATE,
    name="careful-Vy-1",
)
TEST = Finding(
    "judged-test-CUT-1-base.json",
    "test",
    GOOD,
    NO_REASON,
    "JUDGED",
    "test CUT-1",
    "shows class_1, scenario_1",
    subject=SubjectKind.TEST,
    name="CUT-1",
    shows="scenarios",
)
NAMED = SubjectKind.PROPERTY
OURS = "F v_lon(SV) > 3 m/s"


def state(link: Link, *findings: Finding) -> tuple[LinkState, str]:
    return combined_state(
        link.kind, findings_of_link(read_target(link, HOME, "here"), checked(*findings), {}, Path())
    )


def checked(*findings: Finding) -> list[CheckedEvidence]:
    return read_findings(findings, (), HOME)


@pytest.mark.parametrize(
    ("verdict", "claim", "scenario"),
    [
        ("PROVED", "proved", "proved"),
        ("VACUOUS", "unknown", "unknown"),
        ("REFUTED", "refuted", "unknown"),
        ("WITNESSED", "unknown", "witnessed"),
        ("IMPOSSIBLE", "refuted", "refuted"),
        ("NONE-WITHIN", "unknown", "unknown"),
        ("PROVED-BOUNDED", "unknown", "unknown"),
        ("UNKNOWN", "unknown", "unknown"),
        ("CROSSCHECK-FAILED", "unknown", "unknown"),
        ("COVERED", "proved", "proved"),
        ("GAPS", "refuted", "refuted"),
    ],
)
def test_each_verdict_says_what_it_shows(verdict: str, claim: str, scenario: str) -> None:
    found = Finding("x.json", "certificate", GOOD, NO_REASON, verdict, "", OURS)
    assert state(Link("claim", f" {OURS} "), found)[0] == claim
    assert state(Link("scenario", OURS), found)[0] == scenario
    other = replace(found, claim="F v_lon(SV) > 4 m/s")
    assert state(Link("claim", OURS), other)[0] == state(Link("scenario", OURS), other)[0] == "missing"


@pytest.mark.parametrize(
    ("outcome", "expected"),
    [
        (Acceptance.REJECTED, "rejected"),
        (Acceptance.UNREADABLE, "rejected"),
        (Acceptance.FAULT, "rejected"),
        (Acceptance.UNDECIDED, "unknown"),
    ],
)
@pytest.mark.parametrize("kind", ["claim", "scenario", "test", "plate"])
def test_evidence_that_is_not_accepted_shows_nothing(outcome: Acceptance, expected: str, kind: str) -> None:
    links = {"claim": OURS, "scenario": OURS, "test": "CUT-1", "plate": "careful-Vy-1"}
    found = {
        "test": TEST,
        "plate": PLATE,
        **dict.fromkeys(
            ("claim", "scenario"), Finding("x.json", "certificate", GOOD, NO_REASON, "PROVED", "", OURS)
        ),
    }
    bad = replace(found[kind], outcome=outcome, reason=ReasonKind.TOLD("why"))
    assert state(Link(kind, links[kind]), bad) == (expected, "why")  # type: ignore[arg-type]


def test_a_refutation_counts_before_a_proof_and_a_proof_before_a_doubt() -> None:
    proof = Finding("x.json", "certificate", GOOD, NO_REASON, "PROVED", "", OURS)
    doubt, no = replace(proof, verdict="UNKNOWN"), replace(proof, verdict="WITNESSED", claim=f"not ({OURS})")
    damaged = replace(proof, outcome=Acceptance.REJECTED)
    assert state(Link("claim", OURS), doubt, proof)[0] == "proved"
    assert state(Link("claim", OURS), damaged, proof)[0] == "rejected"
    assert state(Link("claim", OURS), proof, no, damaged)[0] == "refuted"


@pytest.mark.parametrize("outcome", Acceptance)
@pytest.mark.parametrize(
    ("verdict", "claim", "scenario"), [("PROVED", "refuted", "refuted"), ("WITNESSED", "refuted", "missing")]
)
def test_only_accepted_evidence_of_the_opposite_refutes(
    outcome: Acceptance, verdict: str, claim: str, scenario: str
) -> None:
    found = Finding("x.json", "certificate", outcome, ReasonKind.TOLD("why"), verdict, "", f"not ({OURS})")
    accepted = outcome is GOOD
    assert state(Link("claim", OURS), found)[0] == (claim if accepted else "missing")
    assert state(Link("scenario", OURS), found)[0] == (scenario if accepted else "missing")


@pytest.mark.parametrize("subject", [x for x in SubjectKind if x is not NAMED])
def test_a_label_names_properties_alone(subject: SubjectKind) -> None:
    found = Finding(
        "x.json", "certificate", GOOD, NO_REASON, "PROVED", "", OURS, subject=subject, name="P1 base"
    )
    assert state(Link("claim", "P1 base"), found)[0] == "missing"
    assert state(Link("claim", "P1 base"), replace(found, subject=NAMED))[0] == "proved"


def test_a_folder_of_evidence_shows_what_its_weakest_part_shows(tmp_path: Path) -> None:
    proof = Finding(str(tmp_path / "x.json"), "certificate", GOOD, NO_REASON, "PROVED", "", OURS)
    doubt = replace(proof, where=str(tmp_path / "y.json"), verdict="UNKNOWN")
    link = Link("evidence", str(tmp_path))
    assert state(link, proof)[0] == "proved"
    assert state(link, proof, doubt)[0] == state(link, doubt, proof)[0] == "unknown"


def test_assumptions_are_a_part_of_a_claim() -> None:
    assumed = f"at minDanger = 0.6 s: {OURS}"
    found = Finding("x.json", "certificate", GOOD, NO_REASON, "PROVED", "", assumed)
    assert state(Link("claim", assumed), found)[0] == "proved"
    assert state(Link("claim", OURS), found)[0] == "missing"
    assert state(Link("claim", f"at minDanger = 0.7 s: {OURS}"), found)[0] == "missing"


@pytest.mark.parametrize(
    ("kind", "claim", "values"),
    [
        ("certificate", "v_lon(SV) > 1 m/s -> danger(SV,POV)", False),
        ("certificate", "at minDanger = 0.6 s: danger(SV,POV)", True),
        ("drive", "danger(SV,POV)", True),
    ],
)
def test_only_proofs_without_assumptions_hold_for_every_value(kind: Kind, claim: str, values: bool) -> None:
    found = checked(
        Finding(
            "x.json",
            kind,
            GOOD,
            NO_REASON,
            "PROVED",
            "P1 base",
            claim,
            subject=SubjectKind.PROPERTY,
            name="P1 base",
        )
    )
    link = Link("claim", "P1 base")
    owner = Requirement("A", "text", RequirementPlace(file="r.toml"), links=(link,))
    around = TraceContext(HOME, Path())
    parts = parts_of(owner, read_target(link, HOME, "here"), found, around)
    assert ("value of minDanger" in parts) == values
    assert {"parameter minDanger", "definition danger", "text of A", "roadproof"} <= parts.keys()
    changed = parts | {"value of minDanger": "1"}
    told = differences(parts, changed)
    assert told == (("parameter minDanger: 3/5 -> 1",) if values else ())


@pytest.mark.parametrize(
    ("change", "expected", "reason"),
    [
        ({}, "witnessed", ""),
        ({"shows": "nothing"}, "unknown", "it shows no scenario"),
        ({"claim": "cannot be read: torn", "shows": "unreadable"}, "rejected", "cannot be read: torn"),
        ({"verdict": "READ", "kind": "index"}, "unknown", "no drive of its formula was found"),
        ({"subject": SubjectKind.RUN, "shows": "", "verdict": "WITNESSED", "kind": "drive"}, "witnessed", ""),
        (
            {"subject": SubjectKind.RUN, "shows": "", "verdict": "IMPOSSIBLE"},
            "refuted",
            "it is proved that no drive shows it",
        ),
        ({"subject": SubjectKind.FACT, "shows": ""}, "missing", "there is no evidence for it"),
        ({"name": "CUT-11"}, "missing", "there is no evidence for it"),
        (
            {"outcome": Acceptance.REJECTED, "reason": ReasonKind.TEST_GONE()},
            "stale",
            ReasonKind.TEST_GONE(),
        ),
    ],
)
def test_tests_of_a_catalogue(change: dict[str, str], expected: str, reason: str) -> None:
    found = replace(TEST, **change)  # type: ignore[arg-type]
    assert state(Link("test", "CUT-1"), found) == (expected, reason)


def test_a_test_that_is_not_what_it_claims_is_refuted(tmp_path: Path) -> None:
    example = Path(__file__).parents[4] / "examples" / "catalogue" / "tests" / "drives"
    shutil.copy(example / "cut-in.json", tmp_path)
    entry = '[[test]]\nid = "CUT-1"\nfile = "cut-in.json"\nclaims = [4]\n'
    (tmp_path / "catalogue.toml").write_text(entry, "utf-8")
    out = tmp_path / "out"
    rp.catalogue(tmp_path, among="1,4", classes=False, drivers=(), out=out, jobs=1)
    [judged] = out.glob("judged-*.json")
    found = replace(TEST, where=str(judged))
    told = (LinkState.REFUTED, "claims scenario_4, and shows scenario_1")
    assert state(Link("test", "CUT-1"), found) == told
    assert state(Link("test", "CUT-2"), replace(found, name="CUT-2"))[0] == "witnessed"


def test_all_parts_of_a_plate_count() -> None:
    other = replace(PLATE, label="careful-Vy-1, preventable")
    link = Link("plate", "careful-Vy-1")
    assert state(link, PLATE, other)[0] == "witnessed"
    assert state(link, PLATE, replace(other, verdict="UNKNOWN")) == (LinkState.UNKNOWN, "UNKNOWN")
    assert state(link, replace(PLATE, name="careful-Vy-10"))[0] == "missing"


def test_a_word_is_no_label() -> None:
    with pytest.raises(TextError):
        state(Link("claim", "base"))


@pytest.mark.parametrize("target", ["99", "99@ext"])
def test_a_scenario_that_is_not_there_is_told_with_its_place(target: str) -> None:
    with pytest.raises(InputError, match=r"^r\.toml, line 3: there is no scenario 99"):
        read_target(Link("scenario", target), HOME, "r.toml, line 3")


@pytest.mark.parametrize("kind", ["test", "plate"])
def test_a_link_matches_no_evidence_of_another_kind_with_its_name(kind: LinkKind) -> None:
    for other in SubjectKind:
        if other in (SubjectKind.PLATE,) if kind == "plate" else other in (SubjectKind.TEST, SubjectKind.RUN):
            continue
        for verdict in ("PROVED", "IMPOSSIBLE", "WITNESSED"):
            found = Finding(
                "x.json", "certificate", GOOD, NO_REASON, verdict, "N", OURS, subject=other, name="N"
            )
            assert state(Link(kind, "N"), found)[0] == "missing", (other, verdict)


def test_no_rewording_of_labels_claims_and_checks_changes_the_state_of_a_link() -> None:
    random = Random(39)
    proof = Finding("x.json", "certificate", GOOD, NO_REASON, "PROVED", "P1 base", OURS)
    cases = [
        (Link("test", "CUT-1"), replace(TEST, shows=shows))
        for shows in ("scenarios", "nothing", "unreadable")
    ]
    cases += [(Link("test", "CUT-1"), replace(TEST, subject=SubjectKind.FACT))]
    cases += [(Link("plate", "careful-Vy-1"), PLATE), (Link("plate", "N"), PLATE)]
    cases += [(Link("claim", "P1 base"), replace(proof, subject=SubjectKind.PROPERTY, name="P1 base"))]
    cases += [(Link("claim", "P1 base"), proof)]
    words = (
        "shows no scenario",
        "cannot be read",
        "test CUT-1",
        "CUT-1 runs",
        "careful-Vy-1, x",
        "N",
        "P1 base",
    )
    for _ in range(300):
        link, found = random.choice(cases)
        reworded = (
            replace(found, label=random.choice(words), checked=(random.choice(words),))
            if found.subject is not SubjectKind.TEST
            else replace(found, label=random.choice(words), claim=random.choice(words))
        )
        assert state(link, reworded)[0] is state(link, found)[0], (link, reworded)


SIDES = get_args(TestedSide)


@pytest.mark.parametrize("wanted", ["preventable", "unpreventable"])
@pytest.mark.parametrize("sides", [*product(SIDES), *product(SIDES, repeat=2)])
def test_a_driver_verdict_counts_in_each_scenario_that_a_test_shows(
    wanted: str, sides: tuple[TestedSide, ...]
) -> None:
    decided = tuple(
        DriverSide(driver="careful", scenario=f"scenario_{k}", side=x) for k, x in enumerate(sides, 1)
    )
    other = DriverSide(driver="rss", scenario="scenario_1", side="undecided")
    found, reason = state(
        Link("driver", f"CUT-1: careful {wanted}"), replace(TEST, drivers=(*decided, other))
    )
    if {"partly", *{"preventable", "unpreventable"} - {wanted}} & {*sides}:
        assert found == "refuted"
    else:
        assert found == ("witnessed" if {*sides} == {wanted} else "unknown")
    assert bool(reason) is (found != "witnessed")


def test_a_driver_verdict_of_another_test_or_model_shows_nothing() -> None:
    side = DriverSide(driver="careful", scenario="scenario_1", side="preventable")
    evidence = replace(TEST, drivers=(side,))
    assert state(Link("driver", "CUT-1: careful preventable"), evidence)[0] == "witnessed"
    for target in ("CUT-2: careful preventable", "CUT-1: rss preventable"):
        assert state(Link("driver", target), evidence)[0] == "missing"
    rejected = replace(evidence, outcome=Acceptance.REJECTED, reason=ReasonKind.TOLD("another"))
    assert state(Link("driver", "CUT-1: careful preventable"), rejected)[0] == "rejected"
    plate = replace(evidence, subject=SubjectKind.PLATE)
    assert state(Link("driver", "CUT-1: careful preventable"), plate)[0] == "missing"


@pytest.mark.parametrize(
    "target", ["CUT-1", "CUT-1: careful", "CUT-1: careless preventable", "CUT-1 careful"]
)
def test_a_driver_link_says_test_model_and_side(target: str) -> None:
    with pytest.raises(InputError, match=r"here: drivers='.*': write TEST: MODEL preventable"):
        read_target(Link("driver", target), HOME, "here")


def test_a_driver_link_rests_on_the_verdicts_of_its_test() -> None:
    requirement = Requirement("R", "text", RequirementPlace(file="x"))
    target = read_target(Link("driver", "CUT-1: careful preventable"), HOME, "here")
    parts = []
    for side in ("preventable", "undecided"):
        decided = DriverSide(driver="careful", scenario="scenario_1", side=side)
        evidence = checked(replace(TEST, drivers=(decided,)))
        parts.append(parts_of(requirement, target, evidence, TraceContext(HOME, Path())))
    assert any("driver verdicts of test CUT-1" in x for x in differences(*parts))


def test_requirements_name_driver_verdicts_of_a_catalogue(tmp_path: Path) -> None:
    [drive] = rp.witness(1, jobs=1).evidence
    drive.save(tmp_path / "cut.json")
    made = rp.catalogue(tmp_path / "cut.json", among="1", classes=False, drivers=["careful"], jobs=1)
    made.save(tmp_path / "tests", pictures=False)
    [side] = {x.side for _, x in made.decisions}
    other = {"preventable": "unpreventable", "unpreventable": "preventable"}[side]
    (tmp_path / "requirements.toml").write_text(
        f"""
[trace]
evidence = ["tests"]
[[requirement]]
id = "A"
text = "It is so."
drivers = ["cut: careful {side}"]
[[requirement]]
id = "B"
text = "It is otherwise."
drivers = ["cut: careful {other}"]
""".lstrip()
    )
    found = rp.requirements(tmp_path / "requirements.toml", jobs=1).states
    assert found == {"A": "witnessed", "B": "refuted"}
    text = (tmp_path / "requirements.toml").read_text()
    for more in ('parameters = {rho = "0.5 s"}', 'specs = ["driver"]\nparameters = {cc_braking = "4 m/s^2"}'):
        (tmp_path / "other.toml").write_text(text.replace("[trace]\n", f"[trace]\n{more}\n"))
        states = rp.requirements(tmp_path / "other.toml", jobs=1).states
        assert states["A"] == "stale", "it was decided at other values"


@pytest.mark.parametrize(
    ("values", "given", "expected"),
    [
        ({"minSafe": Fraction(3, 5)}, {}, "witnessed"),
        ({"minSafe": Fraction(1)}, {}, "stale"),
        ({"minSafe": Fraction(1)}, {"minSafe": Fraction(1)}, "witnessed"),
        ({"minSafe": Fraction(3, 5)}, {"minSafe": Fraction(1)}, "stale"),
        ({"nobodys": Fraction(1)}, {}, "witnessed"),
    ],
)
def test_a_drive_is_stale_by_values_that_are_given_or_declared(
    values: dict[str, Fraction], given: dict[str, Fraction], expected: str
) -> None:
    [judged] = checked(PLATE)
    link = Link("plate", "careful-Vy-1")
    found = findings_of_link(read_target(link, HOME, "here"), [replace(judged, values=values)], given, Path())
    assert combined_state("plate", found)[0] == expected
