"""Claims, drives and comparisons on the page, and evidence that lies alone."""

from collections import Counter
from collections.abc import Mapping, Sequence

from roadproof.analysis.study.evidence_store import INDEX
from roadproof.evidence.answers import compare as comparisons
from roadproof.evidence.answers import drives
from roadproof.evidence.answers.proofs import ANSWER_SCHEMA, OWN, Answer, Claim, ClaimAnswer, Index
from roadproof.evidence.codec import read
from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding
from roadproof.frontends.report.page.markup import Content, Markup, joined, table, tag
from roadproof.frontends.report.page.page_context import PageContext
from roadproof.frontends.report.page.pieces import core, counts, filtered, folded, verdict
from roadproof.frontends.report.page.results import Result
from roadproof.library.motion import statement
from roadproof.verdict import Verdict


def evidence(findings: Sequence[Finding], context: PageContext, solver: str) -> Markup:
    """Evidence with what was found of it: certificates in a table, each drive with its viewer."""
    accepted = [x for x in findings if x.outcome is Acceptance.ACCEPTED]
    wrong = [(str(x.outcome), x.label, x.where, x.reason) for x in findings if x not in accepted]
    counted = Counter(x.verdict for x in accepted)
    kinds = joined([joined([n, " ", verdict(x)]) for x, n in counted.items()], ", ")
    told = f"{len(accepted)} of {len(findings)} accepted by {solver} and the exact judge: "
    proofs = [x for x in accepted if x.kind != "drive"]
    rows = [(verdict(x.verdict), x.label, tag("code", x.claim), _notes(x)) for x in proofs]
    parts: list[Content] = [tag("p", told, kinds)]
    parts += [table(("", "what", "where", "why"), wrong, class_="wrong")] if wrong else []
    parts += [filtered(table(("verdict", "what", "claim", "checked"), rows))] if rows else []
    paths = {id(finding): path for path, finding in context.findings.items()}
    for x in accepted:
        if x.kind == "drive" and id(x) in paths:
            shown, title = context.drive(paths[id(x)]), context.documents[-1]["title"]
            called = tag("b", f"{title} ({x.label.rpartition(' ')[2]})" if x.label else title)
            summary = (verdict(x.verdict), " ", called, " ", tag("code", x.claim))
            parts.append(folded(summary, tag("p", _notes(x), class_="faint"), shown))
    return joined(parts)


def _notes(finding: Finding) -> str:
    if finding.kind == NO_EVIDENCE:
        return "there is no evidence for it"
    unchecked = f"not checked: {', '.join(finding.unchecked)}" if finding.unchecked else ""
    return "; ".join([*finding.checked, *([unchecked] if unchecked else [])])


def claims(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """An index of claims, or the answer of ``prove --json``."""
    entries = [*_entries_of(result)]
    rows: list[tuple[Content, ...]] = []
    refuted: list[Markup] = []
    accepted = 0
    for number, x in enumerate(entries, 1):
        finding = context.finding(result.folder, x.evidence if isinstance(x, Claim) else x.certificate)
        if finding is None and result.folder is not None:
            finding = context.inside.get(f"{result.folder / INDEX}, claim {number}")
        accepted += finding is not None and finding.outcome is Acceptance.ACCEPTED
        claim = tag("code", statement(x.assuming, x.claim))
        outcome = "" if finding is None else str(finding.outcome)
        rows.append((verdict(x.verdict), _label(x), x.set, claim, outcome))
        if x.verdict is Verdict.REFUTED:
            refuted.append(
                folded((verdict("REFUTED"), f" {_label(x)} ", claim), _against(x, result, context))
            )
    told = f"; the evidence of {accepted} was accepted when this page was made" if accepted else ""
    head = ("verdict", "property", "set", "claim", "evidence")
    line = tag(
        "p",
        f"{len(entries)} claim{'s' if len(entries) != 1 else ''}: ",
        counts(x.verdict for x in entries),
        told,
    )
    return joined([line, filtered(table(head, rows)), *refuted])


def _entries_of(result: Result) -> Sequence[Claim | ClaimAnswer]:
    if result.schema == ANSWER_SCHEMA:
        return read(Answer, result.data, result.name).verdicts
    return read(Index, result.data, result.name).claims


def _label(claim: Claim | ClaimAnswer) -> str:
    if claim.property == OWN:
        return ""
    scenario = "" if claim.scenario is None else f" {claim.scenario}"
    return f"{claim.property}{f'-{claim.part}' if claim.part else ''}{scenario}"


def _against(claim: Claim | ClaimAnswer, result: Result, context: PageContext) -> Markup:
    if isinstance(claim, ClaimAnswer) and claim.refuted_by == "drive":
        return context.drive(claim.counterexample["drive"])
    if isinstance(claim, Claim) and claim.evidence is not None and result.folder is not None:
        return context.drive(result.folder / claim.evidence)
    return tag("p", "Refuted by a trace over points in time, which may jump; it is in the result.")


def witnesses(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """The answer of ``witness --json``."""
    made = []
    outcomes = read(drives.Answer, result.data, result.name).verdicts
    for x in outcomes:
        called = "" if x.scenario is None else f"scenario {x.scenario} {words.get(x.scenario, '')} "
        summary = (verdict(x.verdict), " ", tag("b", called), tag("code", x.formula))
        inside = [tag("p", x.reason)] if x.reason else []
        inside += [core(x.core)] if x.core else []
        made.append(folded(summary, *inside, *(context.drive(y) for y in x.drives)))
    return joined([tag("p", counts(x.verdict for x in outcomes)), *made])


_RELATIONS: Mapping[comparisons.Relation, str] = {
    "stronger": "The first implies the second, but not the reverse.",
    "weaker": "The second implies the first, but not the reverse.",
    "equivalent": "Each implies the other.",
    "incomparable": "Neither implies the other.",
    "unknown": "It is not known whether one implies the other.",
}


def comparison(result: Result, context: PageContext, words: Mapping[int, str]) -> Markup:
    """The answer of ``compare --json``."""
    answer = read(comparisons.Answer, result.data, result.name)
    one, two = answer.first, answer.second
    parts: list[Content] = [
        tag("p", "First: ", tag("code", one.formula), f" (set {one.set})"),
        tag("p", "Second: ", tag("code", two.formula), f" (set {two.set})"),
        tag("p", tag("b", _RELATIONS[answer.relation])),
    ]
    both = (("first implies second", answer.forward), ("second implies first", answer.backward))
    for name, x in both:
        shown = [] if x.drive is None else [context.drive(x.drive)]
        parts.append(folded((verdict(x.verdict), f" {name}"), tag("p", x.reason), *shown))
    return joined(parts)
