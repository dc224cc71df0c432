"""The meaning of each rule of build results, as SARIF shows it."""

from collections.abc import Mapping

from roadproof.frontends.report.cases import CaseRule
from roadproof.verdict import Verdict

MEANINGS: Mapping[Verdict | CaseRule, str] = {  # partial: cases never fail as COVERED or DERIVED
    Verdict.PROVED: "A claim that was expected to be false is proved.",
    Verdict.PROVED_BOUNDED: "A claim that was expected to be false holds within limits.",
    Verdict.REFUTED: "A claim has a counterexample.",
    Verdict.VACUOUS: "A claim holds only because its premise never does.",
    Verdict.WITNESSED: "There is a drive where none was expected.",
    Verdict.IMPOSSIBLE: "No drive can show this formula.",
    Verdict.NONE_WITHIN: "No drive within the limits of the search shows this formula.",
    Verdict.UNKNOWN: "The question is not decided.",
    Verdict.GAPS: "There is danger that the spec set does not cover.",
    Verdict.CROSSCHECK_FAILED: "Two evaluations of one formula differ.",
    CaseRule.WRONG_TEST: "A test does not show what it claims, or cannot be read.",
    CaseRule.NOT_TESTED: "No test shows this scenario or class.",
    CaseRule.CONTRADICTION: "Tests or recordings contradict a proof.",
    CaseRule.REJECTED: "Evidence does not show what it says.",
    CaseRule.UNREADABLE: "A file cannot be read.",
    CaseRule.MISSING: "There is no evidence for a requirement.",
    CaseRule.STALE: "What a requirement rests on changed since it was accepted.",
    CaseRule.NO_ANSWER: "The command ended without an answer.",
}
"""What each rule means, in a sentence."""
