"""Files with a ParameterValueDistribution: logical scenarios, whose sets of values give concrete ones.

``NAME.xosc`` with a distribution gives ``NAME#1.xosc``, ``NAME#2.xosc`` and so on, which are no files but are
read like them. A deterministic distribution gives all combinations, in the order of the file and the last
parameter first; of more than MOST combinations a part is drawn. A stochastic one gives ``numberOfTestRuns``
samples. Both are the same for a file and its ``randomSeed`` each time (0 where it has none). Sets of values
that break the constraints of the scenario's parameters are left out.
"""

import math
import random
from collections.abc import Mapping
from decimal import Decimal, InvalidOperation
from functools import cached_property
from itertools import accumulate
from pathlib import Path
from statistics import NormalDist
from typing import TypeAlias

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.expressions import replace_parameters
from roadproof.extensions.exchange.storyboard.rules import texts_compare
from roadproof.extensions.maps.xml_reader import Element, number_in, read_xml
from roadproof.runtime.records import dataclass

MOST = 500
"""Scenarios of a distribution."""
_DISTRIBUTION = "ParameterValueDistribution"
_LARGEST = 10**6
"""Values of a range, and combinations times this."""
Values: TypeAlias = Mapping[str, str]


def numbered_scenario_path(path: Path, number: int) -> Path:
    """Return the path that names a concrete scenario of a distribution."""
    return path.with_name(f"{path.stem}#{number}{path.suffix}")


def split(path: Path) -> tuple[Path, int] | None:
    """The file of the distribution and the number of a concrete scenario; None for a path that is a file."""
    name, mark, number = path.stem.rpartition("#")
    if path.exists() or path.suffix != ".xosc" or not mark or not number.isdecimal() or len(number) > 9:
        return None
    return path.with_name(f"{name}{path.suffix}"), int(number)


def is_distribution(path: Path) -> bool:
    """Return whether a file of OpenSCENARIO has a distribution in place of a storyboard."""
    try:
        return path.suffix == ".xosc" and f"<{_DISTRIBUTION}".encode() in path.read_bytes()
    except OSError:
        return False


def scenarios_of(path: Path) -> tuple[Path, ...]:
    """The concrete scenarios of a file: it itself unless it has a distribution. Raises ``InputError``."""
    if not is_distribution(path):
        return (path,)
    return tuple(numbered_scenario_path(path, x) for x in read_distribution(path).numbers)


@dataclass(frozen=True)
class Distribution:
    """A file whose ``choices`` are combined, or that has ``samples``; ``scenario``: that with parameters."""

    path: Path
    scenario: Path
    choices: tuple[tuple[Values, ...], ...]
    samples: tuple[Values, ...]

    @property
    def total(self) -> int:
        """Return how many sets of values there are."""
        return len(self.samples) or math.prod(map(len, self.choices))

    def values(self, number: int) -> Values:
        """The set of values with a number from 1 on. Raises ``InputError``."""
        if not 1 <= number <= self.total:
            raise InputError(f"{self.path}: there is no scenario {number}; they are 1 to {self.total}")
        if self.samples:
            return self.samples[number - 1]
        values: dict[str, str] = {}
        left = number - 1
        for choice in reversed(self.choices):
            left, k = divmod(left, len(choice))
            values = {**choice[k], **values}
        return values

    @cached_property
    def numbers(self) -> tuple[int, ...]:
        """The numbers of the scenarios that are read. Raises ``InputError`` where there is none."""
        everything = range(1, self.total + 1)
        chosen = everything if len(everything) <= MOST else sorted(random.Random(0).sample(everything, MOST))
        root = read_xml(self.scenario, "OpenSCENARIO")
        numbers = tuple(x for x in chosen if self._is_allowed(root, self.values(x)))
        if not numbers:
            raise InputError(f"{self.path}: no set of values keeps the constraints of {self.scenario}")
        return numbers

    @property
    def note(self) -> str:
        """Return how many of the scenarios are read, and why not all of them."""
        summary = f"{len(self.numbers)} of {self.total} scenarios of {self.path.name} are read"
        if self.total > MOST:
            summary += f", of {MOST} that were drawn"
        return summary

    def _is_allowed(self, root: Element, values: Values) -> bool:
        """Return whether each value keeps all constraints of one of its parameter's groups."""
        known: dict[str, str] = {}
        for node in root.findall("ParameterDeclarations/ParameterDeclaration"):
            name = (node.get("name") or "").lstrip("$")
            known[name] = _value(self.scenario, node, values.get(name, node.get("value") or ""), known)
            if not _keeps_constraints(self.scenario, node, name, known):
                return False
        return True


