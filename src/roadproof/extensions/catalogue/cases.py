"""The cases of a catalogue: tests, and what is to be tested."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from roadproof.frontends.report.cases import (
    Case,
    Rule,
    State,
    definition_location,
    test_location,
)
from roadproof.library.specification import Specification
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.extensions.catalogue.kept import Remark
    from roadproof.extensions.catalogue.tested import Targets


def catalogue_cases(
    tests: Sequence[str],
    found: Targets,
    sources: Mapping[str, str] | None = None,
    specification: Specification | None = None,
) -> Iterator[Case]:
    """A case for each test, which fails where it is not what it claims, and for each thing to be tested.

    Where places are wanted, ``sources`` has the file that names each test.
    """
    remarks: tuple[tuple[Verdict | Rule, State, Sequence[Remark]], ...] = (
        (Verdict.UNKNOWN, "undecided", found.doubts),
        (Rule.WRONG_TEST, "failed", found.faults),
        (Rule.CONTRADICTION, "failed", found.contradictions),
    )
    wrong = {x.tests[0]: (rule, state, x.told) for rule, state, those in remarks for x in those}
    for test in tests:
        file = (sources or {}).get(test)
        place = None if file is None else test_location(file, test)
        case = Case(suite="tests", name=test, state="passed", place=place)
        if test in wrong:
            rule, state, told = wrong[test]
            case = replace(case, state=state, rule=rule, message=told)
        yield case
    missing = {x.name for x in found.missing}
    for x in (*found.targets, *(found.gaps.targets if found.gaps.asked else ())):
        case = Case(suite="tested", name=x.name, state="passed")
        if x.name in found.gaps.open:
            told = f"in doubt: {found.gaps.open[x.name]}"
            case = replace(case, state="undecided", rule=Verdict.UNKNOWN, message=told)
        elif x.name in missing:
            told = f"no test shows {x.words}"
            case = replace(case, state="failed", rule=Rule.NOT_TESTED, message=told)
        definition = None if specification is None else specification.definitions.get(x.name)
        if specification is not None and definition is not None:
            case = replace(case, place=definition_location(specification, definition))
        yield case
