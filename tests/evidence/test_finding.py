"""What is said at the end of a check: how many claims came out how, and the exit code."""

from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding, exit_code, summary
from roadproof.verdict import ExitCode


def finding(outcome: Acceptance, kind: str = "certificate") -> Finding:
    return Finding("x.json", kind, outcome)


def test_the_summary_counts_each_outcome() -> None:
    accepted, rejected = finding(Acceptance.ACCEPTED), finding(Acceptance.REJECTED)
    assert summary([accepted] * 3, "z3") == "3 of 3 accepted by z3 and the exact judge"
    assert summary([accepted, rejected, rejected], "z3").endswith(
        "1 of 3 accepted by z3 and the exact judge, 2 rejected"
    )
    other = [finding(x) for x in (Acceptance.UNDECIDED, Acceptance.UNREADABLE, Acceptance.FAULT)]
    assert summary(other, "cvc5").startswith("0 of 3 accepted by cvc5")
    assert summary(other, "cvc5").endswith(", 1 unknown, 1 unreadable, 1 our fault")


def test_answers_without_evidence_are_counted_apart() -> None:
    found = [finding(Acceptance.ACCEPTED), finding(Acceptance.ACCEPTED, NO_EVIDENCE)]
    assert summary(found, "z3") == "1 of 1 accepted by z3 and the exact judge; 1 without evidence"


def test_the_exit_code_is_that_of_the_gravest() -> None:
    assert exit_code([]) == ExitCode.UNKNOWN  # nothing was accepted
    assert exit_code(map(finding, Acceptance)) == ExitCode.OUR_FAULT
    assert exit_code([finding(Acceptance.UNDECIDED), finding(Acceptance.ACCEPTED)]) == ExitCode.UNKNOWN
