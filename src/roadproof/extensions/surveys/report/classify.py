"""Tables, a summary and a picture of classes of scenarios."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from roadproof.extensions.surveys.classify.data import ClassData
from roadproof.extensions.surveys.classify.drives import ClassExample
from roadproof.extensions.surveys.classify.question import ClassesView
from roadproof.extensions.surveys.classify.text import HEADINGS
from roadproof.extensions.surveys.classify.traffic_shares import Shares
from roadproof.frontends.report.figures import count_axis, hide_frame, legend_beside, make_figure
from roadproof.frontends.report.sheet import Bar, Column, Sheet, as_lines
from roadproof.library.words import ScenarioWords
from roadproof.verdict import Verdict

_DOT, _NO_DOT, _BAR, _DOUBT = "#1f5fbf", "#dddddd", "#3f7d4e", "#b5473c"
MOST_TOLD = 20


@dataclass
class _Row:
    """A row of a table: several classes together; ``sizes``: their numbers of vehicles."""

    name: str
    happens: tuple[int, ...]
    description: str
    witnessed: int = 0
    count: int = 0
    situations: int = 0
    sizes: set[int] = field(default_factory=set)

    @property
    def is_shown(self) -> bool:
        """Return whether there is a drive in each place."""
        return self.witnessed == self.count

    @property
    def drives(self) -> str:
        return f"{self.witnessed} of {self.count}"

    def title_in(self, words: ScenarioWords) -> str:
        """Return the disturbance in words; for one scenario its title before its description."""
        *most, last = map(str, self.happens)
        if most:
            return f"{', '.join(most)} and {last} together"
        title = words[self.happens[0]].title
        return ": ".join(dict.fromkeys(filter(None, (title, self.description))))


def as_table(examples: Sequence[ClassExample], shares: Shares | None, words: ScenarioWords) -> str:
    """Return a table with a line for each disturbance, and below a line for each place."""
    drives = Column[_Row]("drives", lambda x: x.drives)
    columns = (drives, *(() if shares is None else (_share_column(shares),)))
    column = Column[_Row]("what happens", lambda x: x.title_in(words))
    happenings = _happenings(examples, shares)
    lines = as_lines(Sheet((Column("class", lambda x: x.name), *columns, column), happenings))
    lines += [f"  {line}" for line in _not_alone(examples, words)]
    places = _merged(examples, shares, lambda x: (str(x.one.place), ()))
    if len(places) > 1:
        lines += ["", *as_lines(Sheet((Column("where", lambda x: x.name), *columns), places))]
    return "\n".join(lines)


def sheet_of(classes: Sequence[ClassData]) -> Sheet[ClassData]:
    """Return a sheet with an entry for each class; shares are of situations with as many vehicles."""
    totals: Counter[int] = Counter()
    for x in classes:
        totals[len(x.vehicles)] += x.situations or 0
    counted = totals.total() > 0

    def share(x: ClassData) -> Bar | str:
        total = totals[len(x.vehicles)]
        if x.situations is None or not total:
            return ""
        part = x.situations / total
        return Bar(f"{x.situations}, {100 * part:.1f} %", part)

    shares: tuple[Column[ClassData], ...] = (
        Column("traces", lambda x: x.traces, "" if counted else "frame"),
        Column("situations", lambda x: x.situations, "frame"),
        *((Column("share of situations with as many vehicles", share, "page"),) if counted else ()),
    )
    return Sheet(
        (
            Column("verdict", lambda x: x.verdict, look="verdict"),
            Column("class", lambda x: x.name, look="strong"),
            Column("scenarios", lambda x: ", ".join(map(str, x.scenarios)), "frame"),
            Column("where", lambda x: x.where, "frame"),
            Column("description", lambda x: x.description, heading="what happens"),
            *shares,
            Column("reason", lambda x: x.reason, "frame"),
        ),
        classes,
    )


def _not_alone(examples: Sequence[ClassExample], words: ScenarioWords) -> Iterator[str]:
    """Yield the titles of scenarios without a row of their own, which hold only together with others."""
    happens = [x.one.what.holds for x in examples]
    alone = {numbers[0] for numbers in happens if len(numbers) == 1}
    others = sorted({number for numbers in happens for number in numbers} - alone)
    yield from (f"{number}: {words[number].title}" for number in others if words[number].title)


def _happenings(examples: Sequence[ClassExample], shares: Shares | None) -> list[_Row]:
    """Return rows of classes with the same vehicles and disturbances."""
    return _merged(
        examples, shares, lambda x: ("_".join(["class", *map(str, x.one.what.holds)]), x.one.vehicles)
    )


def _merged(
    examples: Sequence[ClassExample],
    shares: Shares | None,
    key_of: Callable[[ClassExample], tuple[str, tuple[str, ...]]],
) -> list[_Row]:
    """Return a row for all classes with the same key, under the name in the key."""
    rows: dict[tuple[str, tuple[str, ...]], _Row] = {}
    for x in examples:
        key = key_of(x)
        row = rows.setdefault(key, _Row(key[0], x.one.what.holds, x.one.description))
        row.witnessed += x.verdict is Verdict.WITNESSED
        row.count += 1
        row.situations += 0 if shares is None else shares.situations[x.one.name]
        row.sizes.add(len(x.one.vehicles))
    return list(rows.values())


def _share_column(shares: Shares) -> Column[_Row]:
    """Return the column of situations: their number, and the share of those with as many vehicles."""

    def cell(row: _Row) -> str:
        whole = sum(shares.classified[size] for size in row.sizes)
        part = f"{100 * row.situations / whole:5.1f} %" if whole else "      -"
        return f"{row.situations:>5} {part}"

    return Column("situations", cell)


def summary(view: ClassesView, shares: Shares | None) -> Iterator[str]:
    """Yield lines on proofs, drives, undecided parts, and agreement with recordings."""
    count = len(view.examples)
    verdicts = Counter(x.verdict for x in view.examples)
    counts = ", ".join(f"{n} {v}" for v, n in verdicts.items())
    yield f"{count} class{'es' * (count != 1)}: {counts}" if counts else "no classes"
    yield from (f"  {Verdict.UNKNOWN}: {x.about}: {x.reason}" for x in view.doubts)
    yield from (f"  {x.verdict}: {x.claim.query.text}: {x.reason}" for x in view.decisions if not x.holds)
    for kind, heading in HEADINGS.items():
        those = Counter(x.verdict for x in view.decisions if x.claim.kind == kind)
        if those:
            yield f"{heading}: " + ", ".join(f"{n} {v}" for v, n in those.items())
    yield from (f"  {x.verdict}: {x.one.name}: {x.reason}" for x in view.examples if x.reason)
    if shares is not None:
        yield from _of_shares(shares)


def _of_shares(shares: Shares) -> Iterator[str]:
    uncovered = shares.all_traces - shares.covered
    part = f" ({100 * uncovered / shares.all_traces:.1f} %)" if shares.all_traces else ""
    yield f"on {shares.source}: {shares.all_traces} traces, {uncovered}{part} in none of these scenarios"
    if shares.repeated:
        of = f"{shares.repeated} of {shares.all_traces + shares.repeated}"
        yield f"{of} traces are shown by an earlier recording too, so they are left out"
    yield from shares.left_out
    number = sum(shares.classified.values())
    if shares.broken:
        message = f"{len(shares.broken)} of {number} situations are not in exactly their own class"
        yield f"{Verdict.CROSSCHECK_FAILED}: {message}"
        yield from (f"  {line}" for line in shares.broken[:MOST_TOLD])
    else:
        yield f"{number} situations with a scenario, each in exactly one class, which names its scenarios"


def draw_classes(
    examples: Sequence[ClassExample], shares: Shares | None, title: str, words: ScenarioWords
) -> Any:
    """Draw bars for the frequency of each class, above dots for the scenarios in it.

    Places are added up: a column is a choice of disturbances, and a row is a disturbance.
    """
    columns = _happenings(examples, shares)
    numbers = sorted({number for one in columns for number in one.happens})
    heights = [2.2, 0.24 * len(numbers) + 0.6] if shares else [0.24 * len(numbers) + 0.6]
    figure, axes = make_figure(heights, width=max(6.5, 4.4 + 0.42 * len(columns)))
    if shares:
        _bars(axes[0], columns, shares)
    below = axes[-1]
    for x, one in enumerate(columns):
        rows = [numbers.index(number) for number in one.happens]
        colour = _DOT if one.is_shown else _DOUBT
        below.scatter([x] * len(numbers), range(len(numbers)), s=28, color=_NO_DOT, zorder=1)
        below.plot([x, x], [min(rows), max(rows)], color=colour, lw=1.6, zorder=2)
        below.scatter([x] * len(rows), rows, s=34, color=colour, zorder=3)
    names = [one.name.removeprefix("class_").replace("_", "+") for one in columns]
    below.set_xticks(range(len(columns)), names, fontsize=7, rotation=45)
    names = [f"{number} {words[number].title}".strip() for number in numbers]
    below.set_yticks(range(len(numbers)), names, fontsize=7)
    for colour, label in ((_DOT, "holds in the class"), (_DOUBT, "the same, no drive found")):
        if colour == _DOT or not all(one.is_shown for one in columns):
            below.scatter([], [], s=34, color=colour, label=label)
    below.scatter([], [], s=28, color=_NO_DOT, label="does not hold")
    legend_beside(below)
    below.set_ylim(len(numbers) - 0.4, -0.6)
    below.set_xlim(-0.6, len(columns) - 0.4)
    below.tick_params(length=0)
    hide_frame(below)
    figure.suptitle(title, fontsize=9)
    return figure


def _bars(axes: Any, columns: Sequence[_Row], shares: Shares) -> None:
    counts = [one.situations for one in columns]
    axes.bar(range(len(columns)), counts, color=_BAR, width=0.7)
    for x, count in enumerate(counts):
        axes.text(x, count, str(count), fontsize=7, ha="center", va="bottom")
    axes.set_xlim(-0.6, len(columns) - 0.4)
    axes.set_ylim(0, 1.12 * max([1, *counts]))
    axes.set_xticks([])
    axes.set_ylabel("situations", fontsize=7)
    count_axis(axes.yaxis)
    axes.tick_params(labelsize=7)
    axes.set_title(f"on {shares.source}", fontsize=8)
    hide_frame(axes, ("top", "right"))