def check_constraints(path: Path, node: Element, name: str, known: Values) -> None:
    """Raise ``InputError`` for a parameter whose value, one of those ``known``, breaks its constraints."""
    if _keeps_constraints(path, node, name, known):
        return
    groups = " or ".join(
        " and ".join(f"{x.get('rule')} {x.get('value')}" for x in group.findall("ValueConstraint"))
        for group in node.findall("ConstraintGroup")
    )
    problem = f"parameter {name}: value={known[name]} breaks its ConstraintGroup"
    raise InputError(f"{path}: {problem}: {groups} is needed; change the value or the constraint")


def _keeps_constraints(path: Path, node: Element, name: str, known: Values) -> bool:
    """Return whether a parameter keeps all constraints of one of its groups, or has none."""
    groups = node.findall("ConstraintGroup")
    return not groups or any(
        all(_keeps(path, known, name, x) for x in group.findall("ValueConstraint")) for group in groups
    )


def _value(path: Path, node: Element, text: str, known: Values) -> str:
    try:
        return replace_parameters(text, known)
    except ValueError as error:
        raise InputError(f"{path}: {node.tag} {node.get('name', '')}={text}: {error}") from None


def _keeps(path: Path, known: Values, name: str, constraint: Element) -> bool:
    limit = _value(path, constraint, constraint.get("value", ""), known)
    try:
        return texts_compare(constraint.get("rule", ""), known[name], limit)
    except ValueError as error:
        raise InputError(f"{path}: {constraint.tag}: {error}") from None


def read_distribution(path: Path) -> Distribution:
    """The distribution of a file. Raises ``InputError`` that names element and rule."""
    root = read_xml(path, "OpenSCENARIO")
    node = root.find(_DISTRIBUTION)
    if node is None:
        raise InputError(f"{path}: {_DISTRIBUTION} is needed")
    named = _child(path, node, "ScenarioFile").get("filepath")
    if not named:
        raise InputError(f"{path}: {_DISTRIBUTION}/ScenarioFile: filepath is needed")
    exact, drawn = node.find("Deterministic"), node.find("Stochastic")
    choices: tuple[tuple[Values, ...], ...] = ()
    samples: tuple[Values, ...] = ()
    if exact is not None:
        choices = tuple(_choices(path, x) for x in exact)
    elif drawn is not None:
        samples = _samples(path, drawn)
    else:
        raise InputError(f"{path}: {_DISTRIBUTION}: Deterministic or Stochastic is needed")
    return Distribution(path, path.parent / named, choices, samples)


def _child(path: Path, node: Element, tag: str) -> Element:
    child = node.find(tag)
    if child is None:
        raise InputError(f"{path}: {node.tag}: {tag} is needed")
    return child


def _number(path: Path, node: Element, name: str) -> float:
    return number_in(path, node.get(name), f"{node.tag}: {name}")


def _choices(path: Path, node: Element) -> tuple[Values, ...]:
    """The values of a parameter, or the sets of values of several, that a deterministic element lists."""
    if node.tag == "DeterministicMultiParameterDistribution":
        sets = _child(path, node, "ValueSetDistribution").findall("ParameterValueSet")
        choices = [
            {_name(path, x, "parameterRef"): x.get("value", "") for x in one.findall("ParameterAssignment")}
            for one in sets
        ]
    elif node.tag == "DeterministicSingleParameterDistribution":
        name = _name(path, node, "parameterName")
        choices = [{name: value} for value in _single(path, node)]
    else:
        raise InputError(f"{path}: {node.tag} is not supported")
    if not choices:
        raise InputError(f"{path}: {node.tag}: it has no values")
    return tuple(choices)


def _name(path: Path, node: Element, attribute: str) -> str:
    name = (node.get(attribute) or "").lstrip("$")
    if not name:
        raise InputError(f"{path}: {node.tag}: {attribute} is needed")
    return name


def _single(path: Path, node: Element) -> list[str]:
    (kind, *more) = node
    if more or kind.tag not in ("DistributionSet", "DistributionRange"):
        raise InputError(f"{path}: {node.tag}: one DistributionSet or DistributionRange is needed")
    if kind.tag == "DistributionSet":
        return [x.get("value", "") for x in kind.findall("Element")]
    limits = _child(path, kind, "Range")
    low, high = (_decimal(path, limits, x) for x in ("lowerLimit", "upperLimit"))
    step = _decimal(path, kind, "stepWidth")
    if step <= 0 or high < low or (high - low) / step > _LARGEST:
        raise InputError(f"{path}: DistributionRange: stepWidth={step} from {low} to {high} is no range")
    return [str(low + k * step) for k in range(int((high - low) / step) + 1)]


