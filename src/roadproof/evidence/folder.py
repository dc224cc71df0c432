"""A folder of evidence: files, and the indices and journals that say what the files show.

An index is a part of the evidence (ADR 0020). So every entry must be that of its file, every file must be
there, and no file may be without an entry. What is in a folder is read from the folder: links are refused.
"""

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType

from roadproof.errors import InputError, RoadproofError
from roadproof.evidence.answers import read
from roadproof.evidence.answers.entry import Entry, mismatch, read_evidence, stray_evidence
from roadproof.evidence.answers.reader import FindLabel
from roadproof.evidence.checking import without_place
from roadproof.evidence.finding import NO_EVIDENCE, Acceptance, Finding, OtherVerdict
from roadproof.evidence.heading import library_of
from roadproof.evidence.journal import ANSWERS, HEAD, Journal, faults_of_line, read_kept
from roadproof.evidence.refutation import judge_trace
from roadproof.evidence.specifications import read_beside
from roadproof.evidence.strict import LARGEST_INDEX, Fields, Json, JsonObject, read_json
from roadproof.library.motion import statement
from roadproof.library.specification import Library
from roadproof.reasons import NO_REASON, Reason, Why

INDEX = "index.json"
OTHER_LIBRARY = "whether its words meant the same in the other library that its index names"


@dataclass
class FolderStatements:
    """What the index and the journal of a folder say of the files in it and below it.

    ``specs`` are the specification files beside them; ``problems`` are found before any file is checked;
    ``unchecked`` is said of every entry; ``alone``: files that none names stand for themselves. ``others``
    are files that are no evidence, such as tables and pictures. ``question`` is the head of kept answers,
    ``kept_in_index`` whether the index says each of these in the same words.
    """

    folder: Path
    specs: tuple[Path, ...] = ()
    library: Library | None = None
    index: Fields | None = None
    entries: list[Entry] = field(default_factory=list)
    named: set[str] = field(default_factory=set)
    problems: list[Finding] = field(default_factory=list)
    unchecked: tuple[str, ...] = ()
    alone: bool = False
    others: list[str] = field(default_factory=list)
    question: Fields | None = None
    kept_in_index: bool = False

    @property
    def not_checked(self) -> tuple[str, ...]:
        """The fields of index and kept answers, and the files beside, that nothing is compared with."""
        has_drives = any(x.shows in ("drive", "counterexample") for x in self.entries)
        fields = () if self.index is None else read.unchecked_fields(self.index, has_drives)
        if self.question is not None:
            fields += read.unchecked_of_kept(self.question, self.kept_in_index, has_drives)
        return (*dict.fromkeys(fields), *sorted(self.others))


@dataclass(frozen=True)
class Survey:
    """The files to be checked with the specification files of each, and what is said of them."""

    files: Mapping[Path, tuple[Path, ...]]
    told: tuple[FolderStatements, ...]
    problems: tuple[Finding, ...]


def survey(
    paths: Sequence[Path], given: tuple[Path, ...], find_label: FindLabel, but: Collection[Path] = ()
) -> Survey:
    """What is in files and folders, but for the folders ``but``.

    Raises ``InputError`` for a path that is not there or holds nothing.
    """
    files: dict[Path, tuple[Path, ...]] = {}
    told: list[FolderStatements] = []
    problems: list[Finding] = []
    for path in paths:
        if not path.is_dir():
            if not path.exists():
                raise InputError(f"{path} does not exist")
            files.setdefault(path, given)
            continue
        inside, links = _walk(path, but)
        problems += [Finding(str(x), "", Acceptance.REJECTED, Why.LINK()) for x in links]
        homes = sorted({x.parent for x in inside if x.name in (INDEX, HEAD)})
        by_home = {home: _read_told(home, given, find_label) for home in homes}
        told += by_home.values()
        kept = {home / ANSWERS for home in homes if (home / HEAD).exists()}
        others = [x for x in inside if x.name not in (INDEX, HEAD) and x.parent not in kept]
        evidence = [x for x in others if x.suffix == ".json"]
        for x in {*others} - {*evidence}:
            home = next((folder for folder in x.parents if folder in by_home), None)
            if home is not None and x not in by_home[home].specs:
                by_home[home].others.append(x.relative_to(home).as_posix())
        if not evidence and not homes and not links and not any(x.is_relative_to(path) for x in but):
            raise InputError(f"{path} holds no .json file: name a folder with certificates or drive files")
        for x in evidence:
            home = next((folder for folder in x.parents if folder in by_home), None)
            files[x] = given if home is None else (*given, *by_home[home].specs)
            if home is not None:
                by_home[home].named.add(x.relative_to(home).as_posix())
    return Survey(files, tuple(told), tuple(problems))


def _walk(folder: Path, but: Collection[Path] = ()) -> tuple[list[Path], list[Path]]:
    """The files below a folder, in order, and the links; none in the folders ``but``."""
    files: list[Path] = []
    links: list[Path] = []
    waiting = [folder] if folder not in but else []
    while waiting:
        for path in sorted(waiting.pop(0).iterdir()):
            if path.is_symlink():
                links.append(path)
            elif path.is_dir():
                waiting += [path] if path not in but else []
            else:
                files.append(path)
    return files, links


