"""A folder of answers read again: its question lists the claims, and each file has to answer its own.

What is in a folder is read from the folder: links are refused, and so is a file that no claim is named after.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, StaleError
from roadproof.evidence.answer import ClaimAnswer, JudgedTrace, assumed_by, undecided
from roadproof.evidence.answer_codec import read_answer
from roadproof.evidence.claim import (
    HELP,
    Claim,
    ConfirmingJudge,
    Exists,
    On,
    OwnMode,
    TraceJudge,
    TraceJudgement,
)
from roadproof.evidence.codec import write
from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding
from roadproof.evidence.heading import library_of
from roadproof.evidence.strict import LARGEST_EVIDENCE, LARGEST_INDEX, Fields, read_json
from roadproof.evidence.subject import OTHER
from roadproof.library.assumption import claim_statement
from roadproof.questions.data import SCHEMA, read_question
from roadproof.questions.question import (
    QUESTION,
    Annotating,
    FindsUnknowns,
    HasUnknowns,
    Linkable,
    Question,
    QuestionBatch,
    require_place,
    walk_batch,
    work_of,
)
from roadproof.questions.store import Store
from roadproof.reasons import NO_REASON, ReasonKind
from roadproof.runtime.archives import is_off
from roadproof.runtime.records import dataclass

_ANY_VERSION = SCHEMA.rpartition("/")[0] + "/"
OTHER_LIBRARY = "whether its words meant the same in the other library that its question names"


@dataclass(frozen=True)
class QuestionFolder:
    """A question with the answers of a folder, by name.

    ``problems``: files that answer no claim, or not their own. ``others``: files that are no answers, such as
    tables and pictures. ``specs``: the specification files beside the answers. ``missing``: the names of
    claims without a file; ``refused``: of those whose file cannot be read, or is not theirs.
    ``is_other_library``: whether the question was asked with other definitions of the library. ``stores``:
    where an earlier run may have left the answer about a trace, by the name of its claim.
    """

    folder: Path
    question: Question[Any]
    specs: tuple[Path, ...]
    answers: Mapping[str, ClaimAnswer]
    problems: tuple[Finding, ...]
    others: tuple[str, ...]
    missing: frozenset[str] = frozenset()
    refused: frozenset[str] = frozenset()
    is_other_library: bool = False
    stores: Mapping[str, Store] = field(default_factory=dict)

    @property
    def files(self) -> dict[Path, str]:
        """The files with evidence, each with the name of its claim."""
        return {self.folder / f"{name}.json": name for name, x in self.answers.items() if x.is_final}

    def specs_of(self, name: str) -> tuple[Path, ...]:
        """Return the specification files that the evidence for a claim is read with.

        Those that come with roadproof and that only this claim needs are first.
        """
        texts = {x.text for x in self.question.basis.library.files}
        more = (x for x in self.answers[name].claim.home.library.files if x.text not in texts)
        return (*(Path(x.name) for x in more), *self.specs)

    @property
    def undecided(self) -> Iterator[Finding]:
        """A finding for each claim without evidence.

        Trees that are not there, or show a claim that is here without them, are no findings of their own.
        """
        trees = [x.claim for x in self.answers.values() if x.is_final and _wants_trees(x.claim)]
        for name, answer in self.answers.items():
            mode = answer.claim.mode
            is_shown = isinstance(mode, Exists) and (
                mode.trees or replace(answer.claim, mode=replace(mode, trees=True)) in trees
            )
            helps = name.startswith(HELP) and name not in self.missing
            if not answer.is_final and not is_shown and not helps and name not in self.refused:
                label, text = self.question.label(name), answer.claim.query.text
                where = str(self.folder / f"{name}.json")
                without = () if answer.verdict == "UNKNOWN" else ("there is no evidence for it",)
                finding = Finding(where, NO_EVIDENCE, Acceptance.ACCEPTED, label=label, claim=text)
                yield replace(finding, verdict=str(answer.verdict), unchecked=without)
        unknowns = [*self.question.undecided_parts] if isinstance(self.question, HasUnknowns) else []
        unknowns += self.question.unknowns(self.answers) if isinstance(self.question, FindsUnknowns) else []
        for about, reason in unknowns:
            finding = Finding(
                str(self.folder / QUESTION), NO_EVIDENCE, Acceptance.ACCEPTED, reason, label=about
            )
            yield replace(finding, verdict="UNKNOWN")

    def finding(self, name: str, finding: Finding, takes_over: bool = False) -> Finding:
        """Return what was found of a file, in the words of the question; a trace is judged again.

        ``takes_over``: not where this program has judged the trace before, and kept this very answer.
        """
        answer = self.answers[name]
        if isinstance(answer.claim.mode, On) and isinstance(answer.evidence, JudgedTrace):
            store = self.stores[name]
            same = takes_over and store.has_given(answer)
            if not same and (same := _is_so(answer.claim.mode.judge, answer.evidence.shows)):
                store.note(answer)
            outcome = Acceptance.ACCEPTED if same else Acceptance.REJECTED
            reason = NO_REASON if same else ReasonKind.NOT_SHOWN()
            finding = replace(finding, kind="test", outcome=outcome, reason=reason)
        annotated = replace(
            _about_claim(self.question, name, answer.claim, finding),
            verdict=str(answer.verdict),
            unchecked=(*finding.unchecked, *(OTHER_LIBRARY,) * self.is_other_library),
        )
        if isinstance(answer.claim.mode, OwnMode) and answer.claim.mode.is_open:
            annotated = replace(
                annotated, claim=finding.claim
            )  # which says the numbers that the claim leaves open
        return (
            self.question.annotate(name, answer, annotated)
            if isinstance(self.question, Annotating)
            else annotated
        )


def _is_so(judge: TraceJudge, shows: TraceJudgement) -> bool:
    if isinstance(judge, ConfirmingJudge):
        return judge.confirms(shows)
    return write(judge()) == write(shows)


def _wants_trees(claim: Claim) -> bool:
    return isinstance(claim.mode, Exists) and claim.mode.trees


def is_question(folder: Path) -> bool:
    """Return whether a folder holds answers to a question."""
    path = folder / QUESTION
    if not path.is_file() or path.is_symlink():
        return False
    try:
        content = read_json(path, LARGEST_INDEX)
    except InputError:
        return True  # it is damaged, which reading it says
    return isinstance(content, dict) and str(content.get("schema")).startswith(_ANY_VERSION)


def folders_in(paths: Sequence[Path]) -> list[Path]:
    """Return the folders among paths, and below them, that hold answers to a question."""
    heads = (x for path in paths if path.is_dir() for x in [path / QUESTION, *sorted(path.rglob(QUESTION))])
    return [*dict.fromkeys(x.parent for x in heads if is_question(x.parent))]


def read_folder(folder: Path, given: Sequence[Path] = ()) -> QuestionFolder:
    """Return the answers of a folder. Raises ``InputError`` where ``question.json`` cannot be read."""
    question = read_question(folder, given)
    there = {x.stem: x for x in folder.iterdir() if x.suffix == ".json" and x.name != QUESTION}
    answers: dict[str, ClaimAnswer] = {}
    problems: list[Finding] = []
    missing: set[str] = set()
    refused: set[str] = set()
    stores: dict[str, Store] = {}
    usual = Store(None, question.kind, question.work, reads_known=not is_off())

    def find(batch: QuestionBatch, name: str, claim: Claim) -> ClaimAnswer:
        """Return the answer in the file of a claim, judged again."""
        if name not in answers:
            path = there.pop(name, None)
            is_link = path is not None and path.is_symlink()
            outcome = Acceptance.REJECTED if is_link else Acceptance.UNREADABLE
            missing.update((name,) if path is None else ())
            try:
                content = None if path is None else _content(path)
                outcome = Acceptance.REJECTED
                answer = _read(claim, content, str(path))
                require_place(answer, work_of(question.work, batch, name), str(path))
                answers[name] = answer
                if isinstance(claim.mode, On):
                    stores[name] = replace(usual, work=work_of(usual.work, batch, name))
            except InputError as error:
                fault = ReasonKind.TOLD(error)
                where = str(folder / f"{name}.json")
                message = ReasonKind.TOLD(str(error).removeprefix(where).lstrip(": "))
                problems.append(_problem(question, name, claim, Finding(where, "", outcome, message), error))
                refused.add(name)
                answers[name] = undecided(claim, fault)
        return answers[name]

    seen: set[str] = set()
    while new := [x for x in question.batches(answers) if x.name not in seen]:
        for batch in new:
            seen.add(batch.name)
            [*walk_batch(batch, partial(find, batch))]
    problems += [
        Finding(str(path), "", Acceptance.REJECTED, ReasonKind.NOT_ITS_ANSWER()) for path in there.values()
    ]
    specs = tuple(folder / Path(x.name).name for x in question.basis.library.files)
    specs = tuple(x for x in specs if x.is_file())
    problems += _strays(folder)
    others = {x.name for x in folder.iterdir() if x.suffix != ".json" and not x.is_dir() and x not in specs}
    fingerprint = library_of(Fields(read_json(folder / QUESTION, LARGEST_INDEX), str(folder / QUESTION)))
    return QuestionFolder(
        folder,
        question,
        specs,
        answers,
        tuple(problems),
        tuple(sorted(others)),
        frozenset(missing),
        frozenset(refused),
        fingerprint != question.basis.library.fingerprint,
        stores,
    )


def _strays(folder: Path) -> Iterator[Finding]:
    """Yield a finding for each answer in a folder below that is no question of its own, and for each link."""
    within = {x.parent for x in folder.rglob(QUESTION)} - {folder}  # folders of their own
    strays = [x for x in folder.rglob("*.json") if x.parent != folder and within.isdisjoint(x.parents)]
    for path in sorted(strays):
        yield Finding(str(path), "", Acceptance.REJECTED, ReasonKind.NOT_ITS_ANSWER())
    for path in sorted(x for x in folder.iterdir() if x.is_symlink() and x.is_dir()):
        yield Finding(str(path), "", Acceptance.REJECTED, ReasonKind.LINK())


def _problem(
    question: Question[Any], name: str, claim: Claim, finding: Finding, error: InputError
) -> Finding:
    """Return what is wrong with a file, which is about the claim that it is named after.

    Where a test has changed since it was judged, the answer is stale.
    """
    about = _about_claim(question, name, claim, finding)
    if not isinstance(error, StaleError) or not isinstance(question, Linkable):
        return about
    return replace(about, kind="test", reason=ReasonKind.FILE_CHANGED(about.label))


def _about_claim(question: Question[Any], name: str, claim: Claim, finding: Finding) -> Finding:
    """Return a finding with what the question says of a claim: its label, its text and its subject."""
    linked = question.subject(name) if isinstance(question, Linkable) else OTHER
    return replace(
        finding,
        label=question.label(name),
        claim=claim_statement(assumed_by(claim), claim.query.text),
        subject=linked.kind,
        name=linked.name,
        set=linked.set or question.basis.specification.set_name,
    )


def _content(path: Path) -> object:
    """Return what a file says. Raises ``InputError`` for a link, and for what is no JSON object."""
    if path.is_symlink():
        raise InputError(f"{path}: a link is no evidence")
    content = read_json(path, LARGEST_EVIDENCE)
    Fields(content, str(path))
    return content


def _read(claim: Claim, content: object, where: str) -> ClaimAnswer:
    if content is None:
        return undecided(claim, ReasonKind.NO_ANSWER())
    if isinstance(claim.mode, On) and isinstance(content, dict) and "asked" in content:
        content = {**content, "asked": claim.mode.asked}  # its trace is judged again, whatever it was asked
    return read_answer(claim, content, where)
