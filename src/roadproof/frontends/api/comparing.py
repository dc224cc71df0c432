"""Two formulas side by side."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Unpack

from roadproof.analysis.study.evidence_store import keep_specifications, specification_names
from roadproof.analysis.study.pool import count_workers
from roadproof.engines.search.compare import DIRECTIONS, Comparison, Direction
from roadproof.engines.search.compare import compare as compare_queries
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.question import SearchOptions
from roadproof.engines.solve.milp import prepare
from roadproof.errors import UsageError
from roadproof.evidence.answers import compare as kept
from roadproof.evidence.answers.compare import SCHEMA
from roadproof.evidence.certificate import to_json
from roadproof.evidence.codec import write
from roadproof.evidence.heading import heading
from roadproof.evidence.kinds import Evidence
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.api.answer import Answer, Picture
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.settings import setting, work_of
from roadproof.frontends.api.studied import drive_pictures
from roadproof.frontends.report import compare as compare_report
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.keywords import CompareKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import Compare
from roadproof.library.compose import taken_from
from roadproof.library.specification import Library, Specification
from roadproof.runtime.files import make_folder, write_json, write_whole
from roadproof.runtime.progress import Listener, listening
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict
from roadproof.world.road import Road


@dataclass(frozen=True, repr=False)
class ComparisonAnswer(Answer):
    """Two formulas side by side; ``relation``: equivalent, stronger, weaker, incomparable or unknown."""

    specification: Specification
    comparison: Comparison
    road: Road | None = None

    @property
    def library(self) -> Library:
        return self.specification.library

    @property
    def relation(self) -> str:
        return self.comparison.relation

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {name: x.verdict for name, x in self.comparison.directions.items()}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        found = [x.certificate or x.drive for x in self.comparison.directions.values()]
        return tuple(x for x in found if x is not None)

    @property
    def exit_code(self) -> ExitCode:
        return ExitCode.UNKNOWN if self.relation == "unknown" else ExitCode.AS_EXPECTED

    @property
    def _sheet(self) -> Sheet[tuple[str, Direction]]:
        return compare_report.sheet_of(self.comparison)

    def as_data(self) -> JsonObject:
        found = self.comparison
        one, two = found.sets
        answer = kept.Answer(
            **heading(SCHEMA, self.library),
            **kept.Answer.of_road(self.road),
            first=kept.Side(formula=found.first.text, set=one),
            second=kept.Side(formula=found.second.text, set=two),
            relation=found.relation,
            forward=found.forward.kept,
            backward=found.backward.kept,
        )
        return write(answer)

    def _specs(self, folder: Path) -> list[Path]:
        return [folder / name for name in specification_names(self.library)]

    def _write(self, folder: Path, pictures: bool) -> None:
        make_folder(folder)
        if self.evidence:
            keep_specifications(folder, self.library)
        for name, direction in self.comparison.directions.items():
            stem = name.replace(" ", "-")
            if direction.certificate is not None:
                write_whole(folder / f"{stem}.json", to_json(direction.certificate).encode())
            elif direction.drive is not None:
                write_json(folder / f"not-{stem}.json", direction.drive.as_data())

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        drives = ((name, x.drive) for name, x in self.comparison.directions.items())
        return drive_pictures(drives, self.library)

    def __str__(self) -> str:
        return compare_report.as_text(self.comparison, self.specification)


@takes(Compare)
def compare(
    first: What,
    second: What,
    using: Definitions | None = None,
    *,
    each: Callable[[str, Direction], object] | None = None,
    stage: Listener | None = None,
    **options: Unpack[CompareKeywords],
) -> ComparisonAnswer:
    """Which of two formulas implies the other.

    Both directions are asked at once where there are two cores, or as many ``jobs`` as are said, each with
    this ``effort`` and ``timeout``; ``each`` is told of a direction ("first implies second" or the reverse)
    when its answer is there, and ``stage`` of each stage that begins (``stages.Stage``): what they raise ends
    all. Where ``using`` has two spec sets, the second formula is of the second one. Drives that tell the two
    apart are looked for as by ``witness``. Raises as that does.
    """
    given = Compare.of(options)
    home = definitions_of(using)
    if len(home.sets) > 2:
        raise UsageError(f"{len(home.sets)} spec sets are given: two formulas have at most two")
    other = home.sets[-1]
    query = replace(home, specification=home.specification.in_set(other)).read(second)
    work = work_of(given)
    search = Search(
        home.specification,
        home.read(first),
        setting(home, given),
        SearchOptions(engine=given.engine, solver=given.solver, effort=work),
    )
    processes = count_workers(DIRECTIONS, given.jobs)
    if processes > 1:
        prepare()
    against = taken_from(home.specification, query, other)
    with listening(stage):
        found = compare_queries(search, against, other, processes, each)
    return ComparisonAnswer(home.specification, found, search.setting.road)