def _decimal(path: Path, node: Element, name: str) -> Decimal:
    try:
        value = Decimal(node.get(name) or "")
    except InvalidOperation:
        value = Decimal("nan")
    if not value.is_finite():
        raise InputError(f"{path}: {node.tag}: {name} is {node.get(name)!r}; a finite number is needed")
    return value


def _samples(path: Path, node: Element) -> tuple[Values, ...]:
    """Samples of all parameters, with the number and the seed that the file says."""
    runs = _number(path, node, "numberOfTestRuns")
    if not 1 <= runs <= MOST or runs != int(runs):
        raise InputError(f"{path}: Stochastic: numberOfTestRuns={runs:g}: from 1 to {MOST} are supported")
    seed = _number(path, node, "randomSeed") if node.get("randomSeed") else 0.0
    chance = random.Random(seed)
    parameters = node.findall("StochasticDistribution")
    samples = []
    for _ in range(int(runs)):
        values = {}
        for parameter in parameters:
            (kind, *_) = parameter
            values[_name(path, parameter, "parameterName")] = _sample(path, kind, chance.random())
        samples.append(values)
    return tuple(samples)


def _sample(path: Path, node: Element, share: float) -> str:
    """The value of a distribution below which there is a ``share`` of it."""
    match node.tag:
        case "UniformDistribution":
            low, high = _limits(path, _child(path, node, "Range"))
            return repr(low + share * (high - low))
        case "NormalDistribution":
            return repr(_normal(path, node, share))
        case "PoissonDistribution":
            return repr(_poisson(path, node, share))
        case "Histogram":
            bins = node.findall("Bin")
            k, inside = _weighed([_number(path, x, "weight") for x in bins], share, path)
            low, high = _limits(path, _child(path, bins[k], "Range"))
            return repr(low + inside * (high - low))
        case "ProbabilityDistributionSet":
            elements = node.findall("Element")
            k, _ = _weighed([_number(path, x, "weight") for x in elements], share, path)
            return elements[k].get("value", "")
    raise InputError(f"{path}: StochasticDistribution: {node.tag} is not supported")


def _limits(path: Path, node: Element) -> tuple[float, float]:
    low, high = (_number(path, node, x) for x in ("lowerLimit", "upperLimit"))
    if low > high:
        raise InputError(f"{path}: {node.tag}: lowerLimit={low:g} is above upperLimit={high:g}")
    return low, high


def _normal(path: Path, node: Element, share: float) -> float:
    """Return a quantile of a normal distribution, cut to its Range, where it has one."""
    mean, variance = (_number(path, node, x) for x in ("expectedValue", "variance"))
    if variance <= 0:
        raise InputError(f"{path}: NormalDistribution: variance={variance:g} must be above 0")
    normal = NormalDist(mean, math.sqrt(variance))
    limits = node.find("Range")
    if limits is None:
        return normal.inv_cdf(min(max(share, 1e-12), 1 - 1e-12))
    low, high = _limits(path, limits)
    below, above = normal.cdf(low), normal.cdf(high)
    probability = below + share * (above - below)
    return min(max(normal.inv_cdf(probability), low), high) if 0 < probability < 1 else low


def _poisson(path: Path, node: Element, share: float) -> int:
    """Return a quantile of a Poisson distribution, cut to its Range, where it has one."""
    mean = _number(path, node, "expectedValue")
    if not 0 < mean <= 1000:
        raise InputError(f"{path}: PoissonDistribution: expectedValue={mean:g} must be above 0, at most 1000")
    limits = node.find("Range")
    low, high = (0.0, math.inf) if limits is None else _limits(path, limits)
    last = int(min(high, mean + 20 * math.sqrt(mean) + 40))
    counts = range(max(math.ceil(low), 0), last + 1)
    if not counts:
        raise InputError(f"{path}: PoissonDistribution: no number from {low:g} to {high:g}")
    weights = [math.exp(k * math.log(mean) - mean - math.lgamma(k + 1)) for k in counts]
    return counts[_weighed(weights, share, path)[0]]


def _weighed(weights: list[float], share: float, path: Path) -> tuple[int, float]:
    """The number of the weight that a share of all falls into, and the share of that one below it."""
    sums = [*accumulate(weights)]
    if not weights or min(weights) < 0 or sums[-1] <= 0:
        raise InputError(f"{path}: weights={weights}: positive numbers are needed")
    target = share * sums[-1]
    k = next((k for k, x in enumerate(sums) if target < x), len(sums) - 1)
    return k, (target - sums[k] + weights[k]) / weights[k] if weights[k] else 0.0
