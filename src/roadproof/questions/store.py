"""The store of answers: a folder, the user's cache, and the shipped archive.

The folder has one file for each answer, named as its claim is named, and ``question.json``. In the cache and
the archive a file stands under the digest of its claim, of the work that was allowed, and of the version, and
of the packages of others that decide the claim. An undecided answer stands there only if counted work ended
it, and its key covers the claims before it, too: their drives and proofs might have decided it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, assert_never

from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import ClaimAnswer, RefutingTrace
from roadproof.evidence.answer_codec import answer_data, is_answer, read_answer
from roadproof.evidence.answer_files import UndecidedFile
from roadproof.evidence.claim import Claim
from roadproof.evidence.strict import LARGEST_EVIDENCE, read_json
from roadproof.library.specification import Specification
from roadproof.questions.foreign_code import foreign_code
from roadproof.questions.question import QUESTION, Answers, EarlierAnswers, Question, require_place
from roadproof.runtime.archives import CACHE, JUDGED, Origin, recall, remember
from roadproof.runtime.budget import Work
from roadproof.runtime.cache import evict_old
from roadproof.runtime.canonical import digest
from roadproof.runtime.files import write_json
from roadproof.runtime.package_data import program_digest
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import ANSWERS

if TYPE_CHECKING:
    from roadproof.runtime.pool import Say


@dataclass(frozen=True)
class Store:
    """The three places; ``folder`` None: answers are not written.

    ``kind`` of question; ``work``: what was allowed for a claim; ``reads_known``: whether cache and archive
    are read.
    """

    folder: Path | None
    kind: str
    work: Work
    reads_known: bool = True

    def open(self, question: Question[Any], say: Say | None = None) -> None:
        """Begin a folder, or go on in it; ``say`` is told of answers that others displace.

        Raises ``UsageError`` where it holds another question's answers.
        """
        if self.folder is not None:
            from roadproof.questions.folder import open_folder  # here: most answers are written nowhere

            open_folder(self.folder, question, lambda: self.leave_only({}), say)

    @contextmanager
    def opened(self, question: Question[Any], say: Say | None = None) -> Iterator[None]:
        """Open the folder for a run; a mistake of the user leaves the question that was there before."""
        if self.folder is None:
            yield
            return
        from roadproof.questions.folder import FormerFolder  # here: as in ``open``

        former = FormerFolder.of(self.folder)
        self.open(question, say)
        try:
            yield
        except (UsageError, InputError):
            former.restore(self.folder, question.basis.library)
            raise

    def _same_work(self, claim: Claim) -> str:
        return digest(self.work, ANSWERS, program_digest(), *foreign_code(self.kind, claim))

    def stands(self, answer: ClaimAnswer) -> bool:
        """Return whether an answer need not be asked again: for ever, or with as much work."""
        evidence = answer.evidence
        return answer.is_final or (
            isinstance(evidence, UndecidedFile) and evidence.work == self._same_work(answer.claim)
        )

    def exhausted(self, answer: ClaimAnswer) -> ClaimAnswer:
        """Return an answer to which as much work adds nothing, with a mark that says so."""
        evidence = answer.evidence
        if not isinstance(evidence, UndecidedFile):
            return answer
        from roadproof.evidence.ending import Ending, ending_of  # here: stored answers had such an ending

        match ending_of(evidence):
            case Ending.WORK:
                return self._marked(answer, evidence)
            case Ending.MACHINE | Ending.UNSTATED:
                return answer
            case ending:
                assert_never(ending)

    def _marked(self, answer: ClaimAnswer, evidence: UndecidedFile) -> ClaimAnswer:
        return replace(answer, evidence=replace(evidence, work=self._same_work(answer.claim)))

    def key(self, claim: Claim) -> str:
        """The digest of all that evidence depends on, such as the version of a foreign extension."""
        return digest(claim.digest(), self.work, ANSWERS, *foreign_code(self.kind, claim))

    def undecided_key(self, claim: Claim, earlier: EarlierAnswers) -> str:
        """The digest of all that an undecided answer depends on."""
        return digest(self.key(claim), earlier.digest())

    def look_up(
        self, name: str, claim: Claim, earlier: EarlierAnswers, say: Say | None = None
    ) -> tuple[ClaimAnswer, Origin | None] | None:
        """Return the answer to a claim that is known and stands; None where there is none.

        It comes with its origin, which is None where the folder has it. ``earlier``: the answers to the
        claims of the batch before this one. ``say`` is told of an invalid file in the folder.
        """
        if self.folder is not None and (path := self.folder / f"{name}.json").is_file():
            try:
                answer = read_answer(claim, read_json(path, LARGEST_EVIDENCE), str(path))
                self._require_enough(answer, path)
                if self.stands(answer):
                    return answer, None
            except InputError as error:
                if say is not None:
                    say(f"a stored answer is invalid and is computed again: {error}")
        if not self.reads_known:
            return None
        return self._known(claim, self.key(claim)) or self._known(claim, self.undecided_key(claim, earlier))

    def _known(self, claim: Claim, key: str) -> tuple[ClaimAnswer, Origin] | None:
        """Return the answer of cache or archive under a key."""
        known = recall(self.kind, key)
        if known is not None:
            with suppress(InputError):
                content = _restated(claim.home, json.loads(known.text))
                answer = read_answer(claim, content, "a known answer", known.is_judged)
                known.note_judged()
                if isinstance(answer.evidence, UndecidedFile):
                    answer = self._marked(answer, answer.evidence)
                return answer, known.origin
        return None

    def has_given(self, answer: ClaimAnswer) -> bool:
        """Return whether this program has given this very answer to the claim, in an earlier run.

        A shipped answer is that of another run, which nothing here has judged.
        """
        known = self._known(answer.claim, self.key(answer.claim)) if self.reads_known else None
        if known is None:
            return False
        former, origin = known
        return origin == "cache" and answer_data(former) == answer_data(answer)

    def note(self, answer: ClaimAnswer) -> None:
        """Remember an answer that this program has judged again, for ``has_given``."""
        if self.reads_known:
            remember(self.key(answer.claim), json.dumps(answer_data(answer)))

    def _require_enough(self, answer: ClaimAnswer, path: Path) -> None:
        """Require that as much was looked for as is asked.

        Raises ``InputError`` for a trace where a drive is to be looked for, too, and for a drive elsewhere.
        """
        shown = answer.evidence
        if isinstance(shown, RefutingTrace) and self.work.seek_drive and not shown.drive_sought:
            raise InputError(f"{path} is a trace, and no drive was looked for")
        require_place(answer, self.work, str(path))

    def whole(self, answer: ClaimAnswer) -> ClaimAnswer:
        """Return an answer as files have it: a certificate with its tableau, if one is found."""
        proof = answer.certificate
        if self.folder is None or proof is None or proof.tableau is not None:
            return answer
        from roadproof.evidence.kernels import find_tableau  # here: most answers are written nowhere

        tableau = find_tableau(proof, answer.claim.home.library)
        return replace(answer, evidence=replace(proof, tableau=tableau))

    def keep(self, name: str, answer: ClaimAnswer, earlier: EarlierAnswers | None = None) -> None:
        """Write an answer into the folder, and into the cache where it is new and stands.

        ``earlier``: the answers to the claims before that of a new answer; None for an answer that is known.
        """
        is_new = earlier is not None
        if self.folder is None and not is_new:
            return
        data = answer_data(answer if is_new else self.whole(answer))
        if self.folder is not None:
            self.require_folder()
            write_json(self.folder / f"{name}.json", data)
        if earlier is not None and self.reads_known and self.stands(answer):
            remember(*self.shipped_text(answer, earlier))

    def shipped_text(self, answer: ClaimAnswer, earlier: EarlierAnswers) -> tuple[str, str]:
        """Return the key and the text of an answer that stands, for the cache and the archive."""
        evidence = answer.evidence
        if not isinstance(evidence, UndecidedFile):
            return self.key(answer.claim), json.dumps(answer_data(answer))
        unmarked = replace(answer, evidence=replace(evidence, work=None))
        return self.undecided_key(answer.claim, earlier), json.dumps(answer_data(unmarked))

    def leave_only(self, answers: Answers, say: Say | None = None) -> None:
        """Remove answers to claims that are asked no more, since others were answered; ``say`` is told."""
        every = [] if self.folder is None else sorted(self.folder.glob("*.json"))
        for path in every:
            if path.stem not in answers and path.name != QUESTION and not path.is_symlink():
                content = read_json(path, LARGEST_EVIDENCE)
                if isinstance(content, dict) and is_answer(str(content.get("schema"))):
                    path.unlink()
                    if say is not None:
                        say(f"a stored answer is asked for no more and is removed: {path}")

    def require_folder(self) -> None:
        """Raises ``InputError`` where the folder was removed since it was opened."""
        if self.folder is not None and not (self.folder / QUESTION).exists():
            raise InputError(
                f"{self.folder} or its {QUESTION} was removed during the run, and with it evidence that the "
                "answer would name: run the command again"
            )

    def evict_old(self) -> None:
        """Keep the cache within its bounds."""
        for folder in (CACHE, JUDGED):
            evict_old(folder)


def _restated(home: Specification, content: Any) -> Any:
    """Return a known file as it is written where a claim is read: one formula may be in several spec sets."""
    if not isinstance(content, dict) or "set" not in content:
        return content
    restated = {**content, "set": home.set_name}
    if "options" in restated:
        return {**restated, "options": dict(home.options)}
    values = restated.get("parameters", {})
    return {**restated, "parameters": values | {x: y for x, y in home.options.items() if x in values}}


def keep_all(folder: Path, question: Question[Any], answers: Answers) -> None:
    """Write a question and its answers into a folder. Raises ``UsageError`` as ``Store.open``."""
    store = Store(folder, question.kind, question.work, reads_known=False)
    store.open(question)
    for name, answer in answers.items():
        store.keep(name, answer)
