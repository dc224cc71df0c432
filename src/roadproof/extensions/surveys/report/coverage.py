"""A table of the classes of gaps of a set, a summary, and a picture for each gap."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from roadproof.extensions.surveys.coverage import schema
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, Gap, GapSurvey, GapTraffic, Need
from roadproof.extensions.traffic.scenario_parts import danger_comes
from roadproof.frontends.report.numbers import count, took
from roadproof.frontends.report.picture import Picture, draw_drive, draws_drives
from roadproof.frontends.report.sheet import Column, Sheet, as_outline
from roadproof.library.scenarios import PAIR, Scenario, apply_scenario
from roadproof.library.specification import Library
from roadproof.library.words import ScenarioWords, Words, words_of
from roadproof.runtime.files import write_atomic
from roadproof.verdict import Verdict


def as_text(surveyed: GapSurvey, index: schema.CoverageData, name: str, words: ScenarioWords) -> str:
    """Return the answers about the set ``name`` as text."""
    lines: list[str] = []
    if index.classes:
        sheet = sheet_of(index, {number: x.name for number, x in words.items()})
        lines += [*as_outline(sheet), f"set {name}: " + "\n".join(summary(surveyed.classes))]
        lines += [count(len(index.gaps), "gap") + took(index.seconds or None)]
    else:
        lines += [f"proved: {x.claim.text}" for x in surveyed.claims]
    lines += [f"{need.definition}: {_needed(need)}" for need in surveyed.needs]
    lines += [] if surveyed.traffic is None else _in_traffic(surveyed.traffic)
    if surveyed.verdict is Verdict.COVERED:
        lines.append(f"set {name} misses no danger that arises from safety between two vehicles")
    if surveyed.verdict is Verdict.CROSSCHECK_FAILED:
        lines.append("traffic contradicts a proof, which is a fault of roadproof: please report it")
    return "\n".join(lines)


def _needed(need: Need) -> str:
    if need.drive is not None:
        return f"needed, by a drive on {need.drive.file.road.name}"
    return "not needed, by proof" if need.verdict is Verdict.PROVED else "neither shown needed nor spare"


def _in_traffic(traffic: GapTraffic) -> list[str]:
    lines = [f"of {traffic.disturbances} disturbances in traffic {len(traffic.missed)} are missed"]
    if traffic.repeats:
        lines.append(f"{traffic.repeats} more are shown again by windows that overlap, and count once")
    return [*lines, *traffic.left_out]


def _place(entry: schema.CountedClass, names: Mapping[int, str]) -> str:
    """Return the heading of the classes of a scenario, or of the class without a condition to blame."""
    if entry.scenario is None:
        return "no single condition is to blame: in every scenario two or more are false"
    return "" if entry.condition else str(Words(entry.scenario, names.get(entry.scenario, "")))


def _component(entry: schema.CountedClass) -> str:
    """Return the heading of the classes of a component."""
    return "" if entry.condition or entry.scenario is None else f"{entry.component}: {entry.description}"


def _evidence(entry: schema.CountedClass, gaps: Mapping[int, schema.NumberedGap]) -> str:
    parts = [f"drive {number} ({_catching(gaps[number])})" for number in entry.gaps]
    parts += [entry.reason] if entry.reason else []
    parts += [f"{entry.in_traffic} in traffic"] if entry.in_traffic else []
    none = " or ".join(entry.none_for)
    parts += [f"no drive found that {none} is first to catch"] if none else []
    return "; ".join(parts)


def _catching(gap: schema.NumberedGap) -> str:
    choices = " or ".join(" with ".join(names) for names in gap.caught_by)
    return f"{gap.first}: {choices}" if gap.first else "caught by no set"


def summary(classes: Sequence[ClassAnswer]) -> Iterator[str]:
    """Yield lines that count classes by answer, and by the wider set that catches their drives."""
    counts = {verdict: sum(x.verdict is verdict for x in classes) for verdict in Verdict}
    yield (
        f"of {len(classes)} classes {counts[Verdict.WITNESSED]} have a judged drive, "
        f"{counts[Verdict.IMPOSSIBLE]} are proved empty, {counts[Verdict.UNKNOWN]} are undecided"
    )
    for name in dict.fromkeys(gap.first for answer in classes for gap in answer.gaps):
        has = sum(any(gap.first == name for gap in answer.gaps) for answer in classes)
        who = f"{name} is the first set to catch" if name else "no set catches"
        yield f"  {who} a drive of {has} classes"


def sheet_of(index: schema.CoverageData, names: Mapping[int, str]) -> Sheet[schema.CountedClass]:
    """Return a sheet with an entry for each class of gaps; ``names``: those of scenarios."""
    gaps = {gap.number: gap for gap in index.gaps}
    return Sheet(
        (
            Column("scenario", lambda x: _place(x, names), "outline", look="heading"),
            Column("component", _component, "outline", look="heading"),
            Column(
                "class",
                lambda x: x.condition or ("" if x.scenario is None else "the component"),
                "outline",
                width=70,
            ),
            Column("verdict", lambda x: x.verdict, "outline", width=10),
            Column("evidence", lambda x: _evidence(x, gaps), "outline"),
            Column("scenario", lambda x: x.scenario),
            Column("name", lambda x: names.get(x.scenario or 0, ""), "frame"),
            Column("component", lambda x: x.component, "frame"),
            Column("condition", lambda x: x.condition, "frame"),
            Column("what", lambda x: x.description, "page"),
            Column("verdict", lambda x: x.verdict, "frame"),
            Column("drives", lambda x: len(x.gaps), "frame"),
            Column("first_caught_by", lambda x: ", ".join({gaps[k].first: 0 for k in x.gaps}), "frame"),
            Column("reason", lambda x: x.reason, heading="note"),
        ),
        index.classes,
    )


def sheet_of_claims(index: schema.CoverageData) -> Sheet[schema.CoverageClaimData]:
    """Return a sheet with an entry for each claim of coverage."""
    return Sheet(
        (
            Column("claim", lambda x: x.claim),
            Column("verdict", lambda x: x.verdict),
            Column("reason", lambda x: x.reason),
        ),
        index.claims,
    )


def draw_gap(answer: ClassAnswer, gap: Gap, library: Library) -> Picture:
    """Draw a gap, with the times at which each part of the missed scenario is true."""
    file, part = gap.drive.file, answer.part
    specification = library.select(file.set_name, file.options)
    if part is None:
        query, title = danger_comes(specification, *PAIR), "no single condition is to blame"
    else:
        query = apply_scenario(specification, Scenario(part.scenario, file.set_name))
        title = f"{words_of(specification, part.scenario)}\nbut for {part.component} ({part.description})"
        title += f": {part.condition}" if part.condition else ""
    title = f"Danger that {file.set_name} misses; {title}"
    return draw_drive(replace(file, formula=query.text), library, title)


def draw_beside(library: Library, job: tuple[ClassAnswer, Gap, Path]) -> None:
    """Write the picture of a gap beside its file, unless it is there, or no extension draws drives."""
    answer, gap, path = job
    picture = path.with_suffix(".svg")
    if picture.exists() and picture.stat().st_mtime_ns >= path.stat().st_mtime_ns:
        return
    if draws_drives():
        write_atomic(picture, draw_gap(answer, gap, library).svg)