def _read_told(home: Path, given: tuple[Path, ...], find_label: FindLabel) -> FolderStatements:
    told = FolderStatements(home)
    try:
        journal = read_kept(home)
    except RoadproofError as error:
        journal = None
        told.problems.append(_unreadable(home / HEAD, str(error)))
    try:
        if (home / INDEX).exists():
            content = read_json(home / INDEX, LARGEST_INDEX)
            told.index = read.index_fields(content, str(home / INDEX))
        named = told.index if told.index is not None else read.said_of(journal.head) if journal else None
        told.library, told.specs = read_beside(named, home, given)
        told.alone = journal is not None and told.index is None and read.reader_of(journal.head).alone
        if told.index is not None:
            if library_of(told.index) != told.library.fingerprint:
                told.unchecked = (OTHER_LIBRARY,)
            told.entries += _without_twins(told, read.read_index(told.index, told.library, find_label))
    except RoadproofError as error:
        told.problems.append(_unreadable(home / INDEX, str(error)))
        told.index = None
    if journal is not None and told.library is not None:
        _add_journal(told, journal, told.library, find_label)
    return told


def _unreadable(path: Path, fault: str) -> Finding:
    return Finding(str(path), "index", Acceptance.UNREADABLE, Why.TOLD(without_place(fault, path)))


def _without_twins(told: FolderStatements, entries: Sequence[Entry]) -> Iterator[Entry]:
    seen: dict[tuple[object, ...], Entry] = {}
    for entry in entries:
        first = seen.setdefault(entry.key, entry)
        if first is not entry:
            twin = Finding(entry.where, "index", Acceptance.REJECTED, Why.TWIN(first.where))
            told.problems.append(twin)
        yield entry


def _add_journal(told: FolderStatements, journal: Journal, library: Library, find_label: FindLabel) -> None:
    """The answers of a journal that the index does not say in the same words; of one file each the last."""
    index = None if told.index is None else _IndexLines(told.index)
    try:
        for fault in () if told.index is None else read.faults_of_head(journal.head, told.index):
            told.problems.append(_rejected(journal.path, fault))
    except RoadproofError as error:
        told.problems.append(_unreadable(journal.path, str(error)))
    known = set(map(_words_of, told.entries))
    kept: dict[tuple[object, ...], Entry] = {}
    for line in journal.lines:
        if line.record is None:
            told.problems.append(replace(_rejected(line.path, line.fault), outcome=Acceptance.UNREADABLE))
            continue
        if line.fault:
            told.problems.append(_rejected(line.path, line.fault))
        try:
            entries = read.read_record(journal.head, line.record, library, find_label)
            said = index is not None and all(map(index.has, read.reader_of(journal.head).lines(line.record)))
            in_index = said and {*map(_words_of, entries)} <= known
            for fault in faults_of_line(journal, line, line.record, entries, library, in_index):
                told.problems.append(_rejected(line.path, fault))
            if not in_index:
                kept |= {(line.path, *entry.key): entry for entry in entries}
        except RoadproofError as error:
            told.problems.append(_unreadable(line.path, str(error)))
    told.entries += kept.values()
    told.question, told.kept_in_index = journal.head, index is not None and not kept


class _IndexLines:
    """The objects of an index, each with its fields."""

    def __init__(self, index: Fields) -> None:
        self._objects = [*_objects(index.content)]
        self._words = frozenset(map(_as_text, self._objects))
        self._numbered = {n: x for x in self._objects if type(n := x.get("number")) is int}

    def has(self, line: object) -> bool:
        """Whether an object of the index has all fields of ``line``, with the same values."""
        if not isinstance(line, dict):
            return False
        return _as_text(line) in self._words or any(self._is_like(x, line) for x in self._objects)

    def _is_like(self, said: Mapping[str, Json], kept: Mapping[str, Json]) -> bool:
        return all(name in said and self._is_same(said[name], value) for name, value in kept.items())

    def _is_same(self, said: object, kept: object) -> bool:
        """Whether two values are equal, or numbers in the index stand for objects that are kept."""
        if _as_text(said) == _as_text(kept):
            return True
        if not isinstance(said, list) or not isinstance(kept, list) or len(said) != len(kept):
            return False
        return all(
            type(number) is int
            and number in self._numbered
            and isinstance(line, dict)
            and self._is_like(self._numbered[number], line)
            for number, line in zip(said, kept, strict=True)
        )


def _objects(content: Json) -> Iterator[JsonObject]:
    if isinstance(content, dict):
        yield content
        content = [*content.values()]
    for value in content if isinstance(content, list) else ():
        yield from _objects(value)


def _as_text(content: object) -> str:
    return json.dumps(content, sort_keys=True)


def _rejected(path: Path, fault: str) -> Finding:
    return Finding(str(path), "journal", Acceptance.REJECTED, Why.TOLD(without_place(fault, path)))


def _words_of(entry: Entry) -> tuple[object, ...]:
    return entry.key, entry.verdict, entry.claim, entry.file


