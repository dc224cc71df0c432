"""How much of everything tests show, in figures: by spec set, by kind of thing, and by road sector."""

from collections.abc import Iterator, Sequence

from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.fact import Fact
from roadproof.analysis.catalogue.showing import ConcreteAnswer
from roadproof.analysis.catalogue.tested import TestedGaps, sectors_of, targets_of
from roadproof.evidence.answers.catalogue_index import Figure, Kind, Target
from roadproof.library.scenarios import number_in

SCENARIOS: Kind = "scenarios"
CLASSES: Kind = "classes"
GAPS: Kind = "classes of gaps"


def kind_of(target: str) -> Kind:
    """What a target other than a class of gaps is, by its name."""
    return CLASSES if number_in(target) is None else SCENARIOS


def figures(set_name: str, targets: Sequence[Target], gaps: TestedGaps) -> tuple[Figure, ...]:
    """The figures of the set that is asked about; classes of gaps where it is known which are empty."""
    found = [*_counted(set_name, {x.name: (x.sector, bool(x.tested)) for x in targets})]
    if gaps.asked:
        tested = sum(bool(x.tested) for x in gaps.targets)
        found.append(Figure(set_name, GAPS, "", tested, len(gaps.targets)))
    return tuple(found)


def figures_beside(
    asked: Questions, concrete: Sequence[ConcreteAnswer], facts: Sequence[Fact]
) -> tuple[Figure, ...]:
    """The figures of another set: what concrete tests show there, and what abstract ones imply there."""
    name, sectors = asked.specification.set_name, sectors_of(asked)
    runs = {x.test for x in facts if x.relation == "runs"}
    shown = {x for answer in concrete for x in answer.names}
    shown |= {
        x.other.removesuffix(f"@{name}") for x in facts if x.relation == "implies" and x.test in runs
        and x.other.endswith(f"@{name}")
    }  # fmt: skip
    targets = {target: (sectors.get(target, ""), target in shown) for target in targets_of(asked)}
    return tuple(_counted(name, targets))


def _counted(set_name: str, targets: dict[str, tuple[str, bool]]) -> Iterator[Figure]:
    for kind in (SCENARIOS, CLASSES):
        those = [x for name, x in targets.items() if kind_of(name) == kind]
        sectors = list(dict.fromkeys(sector for sector, _ in those if sector))
        for sector in ("", *sectors) if those else ():
            here = [tested for place, tested in those if sector in ("", place)]
            yield Figure(set_name, kind, sector, sum(here), len(here))
