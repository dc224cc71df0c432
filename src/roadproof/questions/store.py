"""Where answers are: in a folder, in this user's cache, and in the archive that is shipped.

The folder has one file for each answer, named as its claim is named, and ``question.json``. In the cache and
the archive a file stands under the digest of its claim, of the work that was allowed, and of the version.
"""

import json
from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import Answer, Refutation, answer_data, is_answer, read_answer
from roadproof.evidence.answer_files import Undecided
from roadproof.evidence.claim import Claim
from roadproof.evidence.heading import library_of
from roadproof.evidence.specifications import keep_specifications
from roadproof.evidence.strict import LARGEST_EVIDENCE, LARGEST_INDEX, Fields, read_json
from roadproof.library.specification import Specification
from roadproof.questions.data import QUESTION, basis_data, question_data, read_question
from roadproof.questions.question import Answers, Growing, Question, Replacing
from roadproof.reasons import Why
from roadproof.runtime.archives import CACHE, JUDGED, Origin, recall, remember
from roadproof.runtime.budget import Work
from roadproof.runtime.cache import make_room
from roadproof.runtime.canonical import digest
from roadproof.runtime.files import make_folder, write_json
from roadproof.runtime.package_data import program
from roadproof.runtime.pool import Say
from roadproof.runtime.records import dataclass
from roadproof.runtime.version import ANSWERS


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
        if self.folder is None:
            return
        make_folder(self.folder)
        keep_specifications(self.folder, question.basis.library)
        head = self.folder / QUESTION
        former: Any = read_json(head, LARGEST_INDEX) if head.exists() else None
        if former is not None and isinstance(question, Growing):
            question = self._grown(question, say)
        data = json.loads(json.dumps(question_data(question)))
        if former is None or isinstance(question, Growing):
            write_json(head, data)
        elif former != data:
            if not isinstance(question, Replacing) or former.get("question") != question.kind:
                raise self._other()
            self.leave_only({})
            write_json(head, data)

    def _grown(self, question: Any, say: Say | None) -> Any:
        """Return the question with former ones of the folder; displaced ones and their views are removed."""
        assert self.folder is not None
        former = self._former(question)
        for name in question.displaced(former):
            if say is not None and (self.folder / f"{name}.json").exists():
                say(f"the answer '{name}' is that to another search, which this one displaces")
            for path in self.folder.glob(f"{name}.*"):
                path.unlink()
        return question.beside(former)

    def _former(self, question: Question[Any]) -> Question[Any]:
        """Return the question of the folder. Raises ``UsageError`` where it is of another kind or library."""
        assert self.folder is not None
        try:
            former = read_question(self.folder)
        except InputError:
            raise self._other() from None
        head = self.folder / QUESTION
        library = library_of(Fields(read_json(head, LARGEST_INDEX), str(head)))
        is_same = former.kind == question.kind and library == question.basis.library.fingerprint
        if not is_same or basis_data(former.basis) != basis_data(question.basis):
            raise self._other()
        return former

    def _other(self) -> UsageError:
        return UsageError(
            f"{self.folder} holds the answers to another question, or to this one under another library: "
            "name another folder with --out, or remove it"
        )

    @cached_property
    def _same_work(self) -> str:
        return digest(self.work, ANSWERS, program())

    def stands(self, answer: Answer) -> bool:
        """Return whether an answer need not be asked again: for ever, or with as much work."""
        evidence = answer.evidence
        return answer.is_final or (isinstance(evidence, Undecided) and evidence.work == self._same_work)

    def exhausted(self, answer: Answer) -> Answer:
        """Return an answer to which as much work adds nothing, with a mark that says so.

        Only searches in stages count all of their work; what the clock cut off has none.
        """
        evidence = answer.evidence
        if not self.work.staged or not isinstance(evidence, Undecided) or evidence.reason.kind is Why.CLOCK:
            return answer
        return replace(answer, evidence=replace(evidence, work=self._same_work))

    def key(self, claim: Claim) -> str:
        """The digest of all that an answer depends on."""
        return digest(claim.digest(), self.work, ANSWERS)

    def look_up(self, name: str, claim: Claim, say: Say | None = None) -> tuple[Answer, Origin | None] | None:
        """Return the answer to a claim that is known; None where none stands.

        It comes with its origin, which is None where the folder has it. ``say`` is told of a file in the
        folder that does not stand.
        """
        if self.folder is not None and (path := self.folder / f"{name}.json").is_file():
            try:
                answer = read_answer(claim, read_json(path, LARGEST_EVIDENCE), str(path))
                self._require_enough(answer, path)
                return answer, None
            except InputError as error:
                if say is not None:
                    say(f"a stored answer is invalid and is computed again: {error}")
        known = recall(self.kind, self.key(claim)) if self.reads_known else None
        if known is not None:
            with suppress(InputError):
                content = _said_in(claim.home, json.loads(known.text))
                answer = read_answer(claim, content, "a known answer", known.is_judged)
                known.note_judged()
                return answer, known.origin
        return None

    def _require_enough(self, answer: Answer, path: Path) -> None:
        """Raises ``InputError`` for a trace, where a drive is to be looked for that refutes it, too."""
        shown = answer.evidence
        if isinstance(shown, Refutation) and self.work.seek_drive and not shown.drive_sought:
            raise InputError(f"{path} is a trace, and no drive was looked for")

    def whole(self, answer: Answer) -> Answer:
        """Return an answer as files have it: a certificate with its tableau, if one is found."""
        proof = answer.certificate
        if self.folder is None or proof is None or proof.tableau is not None:
            return answer
        from roadproof.evidence.kernels import find_tableau  # here: most answers are written nowhere

        tableau = find_tableau(proof, answer.claim.home.library)
        return replace(answer, evidence=replace(proof, tableau=tableau))

    def keep(self, name: str, answer: Answer, is_new: bool = True) -> None:
        """Write an answer into the folder, and into the cache where it is new and stands."""
        if self.folder is None and not is_new:
            return
        data = answer_data(answer if is_new else self.whole(answer))
        if self.folder is not None:
            self.require_folder()
            write_json(self.folder / f"{name}.json", data)
        if is_new and self.reads_known and self.stands(answer):
            remember(self.key(answer.claim), json.dumps(data))

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

    def make_room(self) -> None:
        """Keep the cache within its bounds."""
        for folder in (CACHE, JUDGED):
            make_room(folder)


def _said_in(home: Specification, content: Any) -> Any:
    """Return a known file as it is written where a claim is read: one formula may be in several spec sets."""
    if not isinstance(content, dict) or "set" not in content:
        return content
    said = {**content, "set": home.set_name}
    if "options" in said:
        return {**said, "options": dict(home.options)}
    values = said.get("parameters", {})
    return {**said, "parameters": values | {x: y for x, y in home.options.items() if x in values}}


def keep_all(folder: Path, question: Question[Any], answers: Answers) -> None:
    """Write a question and its answers into a folder. Raises ``UsageError`` as ``Store.open``."""
    store = Store(folder, question.kind, question.work, reads_known=False)
    store.open(question)
    for name, answer in answers.items():
        store.keep(name, answer, is_new=False)
