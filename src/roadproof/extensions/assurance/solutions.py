"""Checks the solutions of an assurance case: their evidence as ``check`` does, then the expected verdicts."""

import hashlib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from roadproof.errors import MissingSolverError, RoadproofError
from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding
from roadproof.evidence.strict import LARGEST_INDEX, Fields, Json, read_json
from roadproof.extensions.assurance.case.case import Evidence
from roadproof.extensions.assurance.case.limits import BOUNDED, DIGEST, Limit, limits_of
from roadproof.extensions.assurance.case.states import ElementState
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.frontends.api.checking import take_over
from roadproof.frontends.settings.keywords import CheckKeywords
from roadproof.questions import prove_data, witness_data
from roadproof.questions.checking import is_question
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

WHOLE = ("COVERED", "GAPS")
"""Verdicts of an answer as a whole."""
ANSWERS = (prove_data.SCHEMA, witness_data.SCHEMA)
RESULTS = "results.json"
"""The results of recordings in a folder, which ``check`` does not read."""
_OPEN = ("UNKNOWN", "NONE-WITHIN")


@dataclass(frozen=True)
class SolutionCheck:
    """The result of checking a solution's evidence.

    ``reasons``: why it does not hold; ``verdicts``: the number of accepted entries by verdict; ``exit_code``:
    the one that ``check`` gives for these reasons.
    """

    state: ElementState
    reasons: tuple[Reason, ...]
    exit_code: ExitCode
    verdicts: Mapping[str, int]
    sha256: str
    limits: tuple[Limit, ...]


def check_evidence(path: Path, keywords: CheckKeywords) -> tuple[Finding, ...] | RoadproofError:
    """Return the findings of ``check`` for a file or folder, or the error why it cannot be read.

    In an answer of ``--json``, verdicts within limits are accepted without evidence, because they have none.
    """
    try:
        stated = _answer_findings(path) if path.is_file() else None
        return take_over(path, **keywords).findings if stated is None else stated
    except MissingSolverError:
        raise
    except RoadproofError as error:
        return error


def _answer_findings(path: Path) -> tuple[Finding, ...] | None:
    """Return findings for the verdicts of ``prove --json`` or ``witness --json``, None for all
    other files.
    """
    try:
        data = Fields(read_json(path, LARGEST_INDEX), str(path))
        if data.text("schema") not in ANSWERS:
            return None
    except RoadproofError:
        return None
    findings = []
    for number, entry in enumerate(data.items("verdicts"), 1):
        answer = Fields(entry, f"{path}, answer {number}")
        verdict = answer.text("verdict")
        claim = answer.text("claim" if answer.has("claim") else "formula")
        accepted = verdict in BOUNDED
        outcome = Acceptance.ACCEPTED if accepted else Acceptance.UNDECIDED
        reason = NO_REASON if accepted else ReasonKind.NAME_FOLDER()
        findings.append(Finding(answer.where, NO_EVIDENCE, outcome, reason, verdict, "", claim))
    return tuple(findings)


def judge_solution(
    path: Path, evidence: Evidence, report: tuple[Finding, ...] | RoadproofError | None, strict: bool
) -> SolutionCheck:
    """Return the state of a solution from the check of its evidence."""
    if isinstance(report, RoadproofError) or not path.exists():
        reason = (
            ReasonKind.TOLD(report)
            if isinstance(report, RoadproofError)
            else ReasonKind.NO_FILE(evidence.path)
        )
        code = report.exit_code if isinstance(report, RoadproofError) else ExitCode.BAD_INPUT
        return SolutionCheck(ElementState.BROKEN, (reason,), ExitCode(code), {}, "", ())
    digest = digest_of(path)
    faults: list[_Fault] = []
    if evidence.sha256 not in ("", digest):
        faults.append(
            _Fault(ElementState.BROKEN, ReasonKind.DIGEST(evidence.path, digest), ExitCode.UNEXPECTED)
        )
    limits: tuple[Limit, ...] = ()
    verdicts: Mapping[str, int] = {}
    if report is None:
        alone = Limit(DIGEST, (f"{evidence.path} is compared with its SHA-256 only",))
        limits = (alone, *limits_of([path, path / RESULTS], ()))
    else:
        entries = () if {*WHOLE} & {*evidence.expect} else evidence.select
        counted = [x for x in report if _counts(x, entries)]
        accepted = [x for x in counted if x.outcome is Acceptance.ACCEPTED]
        faults += _faults(path, evidence, counted, strict)
        verdicts = Counter(str(x.verdict) for x in accepted)
        views = [folder_data(path)] if path.is_dir() and is_question(path) else []
        limits = limits_of(_files(path, accepted, evidence), accepted, views)
    state = max((x.state for x in faults), key=[*ElementState].index, default=ElementState.HOLDS)
    codes = (x.code for x in faults if x.state is state)
    reasons = tuple(dict.fromkeys(x.reason for x in faults))
    return SolutionCheck(state, reasons, max(codes, default=ExitCode.AS_EXPECTED), verdicts, digest, limits)


