"""One file of evidence, checked by what its schema says that it is, without what made it."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

from roadproof.errors import InputError, MissingSolverError, RoadproofError
from roadproof.evidence import certificate, drive_file, none_within
from roadproof.evidence.answer_files import JUDGED, REFUTATION, OwnEvidence, RefutationFile
from roadproof.evidence.answers.proofs import misnamed, shown
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.codec import read
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.finding import Acceptance, Finding, OtherVerdict
from roadproof.evidence.judged import judge_file, times_data
from roadproof.evidence.none_within import Derive, Derived, NoneWithinFile
from roadproof.evidence.refutation import judge_trace
from roadproof.evidence.strict import Fields, read_json
from roadproof.evidence.subject import SubjectKind
from roadproof.extension import entries, imported
from roadproof.library.bind import default_values, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import is_moving, statement
from roadproof.library.scenario_references import own_names
from roadproof.library.scenarios import Scenario, applied, name_of
from roadproof.library.specification import Library, Query
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import parameters_of
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.exact import Judgement
from roadproof.semantics.exact.replay import first_overlap

FindLabel: TypeAlias = Callable[[str, str], "tuple[str, str, int | None] | None"]
"""Property, part and scenario of a claim in a set, where it is a template property."""
SCHEMAS = (certificate.SCHEMA, *drive_file.SCHEMAS_READ, none_within.SCHEMA)
"""The files of evidence that are checked alone."""
_TEMPLATE = ("P", "C")  # what labels of template properties begin with, before a digit


@dataclass(frozen=True)
class Checker:
    """``ask`` answers sat, unsat or unknown to a script; ``find_label`` knows the template properties.

    ``ruled``: what was said of it elsewhere: of a certificate in place of asking for its queries, of a drive
    beside judging it. ``derive``: the encoder, for files that show a NONE-WITHIN.
    """

    library: Library
    ask: Callable[[str], str]
    find_label: FindLabel
    ruled: OtherVerdict | None = None
    derive: Derive | None = None

    def check(self, path: Path) -> Finding:
        """What a file shows. Never fails for what is in the file."""
        try:
            content = read_json(path)
            schema = Fields(content, str(path)).text("schema")
            if schema == certificate.SCHEMA:
                return self._certificate(path, certificate.read_certificate_data(content, str(path)))
            if schema in drive_file.SCHEMAS_READ:
                return self._drive(path, content)
            if schema == JUDGED:
                why = Why.WITH_QUESTION()
                return Finding(str(path), "test", Acceptance.UNREADABLE, why)
            if schema == REFUTATION:
                return self._refutation(path, read(RefutationFile, content, str(path)))
            if schema == none_within.SCHEMA and self.derive is not None:
                file = none_within.read_none_within(content, str(path))
                return self._none_within(path, file, self.derive(file, self.library))
            own = entries("evidence")
            if schema in own:
                kind: type[OwnEvidence] = imported(own[schema])
                return read(kind, content, str(path)).check(path, self.library)
            raise InputError(f"its schema is {schema[:60]!r}, but must be {' or '.join(SCHEMAS)}")
        except MissingSolverError:
            raise
        except BudgetExceeded as late:
            return Finding(str(path), "", Acceptance.UNDECIDED, late.reason)
        except RoadproofError as error:
            return Finding(str(path), "", Acceptance.UNREADABLE, Why.TOLD(without_place(str(error), path)))
        except Exception as error:
            # One file must not take the others with it; the exit code says whose fault it is.
            fault = f"{type(error).__name__}: {error}"[:300]
            return Finding(str(path), "", Acceptance.FAULT, Why.TOLD(fault))

    def _certificate(self, path: Path, file: Certificate) -> Finding:
        outcome, reason = self._rule(file)
        moving = is_moving(file.assumed.said)
        label = None if moving else self.find_label(file.claim, file.set_name)
        named_by = label_of(file)
        if outcome is Acceptance.ACCEPTED and named_by is not None and named_by != label:
            outcome, reason = Acceptance.REJECTED, Why.TOLD(misnamed("it", named_by, label))
        if outcome is Acceptance.UNREADABLE:
            reason = with_hint(reason, file.claim)
        named = shown(label, file.set_name)
        told = statement(file.assumed.said, file.claim)
        ruled = self.ruled or OtherVerdict(outcome, reason, "")
        read = (*ruled.checked, *other_readings(file.options, self.library))
        more = (read, ruled.unchecked) if outcome is Acceptance.ACCEPTED else ((), ())
        return Finding(
            str(path),
            "certificate",
            outcome,
            reason,
            "PROVED",
            named,
            told,
            *more,
            kernel=ruled.word,
            subject=SubjectKind.OTHER if label is None else SubjectKind.PROPERTY,
            name="" if label is None else named,
        )

    def _rule(self, file: Certificate) -> tuple[Acceptance, Reason]:
        if self.ruled is None:
            return certificate.rule(file, self.library, self.ask)
        unreadable = certificate.unreadable(file, self.library)
        return (Acceptance.UNREADABLE, unreadable) if unreadable else (self.ruled.outcome, self.ruled.reason)

    def _refutation(self, path: Path, file: RefutationFile) -> Finding:
        home = self.library.select(file.set, file.options)
        outcome, reason = judge_trace(file.trace, home, file.claim, str(path), file.assuming)
        if self.ruled is not None and outcome is Acceptance.ACCEPTED:
            outcome, reason = self.ruled.outcome, self.ruled.reason
        claim = statement(file.assuming, file.claim)
        checked = ("judged on its trace",) if outcome is Acceptance.ACCEPTED else ()
        word = "" if self.ruled is None else self.ruled.word
        said = Finding(str(path), "trace", outcome, reason, "REFUTED", "", claim, checked)
        return replace(said, kernel=word)

    def _none_within(self, path: Path, file: NoneWithinFile, derived: Derived) -> Finding:
        """Trees are checked against programs that the encoder derives again from the question."""
        fault = none_within.first_fault(file, derived)
        query = read_claim(self.library.select(file.set_name, file.options), file.formula)
        reason = Why.TOLD(fault) if fault else self._question_fault(file, query)
        outcome = Acceptance.REJECTED if reason else Acceptance.ACCEPTED
        if self.ruled is not None and not reason:
            outcome, reason = self.ruled.outcome, self.ruled.reason
        label = shown(None if file.scenario is None else ("", "", file.scenario), file.set_name)
        limits = (derived.limits, *none_within.own_parts(file), *other_readings(file.options, self.library))
        checked, unchecked = ((), ()) if reason else (limits, ("the encoder",))
        word = "" if self.ruled is None else self.ruled.word
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
        reason = ruling.reason or self._untold(file, content, ruling.judgement)
        outcome = Acceptance.REJECTED if reason else Acceptance.ACCEPTED
        if not ruling.readable:
            outcome, reason = Acceptance.UNREADABLE, with_hint(reason, file.formula)
        label = shown(None if file.scenario is None else ("", "", file.scenario), file.set_name)
        checked, unchecked = ((), ()) if reason else said_of(file, self.library)
        checked += other_readings(file.options, self.library) if checked else ()
        word = ""
        if self.ruled is not None:
            word = self.ruled.word
            if outcome is Acceptance.ACCEPTED:
                outcome, reason = self.ruled.outcome, self.ruled.reason
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

    def _untold(self, file: DriveFile, content: object, judgement: Judgement | None) -> Reason:
        """What a drive file says beside its formula, and is not so; or does not say, and should."""
        query = read_claim(self.library.select(file.set_name, file.options), file.formula)
        fault = self._question_fault(file, query)
        if fault:
            return fault
        said = Fields(Fields(content, "it").mapping("verdict"), "its verdict", _VERDICT)
        if said.has("verdict") and said.text("verdict") != "WITNESSED":
            return Why.OTHER_VERDICT(said.text("verdict"))
        if said.has("view") and said.text("view") != "dense":
            return Why.OTHER_VIEW(said.text("view"))
        if said.has("natural"):
            said.flag("natural")
        if said.has("times") and judgement is not None and said.get("times") != times_data(judgement):
            return Why.OTHER_TIMES()
        return NO_REASON

    def _question_fault(self, file: DriveFile | NoneWithinFile, query: Query) -> Reason:
        """Which value a file lacks, or why its formula is not that of the scenario that it names."""
        specification = self.library.select(file.set_name, file.options)
        unsaid = [x for x in specification.options if x not in file.options]
        unsaid += [x for x in parameters_of(query.formula) if x not in file.values]
        if unsaid:
            return Why.UNSAID(unsaid[0])
        if file.scenario is None:
            return NO_REASON
        if name_of(file.scenario) not in specification.definitions:
            return Why.NO_SCENARIO(file.scenario)
        scenario = Scenario(file.scenario, file.set_name)
        whole, own = applied(specification, scenario), own_names(specification, query.claim, scenario)
        same = whole.formula == query.formula or own
        return NO_REASON if same else Why.OTHER_SCENARIO(file.scenario, file.formula)


_VERDICT = ("verdict", "view", "natural", "times")


def label_of(file: Certificate) -> tuple[str, str, int | None] | None:
    """The template property that a certificate says it is of; None where it has a name of another kind."""
    name, _, part = file.property.partition("-")
    if name[:1] in _TEMPLATE and name[1:].isascii() and name[1:].isdigit():
        return name, part, file.scenario
    return None if file.scenario is None else (file.property, "", file.scenario)


def said_of(file: DriveFile, library: Library) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """What was checked of a drive that is accepted, and what was not, in words."""
    other = other_values(file, library)
    checked = ["dense, unbounded time", f"with {', '.join(other)}" if other else "declared parameters"]
    overlap = first_overlap(file.drive, None) if len(file.drive.vehicles) > 1 else None
    unchecked = ["limits of vehicles"]
    if overlap is None:
        checked += ["boxes apart for ever"] * (len(file.drive.vehicles) > 1)
    elif file.overlaps_allowed:
        checked.append(f"collisions allowed: {overlap}")
    else:
        checked.append(f"boxes apart up to {_seconds(file.horizon)} s; after that {overlap}")
    return tuple(checked), tuple(unchecked)


def other_readings(options: Mapping[str, str], library: Library) -> tuple[str, ...]:
    """Readings of a file that are not those by default, in words."""
    usual = library.select().options
    other = [f"{name}={value}" for name, value in sorted(options.items()) if usual.get(name) != value]
    return (f"read with {', '.join(other)}",) if other else ()


def other_values(file: DriveFile, library: Library) -> list[str]:
    """The parameters of a drive file with other values than those declared, in words."""
    declared = default_values(library)
    values = values_with(library, file.values)
    return [f"{name}={value}" for name, value in sorted(values.items()) if declared.get(name) != value]


def _seconds(value: Fraction) -> str:
    return f"{float(value):g}"


def with_hint(reason: Reason, claim: str) -> Reason:
    """Why a claim cannot be read, with what to do where it is well written."""
    try:
        parse_claim(claim)
    except RoadproofError:
        return reason
    return Why.NEEDS_SPECIFICATIONS(reason.split("\n", 1)[0])


def without_place(message: str, path: Path) -> str:
    """A message without the path in front, which a finding says anyway."""
    return message.removeprefix(f"{path}: ").removeprefix(f"{path} ").removeprefix(f"{path}, ")
