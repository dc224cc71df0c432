"""The check of one file of evidence, by its schema and without the program that made it."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

from roadproof.core_record import CERTIFICATE, DRIVES, JUDGED, NONE_WITHIN, REFUTATION
from roadproof.errors import InputError, MissingSolverError, RoadproofError
from roadproof.evidence import drive_file
from roadproof.evidence.answer_files import OwnEvidence, RefutationFile
from roadproof.evidence.answers.proofs import misnamed, shown
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import read_certificate_data
from roadproof.evidence.certify import check_certificate, unreadable_reason
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile, other_values
from roadproof.evidence.finding import (
    Acceptance,
    Finding,
    LimitRemark,
    RemarkKind,
    SecondOpinion,
    parameter_remark,
)
from roadproof.evidence.judged import judge_file, times_data
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.evidence.none_within_check import Derive, Derived, deviations, first_fault
from roadproof.evidence.none_within_file import read_none_within
from roadproof.evidence.refutation import judge_trace
from roadproof.evidence.strict import Fields, read_json
from roadproof.evidence.subject import SubjectKind
from roadproof.extension import entries, import_entry
from roadproof.library.assumption import assumes_motion, claim_statement
from roadproof.library.elaborate import read_claim
from roadproof.library.scenario_references import vehicles_by_role
from roadproof.library.scenarios import Scenario, apply_scenario, name_of
from roadproof.library.specification import Library, Query
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import parameters_of
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import Judgement
from roadproof.semantics.exact.replay import first_overlap

FindLabel: TypeAlias = Callable[[str, str], "tuple[str, str, int | None] | None"]
"""Returns property, part and scenario of a claim in a set; None if it is no template property."""
SCHEMAS = (CERTIFICATE, *DRIVES, NONE_WITHIN)
"""The schemas of evidence that can be checked alone."""
_TEMPLATE = ("P", "C")  # first letters of template properties; a digit follows


@dataclass(frozen=True)
class Checker:
    """A checker with a library, an SMT solver and the names of the template properties.

    ``ask`` answers sat, unsat or unknown to an SMT-LIB script; ``find_label`` returns the template property
    of a claim. ``opinion``: the verdict of a kernel; it replaces the queries of a certificate, and must agree
    about a drive. ``derive``: the encoder, which derives the programs of a NONE-WITHIN file again.
    """

    library: Library
    ask: Callable[[str], str]
    find_label: FindLabel
    opinion: SecondOpinion | None = None
    derive: Derive | None = None

    def check(self, path: Path) -> Finding:
        """Return the finding of a file. Errors in the file become findings; only a missing solver raises."""
        try:
            content = read_json(path)
            schema = Fields(content, str(path)).text("schema")
            if schema == CERTIFICATE:
                return self._certificate(path, read_certificate_data(content, str(path)))
            if schema in DRIVES:
                return self._drive(path, content)
            if schema == JUDGED:
                why = ReasonKind.WITH_QUESTION()
                return Finding(str(path), "test", Acceptance.UNREADABLE, why)
            if schema == REFUTATION:
                return self._refutation(path, read(RefutationFile, content, str(path)))
            if schema == NONE_WITHIN and self.derive is not None:
                file = read_none_within(content, str(path))
                return self._none_within(path, file, self.derive(file, self.library))
            own = entries("evidence")
            if schema in own:
                kind: type[OwnEvidence] = import_entry(own[schema])
                return read(kind, content, str(path)).check(path, self.library)
            raise InputError(f"its schema is {schema[:60]!r}, but must be {' or '.join(SCHEMAS)}")
        except MissingSolverError:
            raise
        except BudgetExceeded as late:
            return Finding(str(path), "", Acceptance.UNDECIDED, late.reason)
        except RoadproofError as error:
            return Finding(
                str(path), "", Acceptance.UNREADABLE, ReasonKind.TOLD(without_place(str(error), path))
            )
        except Exception as error:
            # One file must not take the others with it; the exit code says whose fault it is.
            fault = f"{type(error).__name__}: {error}"[:300]
            return Finding(str(path), "", Acceptance.FAULT, ReasonKind.TOLD(fault))

    def _certificate(self, path: Path, file: Certificate) -> Finding:
        outcome, reason = self._rule(file)
        moving = assumes_motion(file.assumed.texts)
        label = None if moving else self.find_label(file.claim, file.set_name)
        named_by = label_of(file)
        if outcome is Acceptance.ACCEPTED and named_by is not None and named_by != label:
            outcome, reason = Acceptance.REJECTED, ReasonKind.TOLD(misnamed("it", named_by, label))
        if outcome is Acceptance.UNREADABLE:
            reason = with_hint(reason, file.claim)
        named = shown(label, file.set_name)
        claim = claim_statement(file.assumed.texts, file.claim)
        opinion = self.opinion or SecondOpinion(outcome, reason, "")
        readings = (*opinion.checked, *other_readings(file.options, self.library))
        notes = (readings, opinion.unchecked) if outcome is Acceptance.ACCEPTED else ((), ())
        return Finding(
            str(path),
            "certificate",
            outcome,
            reason,
            "PROVED",
            named,
            claim,
            *notes,
            kernel=opinion.word,
            subject=SubjectKind.OTHER if label is None else SubjectKind.PROPERTY,
            name="" if label is None else named,
        )

    def _rule(self, file: Certificate) -> tuple[Acceptance, Reason]:
        """Return whether a certificate is accepted, by the kernel if there is one, and the reason if not."""
        if self.opinion is None:
            return check_certificate(file, self.library, self.ask)
        unreadable = unreadable_reason(file, self.library)
        return (
            (Acceptance.UNREADABLE, unreadable) if unreadable else (self.opinion.outcome, self.opinion.reason)
        )

    def _refutation(self, path: Path, file: RefutationFile) -> Finding:
        home = self.library.select(file.set, file.options)
        outcome, reason = judge_trace(file.trace, home, file.claim, str(path), file.assuming)
        if self.opinion is not None and outcome is Acceptance.ACCEPTED:
            outcome, reason = self.opinion.outcome, self.opinion.reason
        claim = claim_statement(file.assuming, file.claim)
        checked = ("judged on its trace",) if outcome is Acceptance.ACCEPTED else ()
        word = "" if self.opinion is None else self.opinion.word
        finding = Finding(str(path), "trace", outcome, reason, "REFUTED", "", claim, checked)
        return replace(finding, kernel=word)

    def _none_within(self, path: Path, file: NoneWithinFile, derived: Derived) -> Finding:
        """Return the finding of trees, checked against programs that the encoder derives again."""
        fault = first_fault(file, derived)
        query = read_claim(self.library.select(file.set_name, file.options), file.formula)
        reason = ReasonKind.TOLD(fault) if fault else self._question_fault(file, query)
        outcome = Acceptance.REJECTED if reason else Acceptance.ACCEPTED
        if self.opinion is not None and not reason:
            outcome, reason = self.opinion.outcome, self.opinion.reason
        label = shown(None if file.scenario is None else ("", "", file.scenario), file.set_name)
        limits = (derived.limits, *deviations(file), *other_readings(file.options, self.library))
        checked, unchecked = ((), ()) if reason else (limits, ("the encoder",))
        word = "" if self.opinion is None else self.opinion.word
        return Finding(
            str(path),
            "certificate",
            outcome,
            reason,
            "NONE-WITHIN",
            label,
            file.formula,
            checked,
            unchecked,
            kernel=word,
        )

    def _drive(self, path: Path, content: object) -> Finding:
        file = drive_file.read_drive(content, str(path))
        ruling = judge_file(file, self.library)
        reason = ruling.reason or self._statement_fault(file, content, ruling.judgement)
        outcome = Acceptance.REJECTED if reason else Acceptance.ACCEPTED
        if not ruling.readable:
            outcome, reason = Acceptance.UNREADABLE, with_hint(reason, file.formula)
        label = shown(None if file.scenario is None else ("", "", file.scenario), file.set_name)
        checked, unchecked = ((), ()) if reason else checked_parts(file, self.library)
        checked += other_readings(file.options, self.library) if checked else ()
        word = ""
        if self.opinion is not None:
            word = self.opinion.word
            if outcome is Acceptance.ACCEPTED:
                outcome, reason = self.opinion.outcome, self.opinion.reason
        if not reason and "natural" in Fields(content, str(path)).mapping("verdict"):
            unchecked = (*unchecked, "whether it is natural")
        return Finding(
            str(path),
            "drive",
            outcome,
            reason,
            "WITNESSED",
            label,
            file.formula,
            checked,
            unchecked,
            kernel=word,
        )

    def _statement_fault(self, file: DriveFile, content: object, judgement: Judgement | None) -> Reason:
        """Return the first wrong or missing statement of a drive file beside its formula, or nothing."""
        query = read_claim(self.library.select(file.set_name, file.options), file.formula)
        fault = self._question_fault(file, query)
        if fault:
            return fault
        verdict = Fields(Fields(content, "it").mapping("verdict"), "its verdict", _VERDICT)
        if verdict.has("verdict") and verdict.text("verdict") != "WITNESSED":
            return ReasonKind.OTHER_VERDICT(verdict.text("verdict"))
        if verdict.has("view") and verdict.text("view") != "dense":
            return ReasonKind.OTHER_VIEW(verdict.text("view"))
        if verdict.has("natural"):
            verdict.flag("natural")
        if verdict.has("times") and judgement is not None and verdict.get("times") != times_data(judgement):
            return ReasonKind.OTHER_TIMES()
        return NO_REASON

    def _question_fault(self, file: DriveFile | NoneWithinFile, query: Query) -> Reason:
        """Return which value a file lacks, or why its formula is not that of the scenario that it names."""
        specification = self.library.select(file.set_name, file.options)
        missing = [x for x in specification.options if x not in file.options]
        missing += [x for x in parameters_of(query.formula) if x not in file.values]
        if missing:
            return ReasonKind.UNSAID(missing[0])
        if file.scenario is None:
            return NO_REASON
        if name_of(file.scenario) not in specification.definitions:
            return ReasonKind.NO_SCENARIO(file.scenario)
        scenario = Scenario(file.scenario, file.set_name)
        applied = apply_scenario(specification, scenario)
        roles = vehicles_by_role(specification, query.claim, scenario)
        agrees = applied.formula == query.formula or roles
        return NO_REASON if agrees else ReasonKind.OTHER_SCENARIO(file.scenario, file.formula)


_VERDICT = ("verdict", "view", "natural", "times")


def label_of(file: Certificate) -> tuple[str, str, int | None] | None:
    """Return the template property that a certificate claims to prove; None for names of another kind."""
    name, _, part = file.property.partition("-")
    if name[:1] in _TEMPLATE and name[1:].isascii() and name[1:].isdigit():
        return name, part, file.scenario
    return None if file.scenario is None else (file.property, "", file.scenario)


def checked_parts(file: DriveFile, library: Library) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return which parts of an accepted drive were checked, and which were not, as text."""
    other = other_values(file, library)
    checked = ["dense, unbounded time", parameter_remark(other)]
    overlap = first_overlap(file.drive, None) if len(file.drive.vehicles) > 1 else None
    unchecked = ["limits of vehicles"]
    if overlap is None:
        checked += ["boxes apart for ever"] * (len(file.drive.vehicles) > 1)
    elif file.overlaps_allowed:
        checked.append(LimitRemark(RemarkKind.COLLISIONS, f"collisions allowed: {overlap}", "allowed"))
    else:
        text = f"boxes apart up to {_seconds(file.horizon)} s; after that {overlap}"
        checked.append(LimitRemark(RemarkKind.COLLISIONS, text))
    return tuple(checked), tuple(unchecked)


def other_readings(options: Mapping[str, str], library: Library) -> tuple[str, ...]:
    """Return the options of a file that differ from the defaults, as text."""
    usual = library.select().options
    other = [f"{name}={value}" for name, value in sorted(options.items()) if usual.get(name) != value]
    return (f"read with {', '.join(other)}",) if other else ()


def _seconds(value: Fraction) -> str:
    return f"{float(value):g}"


def with_hint(reason: Reason, claim: str) -> Reason:
    """Return the reason why a claim cannot be read, with the hint to pass ``--spec`` if its syntax is
    right.
    """
    try:
        parse_claim(claim)
    except RoadproofError:
        return reason
    return ReasonKind.NEEDS_SPECIFICATIONS(reason.split("\n", 1)[0])


def without_place(message: str, path: Path) -> str:
    """Return a message without the path in front, since the finding names the file."""
    return message.removeprefix(f"{path}: ").removeprefix(f"{path} ").removeprefix(f"{path}, ")
