"""The cases of a catalogue for build servers: its tests, and its targets."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.report.cases import Case, CaseRule, Location, State, definition_location
from roadproof.library.specification import Specification
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.extensions.catalogue.catalogue_data import Remark
    from roadproof.extensions.catalogue.targets import Targets


def catalogue_cases(
    tests: Sequence[str],
    targets: Targets,
    sources: Mapping[str, str] | None = None,
    specification: Specification | None = None,
) -> Iterator[Case]:
    """Yield a case for each test, which fails where the test has a fault, and one for each target.

    ``sources``: the file that names each test; cases have no places without it.
    """
    remarks: tuple[tuple[Verdict | CaseRule, State, Sequence[Remark]], ...] = (
        (Verdict.UNKNOWN, "undecided", targets.doubts),
        (CaseRule.WRONG_TEST, "failed", targets.faults),
        (CaseRule.CONTRADICTION, "failed", targets.contradictions),
    )
    wrong = {x.tests[0]: (rule, state, x.told) for rule, state, those in remarks for x in those}
    for test in tests:
        file = (sources or {}).get(test)
        place = None if file is None else test_location(file, test)
        case = Case(suite="tests", name=test, state="passed", place=place)
        if test in wrong:
            rule, state, message = wrong[test]
            case = replace(case, state=state, rule=rule, message=message)
        yield case
    missing = {x.name for x in targets.missing}
    for x in (*targets.targets, *(targets.gaps.targets if targets.gaps.required else ())):
        case = Case(suite="tested", name=x.name, state="passed")
        if x.name in targets.gaps.open:
            message = f"in doubt: {targets.gaps.open[x.name]}"
            case = replace(case, state="undecided", rule=Verdict.UNKNOWN, message=message)
        elif x.name in missing:
            message = f"no test shows {x.words}"
            case = replace(case, state="failed", rule=CaseRule.NOT_TESTED, message=message)
        definition = None if specification is None else specification.definitions.get(x.name)
        if specification is not None and definition is not None:
            case = replace(case, place=definition_location(specification, definition))
        yield case


def test_location(file: str, name: str) -> Location:
    """Return where a test is written: its id in a TOML file, else the beginning of its file."""
    path = Path(file)
    if path.suffix == ".toml" and path.is_file():
        pattern = re.compile(rf"\s*id\s*=\s*[\"']{re.escape(name)}[\"']")
        for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
            if pattern.match(line):
                return Location(file, number, len(line) - len(line.lstrip()) + 1)
    return Location(file)
