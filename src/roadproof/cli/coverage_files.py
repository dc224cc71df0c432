"""Where the evidence of ``roadproof coverage`` goes, and what was answered before."""

import json
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.evidence import said_once
from roadproof.cli.options import json_text, write_text
from roadproof.cli.working import work

if TYPE_CHECKING:
    from roadproof.analysis.coverage.claims import Covered
    from roadproof.analysis.coverage.classes import Answer, Group, Survey
    from roadproof.analysis.coverage.needed import Need

Entry = dict[str, Any]


@dataclass(frozen=True)
class PictureJob:
    entry: Entry
    drive: Mapping[str, Any]
    path: Path
    specs: tuple[Path, ...]


class Evidence:
    """Answers by component; with a folder, drives and certificates are files there, beside a journal."""

    def __init__(self, folder: Path | None, survey: "Survey") -> None:
        from roadproof.analysis.journal import Journal
        from roadproof.evidence.answers.coverage import SCHEMA
        from roadproof.study.shelf import Question

        self.folder = folder
        self.asked = survey.asked
        names = {"set": survey.asked.sets[0], "wider": list(survey.wider)}
        self.said: Entry = {**names, **said_once(survey.asked, folder)}
        self.answers: dict[str, list[Entry]] = {}
        self.journal: Journal | None = None
        self.shown: list[tuple[Entry, Entry]] = []
        if folder is not None:
            # Not the roads: what was decided on some of them stays so, and doubts are asked again.
            question = Question(SCHEMA, self.said, survey.asked.question(), survey.asked.load()[0])
            self.journal = Journal(folder, question)
            self.answers = {x["group"]: x["classes"] for x in self.journal.answers()}

    def has(self, group: "Group") -> bool:
        """Whether the group was answered, in this run or before."""
        return group.name in self.answers

    def keep(self, group: "Group", answers: "Sequence[Answer]") -> None:
        """Write the evidence of a group, then a line in the journal."""
        entries = [self._entry(answer, f"{group.name}-{k}") for k, answer in enumerate(answers)]
        self.answers[group.name] = entries
        gaps = [gap for entry in entries for gap in entry["gaps"]]
        files = [entry["certificate"] for entry in entries]
        files += [path for gap in gaps for path in (gap["drive"], *gap["elsewhere"].values())]
        if self.journal is not None and all(entry["verdict"] != "UNKNOWN" for entry in entries):
            names = [Path(path).name for path in files if path is not None]
            self.journal.add({"evidence": names, "group": group.name, "classes": entries})

    def entries(self, survey: "Survey") -> tuple[list[Entry], list[Entry]]:
        """All classes in order, their gaps by numbers; and all gaps, counted from 1 on."""
        from roadproof.analysis.coverage.classes import groups_of

        classes: list[Entry] = []
        gaps: list[Entry] = []
        for group in groups_of(survey) if self.answers else []:
            for entry in self.answers[group.name]:
                first = len(gaps) + 1
                gaps += [{"number": first + k, **gap} for k, gap in enumerate(entry["gaps"])]
                classes.append({**entry, "gaps": list(range(first, len(gaps) + 1))})
                self.shown += [(entry, gap) for gap in entry["gaps"]]
        return classes, gaps

    def claims(self, covered: "Sequence[Covered]") -> list[Entry]:
        """The claims of coverage, with their certificates."""
        return [
            {
                "claim": x.claim,
                "verdict": str(x.verdict),
                "certificate": self._text(f"covered-{number}.json", x.certificate),
                "reason": x.reason,
            }
            for number, x in enumerate(covered, 1)
        ]

    def needs(self, needs: "Sequence[Need]") -> list[Entry]:
        """The definitions that a set replaces, with the drives that show them needed."""
        entries = []
        for need in needs:
            drive = None if need.drive is None else self._drive(f"needed-{need.definition}.json", need.drive)
            names = {"definition": need.definition, "extends": need.parent, "verdict": str(need.verdict)}
            entries.append({**names, "road": need.road, "formula": need.formula, "drive": drive})
        return entries

    def draw(self, processes: int | None) -> None:
        """A picture of each gap, beside its file."""
        jobs = []
        for entry, gap in self.shown:
            path = Path(gap["drive"])
            if not path.with_suffix(".png").exists():
                drive = json.loads(path.read_text("utf-8"))
                jobs.append(PictureJob(entry, drive, path, self.asked.specs))
        if jobs:
            with closing(work(draw_one, jobs, processes, "pictures")) as done:
                list(done)

    def _entry(self, answer: "Answer", stem: str) -> Entry:
        part = answer.part
        gaps = []
        for number, gap in enumerate(answer.gaps, 1):
            name = f"gap-{stem}-{number}".replace(" ", "-")
            placed = {
                road: self._drive(f"{name}-{road}.json", drive) for road, drive in gap.elsewhere.items()
            }
            gaps.append(
                {
                    "road": gap.road,
                    "formula": gap.formula,
                    "first": gap.first,
                    "caught_by": [list(names) for names in gap.caught_by],
                    "classes": list(gap.classes),
                    "drive": self._drive(f"{name}.json", gap.drive),
                    "elsewhere": placed,
                }
            )
        return {
            "scenario": None if part is None else part.scenario,
            "component": "" if part is None else part.component,
            "description": "" if part is None else part.description,
            "condition": "" if part is None else part.condition,
            "verdict": str(answer.verdict),
            "gaps": gaps,
            "claim": answer.claim,
            "certificate": self._text(f"empty-{stem}.json", answer.certificate),
            "reason": answer.reason,
            "none_for": list(answer.none_for),
        }

    def _drive(self, name: str, drive: Mapping[str, Any]) -> object:
        return dict(drive) if self.folder is None else self._text(name, json_text(drive))

    def _text(self, name: str, content: str | None) -> str | None:
        """The path of a file with this content, or the content where there is no folder."""
        if self.folder is None or content is None:
            return content
        write_text(self.folder / name, content)
        return str(self.folder / name)


def draw_one(job: PictureJob) -> None:
    """Draw one gap."""
    from roadproof.files import write_whole
    from roadproof.report.coverage import draw_gap
    from roadproof.spec.library import load_library

    for kind, content in draw_gap(job.entry, job.drive, load_library(job.specs)).items():
        write_whole(job.path.with_suffix(f".{kind}"), content)