@dataclass(frozen=True)
class _Fault:
    """A reason why a solution does not hold, with its state and exit code."""

    state: ElementState
    reason: Reason
    code: ExitCode


def _counts(finding: Finding, select: Sequence[str]) -> bool:
    """Return whether a finding is about a selected entry, or about damage that concerns all entries."""
    if _is_selected((finding.label, Path(finding.where).name), select):
        return True
    return finding.outcome is not Acceptance.ACCEPTED and not finding.label


def _faults(path: Path, evidence: Evidence, counted: Sequence[Finding], strict: bool) -> Iterator[_Fault]:
    for x in counted:
        if x.outcome is not Acceptance.ACCEPTED:
            state = ElementState.UNDECIDED if x.outcome is Acceptance.UNDECIDED else ElementState.BROKEN
            yield _Fault(state, ReasonKind.NOT_ACCEPTED(x.outcome, _named(x), x.reason), x.outcome.exit_code)
    whole = [x for x in evidence.expect if x in WHOLE]
    each = [x for x in evidence.expect if x not in WHOLE]
    word, why = whole_verdict(path, evidence.select) if whole else ("", "")
    if whole and word not in whole:
        state = ElementState.UNDECIDED if word in ("UNKNOWN", "") else ElementState.BROKEN
        code = ExitCode.UNKNOWN if state is ElementState.UNDECIDED else ExitCode.UNEXPECTED
        words = evidence.path, word or "without a verdict", " or ".join(whole)
        yield _Fault(state, ReasonKind.WHOLE_BECAUSE(*words, why) if why else ReasonKind.WHOLE(*words), code)
    accepted = [x for x in counted if x.outcome is Acceptance.ACCEPTED]
    if not counted:
        none = ReasonKind.NO_ENTRY(evidence.path, ", ".join(evidence.select) or "anything")
        yield _Fault(ElementState.BROKEN, none, ExitCode.UNEXPECTED)
    elif evidence.entries not in (None, len(counted)):
        other = ReasonKind.ENTRIES(evidence.path, len(counted), evidence.entries)
        yield _Fault(ElementState.BROKEN, other, ExitCode.UNEXPECTED)
    for x in accepted if each else ():
        if x.verdict not in each:
            is_open = x.verdict in _OPEN
            code = ExitCode.UNKNOWN if is_open else ExitCode.UNEXPECTED
            unlike = ReasonKind.EXPECTED(x.verdict, _named(x), " or ".join(each))
            yield _Fault(ElementState.UNDECIDED if is_open else ElementState.BROKEN, unlike, code)
        elif strict and x.kind == NO_EVIDENCE:
            yield _Fault(
                ElementState.UNDECIDED, ReasonKind.LACKS_EVIDENCE(x.verdict, _named(x)), ExitCode.UNKNOWN
            )


def _named(finding: Finding) -> str:
    """Return the label of an accepted finding, else the name of its file."""
    accepted = finding.outcome is Acceptance.ACCEPTED
    return finding.label if accepted and finding.label else Path(finding.where).name


def whole_verdict(path: Path, select: Sequence[str] = ()) -> tuple[str, str]:
    """Return the verdict of an answer as a whole, empty where it has none, and the reason for it.

    A catalogue is COVERED where its tests show every scenario and class that ``select`` names (all without
    patterns), and are what they claim.
    """
    try:
        data = Fields(_answer_in(path), str(path))
    except RoadproofError:
        return "", ""
    if "not_tested" in data.content:
        names = [x for x in data.texts("not_tested") if _is_selected((x,), select)]
        faults = len(data.items("faults"))
        gaps = [f"not tested: {', '.join(names[:5])}{', …' * (len(names) > 5)}"] if names else []
        gaps += [f"{faults} not what they claim"] if faults else []
        return "GAPS" if gaps else "COVERED", "; ".join(gaps)
    word = data.content.get("verdict")
    return (word if isinstance(word, str) else ""), ""


def _answer_in(path: Path) -> Json:
    """Return an answer: the content of a file, or the combined answers of a folder."""
    return folder_data(path) if is_question(path) else read_json(path, LARGEST_INDEX)


def _is_selected(names: Sequence[str], select: Sequence[str]) -> bool:
    return not select or any(fnmatchcase(name, x) for name in names for x in select)


def _files(path: Path, accepted: Sequence[Finding], evidence: Evidence) -> list[Path]:
    """Return the files of accepted findings and the answer itself, which state limits."""
    files = [Path(x.where) for x in accepted if Path(x.where).suffix == ".json"]
    return [*dict.fromkeys(x for x in (*files, path) if x.is_file())]


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file, or of the names and digests of a folder's files."""
    if not path.is_dir():
        return hashlib.sha256(path.read_bytes()).hexdigest()
    files = sorted(x for x in path.rglob("*") if x.is_file())
    lines = (f"{digest_of(x)}  {x.relative_to(path).as_posix()}\n" for x in files)
    return hashlib.sha256("".join(lines).encode()).hexdigest()
