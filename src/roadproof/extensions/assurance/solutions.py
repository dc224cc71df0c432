"""The solutions of an assurance case: their evidence checked as ``check`` does, and what it shows."""

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
from roadproof.extensions.assurance.case.states import State
from roadproof.frontends.api.checking import take_over
from roadproof.frontends.settings.keywords import CheckKeywords
from roadproof.questions import prove, witness
from roadproof.questions.checking import is_question
from roadproof.questions.views import folder_data
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode

WHOLE = ("COVERED", "GAPS")
"""Verdicts of a whole answer."""
ANSWERS = (prove.SCHEMA, witness.SCHEMA)
RESULTS = "results.json"
"""The results of recordings in a folder, which ``check`` does not read."""
_OPEN = ("UNKNOWN", "NONE-WITHIN")


@dataclass(frozen=True)
class SolutionCheck:
    """The evidence of a solution, checked: ``verdicts`` by number of accepted entries, ``reasons`` why it
    does not hold, and the exit code that ``check`` gives them."""

    state: State
    reasons: tuple[Reason, ...]
    exit_code: ExitCode
    verdicts: Mapping[str, int]
    sha256: str
    limits: tuple[Limit, ...]


def check_evidence(path: Path, told: CheckKeywords) -> tuple[Finding, ...] | RoadproofError:
    """What ``check`` finds of a file or folder, or why it cannot read it.

    In an answer of ``--json`` verdicts within limits stand for themselves: they have no evidence.
    """
    try:
        stated = _stated(path) if path.is_file() else None
        return take_over(path, **told).findings if stated is None else stated
    except MissingSolverError:
        raise
    except RoadproofError as error:
        return error


def _stated(path: Path) -> tuple[Finding, ...] | None:
    """The verdicts of an answer of ``prove --json`` or ``witness --json``; None for all other files."""
    try:
        data = Fields(read_json(path, LARGEST_INDEX), str(path))
        if data.text("schema") not in ANSWERS:
            return None
    except RoadproofError:
        return None
    found = []
    for number, entry in enumerate(data.items("verdicts"), 1):
        said = Fields(entry, f"{path}, answer {number}")
        verdict = said.text("verdict")
        claim = said.text("claim" if said.has("claim") else "formula")
        accepted = verdict in BOUNDED
        outcome = Acceptance.ACCEPTED if accepted else Acceptance.UNDECIDED
        reason = NO_REASON if accepted else Why.NAME_FOLDER()
        found.append(Finding(said.where, NO_EVIDENCE, outcome, reason, verdict, "", claim))
    return tuple(found)


def judge_solution(
    path: Path, evidence: Evidence, report: tuple[Finding, ...] | RoadproofError | None, strict: bool
) -> SolutionCheck:
    """The state of a solution by the check of its evidence."""
    if isinstance(report, RoadproofError) or not path.exists():
        told = Why.TOLD(report) if isinstance(report, RoadproofError) else Why.NO_FILE(evidence.path)
        code = report.exit_code if isinstance(report, RoadproofError) else ExitCode.BAD_INPUT
        return SolutionCheck(State.BROKEN, (told,), ExitCode(code), {}, "", ())
    digest = digest_of(path)
    faults: list[_Fault] = []
    if evidence.sha256 not in ("", digest):
        faults.append(_Fault(State.BROKEN, Why.DIGEST(evidence.path, digest), ExitCode.UNEXPECTED))
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
    state = max((x.state for x in faults), key=[*State].index, default=State.HOLDS)
    codes = (x.code for x in faults if x.state is state)
    reasons = tuple(dict.fromkeys(x.reason for x in faults))
    return SolutionCheck(state, reasons, max(codes, default=ExitCode.AS_EXPECTED), verdicts, digest, limits)


@dataclass(frozen=True)
class _Fault:
    """Why a solution does not hold, with the exit code of that."""

    state: State
    reason: Reason
    code: ExitCode


def _counts(finding: Finding, select: Sequence[str]) -> bool:
    """Whether a finding is about a selected entry, or damage that concerns all of them."""
    if _is_selected((finding.label, Path(finding.where).name), select):
        return True
    return finding.outcome is not Acceptance.ACCEPTED and not finding.label


