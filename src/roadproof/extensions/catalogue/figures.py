"""Figures of a catalogue: the number of tested and of all targets, by spec set, kind and road sector."""

from collections.abc import Iterator, Mapping, Sequence

from roadproof.extensions.catalogue.catalogue_data import Figure, Kind, TargetData
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.catalogue.targets import GapTargets, sectors_of, target_titles
from roadproof.library.scenarios import number_in

SCENARIOS: Kind = "scenarios"
CLASSES: Kind = "classes"
GAPS: Kind = "classes of gaps"


def kind_of(target: str) -> Kind:
    """Return the kind of a target other than a class of gaps, by its name."""
    return CLASSES if number_in(target) is None else SCENARIOS


def figures(set_name: str, targets: Sequence[TargetData], gaps: GapTargets) -> tuple[Figure, ...]:
    """Return the figures of the first spec set, with classes of gaps where these are required."""
    counts = [*_counts(set_name, {x.name: (x.sector, bool(x.tested)) for x in targets})]
    if gaps.required:
        tested = sum(bool(x.tested) for x in gaps.targets)
        counts.append(Figure(set_name, GAPS, "", tested, len(gaps.targets)))
    return tuple(counts)


def figures_of_set(
    formulas: TargetFormulas, concrete: Sequence[ConcreteAnswer], facts: Sequence[CatalogueFact]
) -> tuple[Figure, ...]:
    """Return the figures of a further spec set: targets that concrete tests show or abstract ones imply."""
    name, sectors = formulas.specification.set_name, sectors_of(formulas)
    runs = {x.test for x in facts if x.relation == "runs"}
    shown = {x for answer in concrete for x in answer.names}
    shown |= {
        x.other.removesuffix(f"@{name}") for x in facts if x.relation == "implies" and x.test in runs
        and x.other.endswith(f"@{name}")
    }  # fmt: skip
    targets = {target: (sectors.get(target, ""), target in shown) for target in target_titles(formulas)}
    return tuple(_counts(name, targets))


def _counts(set_name: str, targets: Mapping[str, tuple[str, bool]]) -> Iterator[Figure]:
    """Yield a figure for each kind, in all and by sector; ``targets``: sector and whether it is tested."""
    for kind in (SCENARIOS, CLASSES):
        those = [x for name, x in targets.items() if kind_of(name) == kind]
        sectors = list(dict.fromkeys(sector for sector, _ in those if sector))
        for sector in ("", *sectors) if those else ():
            here = [tested for place, tested in those if sector in ("", place)]
            yield Figure(set_name, kind, sector, sum(here), len(here))