_NOTHING_RULED: Mapping[str, OtherVerdict] = MappingProxyType({})


def conclude(
    surveyed: Survey, found: Mapping[Path, Finding], ruled: Mapping[str, OtherVerdict] = _NOTHING_RULED
) -> Iterator[Finding]:
    """A finding for each claim: of a file alone, or of an entry with its file; then what is wrong besides.

    ``ruled``: what Coq says of the traces of entries, by where these stand.
    """
    of_entries: set[Path] = set()
    for told in surveyed.told:
        of_entries |= {told.folder / name for name in told.named}
        yield from told.problems
        for entry in told.entries:
            yield _of_entry(entry, told, found, ruled.get(entry.where))
        yield from _strays(told, found)
        yield from _of_whole(told, found)
    yield from (finding for path, finding in found.items() if path not in of_entries)
    yield from surveyed.problems


def _of_entry(
    entry: Entry, told: FolderStatements, found: Mapping[Path, Finding], ruled: OtherVerdict | None
) -> Finding:
    """The entry's own words, where its evidence shows them."""
    finding = _bound(entry, told, found, ruled)
    if finding.outcome is not Acceptance.ACCEPTED or finding.kind == NO_EVIDENCE:
        return finding
    return replace(finding, unchecked=(*finding.unchecked, *told.unchecked))


def _bound(
    entry: Entry, told: FolderStatements, found: Mapping[Path, Finding], ruled: OtherVerdict | None
) -> Finding:
    verdict = "WITNESSED" if entry.shows == "drive" else entry.verdict
    claim = statement(entry.assuming, entry.claim) if entry.claim else ""
    said = Finding(entry.where, "index", Acceptance.ACCEPTED, NO_REASON, verdict, entry.label, claim)
    subject, set_name = entry.subject, entry.common.set_name
    said = replace(said, subject=subject.kind, name=subject.name, set=set_name)
    rejected = replace(said, outcome=Acceptance.REJECTED)
    fault = entry.fault or stray_evidence(entry)
    if fault:
        return replace(rejected, reason=_here(entry, fault))
    if entry.shows == "nothing":
        without = () if entry.verdict == "UNKNOWN" else ("there is no evidence for it",)
        return replace(said, kind=NO_EVIDENCE, unchecked=without)
    if entry.file is None:
        claimed = entry.common.specification, entry.claim or "", entry.where, entry.assuming
        outcome, reason = judge_trace(entry.trace, *claimed)
        if ruled is not None and outcome is Acceptance.ACCEPTED:
            outcome, reason = ruled.outcome, ruled.reason
        return replace(
            said,
            outcome=outcome,
            reason=reason,
            checked=("judged on its trace",) if outcome is Acceptance.ACCEPTED else (),
            kernel="" if ruled is None else ruled.word,
        )
    path = told.folder / entry.file
    if entry.file not in told.named or path not in found:
        return replace(rejected, reason=Why.NOT_THERE(entry.file))
    finding = found[path]
    said = replace(said, where=str(path), kind=finding.kind, kernel=finding.kernel)
    if finding.outcome is not Acceptance.ACCEPTED:
        return replace(said, outcome=finding.outcome, reason=finding.reason)
    try:
        fault = mismatch(entry, read_evidence(path))
    except RoadproofError as error:
        fault = str(error)
    if fault:
        return replace(said, outcome=Acceptance.REJECTED, reason=_here(entry, fault))
    unchecked = tuple(dict.fromkeys((*finding.unchecked, *entry.unchecked)))
    return replace(said, claim=claim or finding.claim, checked=finding.checked, unchecked=unchecked)


def _here(entry: Entry, fault: str) -> Reason:
    """What is wrong with an entry, without its place."""
    return Why.TOLD(fault.removeprefix(f"{entry.where}: ").removeprefix(f"{entry.where} "))


def _strays(told: FolderStatements, found: Mapping[Path, Finding]) -> Iterator[Finding]:
    """Files that no entry names. Where the index cannot be read, or is none, they stand for themselves."""
    mentioned = {entry.file for entry in told.entries}
    readable = (told.entries or told.index is not None) and not told.alone
    for name in sorted(told.named - mentioned):
        finding = found[told.folder / name]
        if readable and finding.outcome is Acceptance.ACCEPTED:
            yield replace(finding, outcome=Acceptance.REJECTED, reason=Why.UNNAMED())
        else:
            yield finding


def _of_whole(told: FolderStatements, found: Mapping[Path, Finding]) -> Iterator[Finding]:
    if told.index is None or told.library is None:
        return
    formulas = {
        name: found[told.folder / name].claim
        for name in told.named
        if found[told.folder / name].outcome is Acceptance.ACCEPTED
    }
    where = str(told.folder / INDEX)
    try:
        for fault in read.faults_of(told.index, told.library, formulas):
            yield Finding(where, "index", Acceptance.REJECTED, Why.TOLD(fault))
    except RoadproofError as error:
        yield Finding(where, "index", Acceptance.UNREADABLE, Why.TOLD(error))