def _faults(path: Path, evidence: Evidence, counted: Sequence[Finding], strict: bool) -> Iterator[_Fault]:
    for x in counted:
        if x.outcome is not Acceptance.ACCEPTED:
            state = State.UNDECIDED if x.outcome is Acceptance.UNDECIDED else State.BROKEN
            yield _Fault(state, Why.NOT_ACCEPTED(x.outcome, _named(x), x.reason), x.outcome.exit_code)
    whole = [x for x in evidence.expect if x in WHOLE]
    each = [x for x in evidence.expect if x not in WHOLE]
    word, why = whole_verdict(path, evidence.select) if whole else ("", "")
    if whole and word not in whole:
        state = State.UNDECIDED if word in ("UNKNOWN", "") else State.BROKEN
        code = ExitCode.UNKNOWN if state is State.UNDECIDED else ExitCode.UNEXPECTED
        told = evidence.path, word or "without a verdict", " or ".join(whole)
        yield _Fault(state, Why.WHOLE_BECAUSE(*told, why) if why else Why.WHOLE(*told), code)
    accepted = [x for x in counted if x.outcome is Acceptance.ACCEPTED]
    if not counted:
        none = Why.NO_ENTRY(evidence.path, ", ".join(evidence.select) or "anything")
        yield _Fault(State.BROKEN, none, ExitCode.UNEXPECTED)
    elif evidence.entries not in (None, len(counted)):
        other = Why.ENTRIES(evidence.path, len(counted), evidence.entries)
        yield _Fault(State.BROKEN, other, ExitCode.UNEXPECTED)
    for x in accepted if each else ():
        if x.verdict not in each:
            open_ = x.verdict in _OPEN
            code = ExitCode.UNKNOWN if open_ else ExitCode.UNEXPECTED
            unlike = Why.EXPECTED(x.verdict, _named(x), " or ".join(each))
            yield _Fault(State.UNDECIDED if open_ else State.BROKEN, unlike, code)
        elif strict and x.kind == NO_EVIDENCE:
            yield _Fault(State.UNDECIDED, Why.LACKS_EVIDENCE(x.verdict, _named(x)), ExitCode.UNKNOWN)


def _named(finding: Finding) -> str:
    """The label of a finding, else the name of its file."""
    accepted = finding.outcome is Acceptance.ACCEPTED
    return finding.label if accepted and finding.label else Path(finding.where).name


def whole_verdict(path: Path, select: Sequence[str] = ()) -> tuple[str, str]:
    """The verdict of an answer as a whole, empty where it has none, and why it is so.

    Of a catalogue: COVERED where its tests show every scenario and class that ``select`` names (all where it
    names none), and are what they claim.
    """
    try:
        data = Fields(_answer_in(path), str(path))
    except RoadproofError:
        return "", ""
    if "not_tested" in data.content:
        names = [x for x in data.texts("not_tested") if _is_selected((x,), select)]
        faults = len(data.items("faults"))
        told = [f"not tested: {', '.join(names[:5])}{', …' * (len(names) > 5)}"] if names else []
        told += [f"{faults} not what they claim"] if faults else []
        return "GAPS" if told else "COVERED", "; ".join(told)
    word = data.content.get("verdict")
    return (word if isinstance(word, str) else ""), ""


def _answer_in(path: Path) -> Json:
    """An answer: a file, or what the answers of a folder show together."""
    return folder_data(path) if is_question(path) else read_json(path, LARGEST_INDEX)


def _is_selected(names: Sequence[str], select: Sequence[str]) -> bool:
    return not select or any(fnmatchcase(name, x) for name in names for x in select)


def _files(path: Path, accepted: Sequence[Finding], evidence: Evidence) -> list[Path]:
    """The files of evidence of accepted findings, and the answers of the folder that state limits."""
    files = [Path(x.where) for x in accepted if Path(x.where).suffix == ".json"]
    return [*dict.fromkeys(x for x in (*files, path) if x.is_file())]


def digest_of(path: Path) -> str:
    """The SHA-256 of a file; of a folder that of the names and digests of its files."""
    if not path.is_dir():
        return hashlib.sha256(path.read_bytes()).hexdigest()
    files = sorted(x for x in path.rglob("*") if x.is_file())
    lines = (f"{digest_of(x)}  {x.relative_to(path).as_posix()}\n" for x in files)
    return hashlib.sha256("".join(lines).encode()).hexdigest()
