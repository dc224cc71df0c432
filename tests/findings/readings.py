"""Figures that an output says with more than one of its lines, or in the files beside it."""

import csv
import json
import re
from collections import Counter
from itertools import combinations
from typing import Any

from findings.figures import WORDS, Outcome
from roadproof.extensions.assurance.folder_view import folder_data

US101 = "out/us101"


def read(outcome: Outcome, name: str) -> Any:
    """A JSON file that the command wrote."""
    return json.loads((outcome.folder / name).read_text("utf-8"))


def view(outcome: Outcome, folder: str) -> Any:
    """What the answers in a folder show together."""
    return folder_data(outcome.folder / folder)


def pairs_with(outcome: Outcome, verdict: str) -> set[tuple[int, int]]:
    """The pairs of scenarios of which the matrix of ``roadproof overlap`` says WITNESSED or IMPOSSIBLE."""
    sign = {"WITNESSED": "#", "IMPOSSIBLE": "."}[verdict]
    header, *rows = (line for line in outcome.printed.splitlines() if re.match(r"[ \d]{4} ", line))
    columns = [int(header[at : at + 3]) for at in range(4, len(header), 3)]
    found: set[tuple[int, int]] = set()
    for row in rows:
        if re.fullmatch(r" *\d+( {2}[#.]| {3})+", row):
            signs = (row[at : at + 3].strip() for at in range(4, len(row), 3))
            found |= {(int(row[:4]), b) for b, x in zip(columns, signs, strict=False) if x == sign}
    return {(a, b) for a, b in found if a < b}


def pairs_of_a_sector(outcome: Outcome) -> tuple[str, int]:
    """Of two-vehicle scenarios of one sector: the pairs that hold together, the number of the others.

    Empty where the road sectors differ.
    """
    numbers = (1, 3, 4, 5, 6, 7, 8)
    every = pairs_with(outcome, "WITNESSED")
    of_sector = [
        [(a, b) for a, b in combinations(numbers, 2) if (a + shift, b + shift) in every]
        for shift in (0, 8, 16)
    ]
    if of_sector[0] != of_sector[1] or of_sector[0] != of_sector[2]:
        return ("not alike in the road sectors", 0)
    return _as_list(of_sector[0]), 21 - len(of_sector[0])


def disturbances_apart(outcome: Outcome) -> tuple[int, str]:
    """Kinds of disturbances that exclude each other in all sectors: how many, and which."""
    apart, together = pairs_with(outcome, "IMPOSSIBLE"), pairs_with(outcome, "WITNESSED")
    kinds = sorted({_kinds(pair) for pair in apart} - {_kinds(pair) for pair in together})
    return len(kinds), _as_list(kinds)


def _kinds(pair: tuple[int, int]) -> tuple[int, int]:
    first, second = sorted((number - 1) % 8 + 1 for number in pair)
    return first, second


def _as_list(pairs: list[tuple[int, int]]) -> str:
    return ", ".join(f"{a}-{b}" for a, b in pairs)


def partners_of_2(outcome: Outcome) -> str:
    """The scenarios that hold together with scenario 2."""
    return ", ".join(str(b) for a, b in sorted(pairs_with(outcome, "WITNESSED")) if a == 2)


def all_witnessed(outcome: Outcome) -> str:
    """How many classes there are, if each has a drive."""
    found = re.search(r"^(\d+) classes: (.*)$", outcome.printed, re.M)
    assert found is not None, outcome.printed
    return found[1] if found[2] == f"{found[1]} WITNESSED" else found[0]


def classes_of_set(outcome: Outcome) -> tuple[str, ...]:
    """Classes, if each has a drive; situations with a scenario, if each is in one class; traces without."""
    return all_witnessed(outcome), *_figures(
        outcome, r"(\d+) situations with a scenario, each in exactly one", r"traces, (\d+) \("
    )


def gaps_of_set(outcome: Outcome) -> tuple[str, ...]:
    """Classes of gaps, those with a drive, those proved empty, if none is in doubt; missed disturbances."""
    return _figures(
        outcome,
        r"of (\d+) classes (\d+) have a judged drive, (\d+) are proved empty, 0 are undecided",
        r"disturbances in traffic (\d+) are missed",
    )


def _figures(outcome: Outcome, *patterns: str) -> tuple[str, ...]:
    """The groups of patterns that each have one match in the printed text."""
    found: list[str] = []
    for pattern in patterns:
        matches = list(re.finditer(pattern, outcome.printed))
        assert len(matches) == 1, (pattern, outcome.printed)
        found += matches[0].groups()
    return tuple(found)


def happenings(outcome: Outcome) -> tuple[int, str, str]:
    """What happens between two vehicles: how many, scenarios alone, scenarios together."""
    names = [name.split("_")[1:] for name in re.findall(r"^(class_\S+)", outcome.printed, re.M)]
    two = [tuple(map(int, name)) for name in names if name != ["2"]]
    alone = sorted(x[0] for x in two if len(x) == 1)
    together = [
        f"{x[0]} with {', '.join(map(str, x[1:]))}" for x in sorted(two, key=lambda x: (len(x), x)) if x[1:]
    ]
    return len(two), ", ".join(map(str, alone)), ", ".join(together)


def kinds_of_places(outcome: Outcome) -> int:
    """In how many choices of road sectors each class is there; 0 where that is not the same for all."""
    counts = Counter(tuple(x["happens"]) for x in view(outcome, "classes")["classes"])
    return counts.popitem()[1] if len(set(counts.values())) == 1 else 0


def accepted(outcome: Outcome) -> str:
    """How many files ``roadproof check`` accepts, if that is all of them."""
    found = re.search(r"(\d+) of (\d+) accepted", outcome.printed)
    assert found is not None, outcome.printed
    return found[1] if found[1] == found[2] else found[0]


def boundaries(outcome: Outcome) -> dict[int, str]:
    """By scenario the greatest value with a drive."""
    found = re.findall(r"^scenario (\d+)\b.*?greatest \S+ with a drive: (\S+) ", outcome.printed, re.M | re.S)
    return {int(number): value for number, value in found}


def measures(outcome: Outcome) -> dict[tuple[int, str], str]:
    """By scenario and sense (least, greatest) the extreme that was found."""
    result: dict[tuple[int, str], str] = {}
    for part in re.split(r"^scenario ", outcome.printed, flags=re.M)[1:]:
        number = int(part.partition(":")[0])
        for sense, value in re.findall(r"^  (least|greatest) .*?: (\S+) \S+ on a judged drive", part, re.M):
            result[number, sense] = value
    return result


def drives_that_serve(outcome: Outcome) -> tuple[int, int, str]:
    """Scenarios, values at which all of them have a drive (0 if one has not), how many drives serve those."""
    every = re.findall(r"at (\d+) of (\d+) values", outcome.printed)
    served = sorted({int(x) for x in re.findall(r"searches, (\d+) drives?", outcome.printed)})
    values = {int(b) for a, b in every if a == b}
    complete = len(values) == 1 and all(a == b for a, b in every)
    return len(every), values.pop() if complete else 0, " or ".join(WORDS[x] for x in served)


def uncertain_matches(outcome: Outcome) -> tuple[int, int]:
    """Rows of matches.csv that depend on less than places may be off by, and all."""
    with (outcome.folder / US101 / "matches.csv").open(encoding="utf-8", newline="") as file:
        marks = [row["uncertain"] for row in csv.DictReader(file)]
    return marks.count("1"), len(marks)


def uncertain_misses(outcome: Outcome) -> tuple[int, int]:
    """Traces with minDanger 0 that match nothing of ext, and how many of them may."""
    with (outcome.folder / US101 / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if (row["min_danger"], row["ext"]) == ("0", "0")]
    return len(rows), sum(row["ext_uncertain"] == "1" for row in rows)


def sectors_of_matches(outcome: Outcome) -> tuple[str, ...]:
    """Numbers of scenarios of merge and departure zones that match, and windows in which one does."""
    with (outcome.folder / US101 / "matches.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if int(row["scenario"]) > 8]
    numbers = sorted({int(row["scenario"]) for row in rows})
    return ", ".join(map(str, numbers)), str(len({row["recording"] for row in rows}))


def us101_counts(outcome: Outcome) -> dict[str, Any]:
    """What ``results.json`` says of US-101."""
    data = read(outcome, f"{US101}/results.json")
    assert isinstance(data, dict)
    return data


def disturbances(outcome: Outcome) -> tuple[int, int]:
    """Pairs with minDanger 0 and with 0.6, each once, whichever sectors it begins in."""
    with (outcome.folder / US101 / "pairs.csv").open(encoding="utf-8", newline="") as file:
        found = Counter(row["min_danger"] for row in csv.DictReader(file))
    return found["0"], found["0.6"]


def rows_of_sectors(outcome: Outcome) -> tuple[int, int]:
    """The traces of the tables of all sectors together, with minDanger 0 and with 0.6."""
    rows = [row for row in us101_counts(outcome)["table"] if row["set"] == "base"]
    every, lasting = (sum(x["traces"] for x in rows if x["min_danger"] == d) for d in ("0", "3/5"))
    return every, lasting


def windows_with_ramps(outcome: Outcome) -> int:
    """Windows in which a merge or departure lane was inferred."""
    windows = re.split(r"^(?=\S)", outcome.printed, flags=re.M)
    return sum(re.search(r"^  (merge|departure) lane", window, re.M) is not None for window in windows)


def vanishing(outcome: Outcome) -> tuple[int, int]:
    """Disturbances with minDanger 0 that are none with 0.6, and all of them."""
    every, lasting = disturbances(outcome)
    return every - lasting, every


def contradictions(outcome: Outcome) -> int:
    """Moving seconds in which accelerations contradict velocities."""
    found = notes_of(outcome, r"accelerations along the road and velocities contradict .*\((\d+) of")
    return sum(int(x[0]) for x in found)


def overlap_of_two_vehicles(outcome: Outcome) -> tuple[str, str]:
    """In how many frames vehicles 504 and 513 overlap, and by how many metres."""
    [(frames, metres)] = notes_of(outcome, r"vehicles 504 and 513 overlap in (\d+) frames, .* (\S+) m$")
    return frames, metres


def notes_of(outcome: Outcome, pattern: str) -> list[tuple[str, ...]]:
    """What a pattern finds in the notes on all recordings, one tuple a note."""
    notes = [note for those in us101_counts(outcome)["notes"].values() for note in those]
    return [m.groups() for note in notes if (m := re.search(pattern, note)) is not None]


def errors_of_lengths(outcome: Outcome) -> tuple[str, ...]:
    """Errors of s in per cent: least and greatest on average; greatest on a way, in a bend, and where."""
    pattern = (
        r"off by (\S+) % on average, by (\S+) % on the way of obstacle (\d+), by up to (\S+) % in a bend"
    )
    notes = us101_counts(outcome)["notes"].items()
    found = [(*m.groups(), name) for name, said in notes for x in said if (m := re.search(pattern, x))]
    means = sorted((x[0] for x in found), key=float)
    way, bend = (max(found, key=lambda x: float(x[k])) for k in (1, 3))
    return means[0], means[-1], way[1], way[2], way[4], bend[3], bend[4]


def pairs_drives_proofs(outcome: Outcome) -> tuple[int, int, int]:
    """Pairs of scenarios: all, with a drive, with a proof."""
    together, apart = pairs_with(outcome, "WITNESSED"), pairs_with(outcome, "IMPOSSIBLE")
    return len(together | apart), len(together), len(apart)


def doubts_and_traces(outcome: Outcome) -> tuple[str, ...]:
    """Of changes to a set: those in doubt, all, those that only a trace tells apart."""
    found = re.search(r"^(\d+) changes: .* (\d+) by a trace, (\d+) in doubt", outcome.printed, re.M)
    assert found is not None, outcome.printed
    return found[3], found[1], found[2]


def picture_of_a_gap_beside_the_lane(outcome: Outcome) -> str:
    """The file with the first gap that scenario 1 misses because of the danger in ``cutIn``."""
    index = view(outcome, "gaps")
    [entry] = [
        x
        for x in index["classes"]
        if x["component"] == "behaviourPOV_1" and x["condition"] == "danger(SV, POV) in cutIn"
    ]
    drive: str = index["gaps"][entry["gaps"][0] - 1]["drive"]
    return f"gaps/{drive.removesuffix('.json')}.svg"


def edges_of_a_sector(outcome: Outcome) -> str:
    """How many implications are proved between scenarios of each road sector, if that is the same for all."""
    edges = re.findall(r"^(\d+)@\S+ -> (\d+)@\S+$", outcome.printed, re.M)
    counts = Counter((int(a) - 1) // 8 for a, _ in edges)
    return ", ".join(map(str, sorted(set(counts.values()))))


def one_formula(outcome: Outcome) -> tuple[str, str]:
    """Scenarios 1 to 8 that say the same in base and extA only, and those that do in ext as well."""
    kinds = [
        dict.fromkeys(int(number) for number in re.findall(r"(\d+)@", line))
        for line in re.findall(r"^one formula: (.*)$", outcome.printed, re.M)
        if "base" in line and "extA" in line
    ]
    in_all = re.findall(r"^one formula: (?=.*@ext(?:,|$)).*?(\d+)@", outcome.printed, re.M)
    three = sorted(int(number) for number in in_all if int(number) <= 8)
    two = sorted(n for kind in kinds for n in kind if n <= 8 and n not in three)
    return ", ".join(map(str, two)), ", ".join(map(str, three))


def range_of_both(outcome: Outcome) -> tuple[str, str]:
    """How much slower and faster, if that is the same for all scenarios."""
    found = measures(outcome)
    least = {value.removeprefix("-") for (_, sense), value in found.items() if sense == "least"}
    greatest = {value for (_, sense), value in found.items() if sense == "greatest"}
    return ", ".join(sorted(least)), ", ".join(sorted(greatest))


def us101_tables(outcome: Outcome) -> dict[str, tuple[str, ...]]:
    """The cells of the results tables of US-101, row by row, of each road sector."""
    endings = {"main road": "", "merge zone": "-merge-zone", "departure zone": "-departure-zone"}
    texts = {
        sector: (outcome.folder / US101 / f"results{ending}.md").read_text("utf-8")
        for sector, ending in endings.items()
    }
    rows = {sector: re.findall(r"\| here \| (.*)", text) for sector, text in texts.items()}
    return {sector: tuple(x.rstrip(" |").replace(" | ", ",") for x in rows[sector]) for sector in texts}


def roles_differ(outcome: Outcome) -> tuple[int, int]:
    """Pairs for which scenarios 3 and 4 differ in base, with minDanger 0 and with 0.6."""
    found = Counter(x[-1] for x in us101_counts(outcome)["checks"]["unequal_3_4"])
    return found["0"], found["3/5"]


def claims_of_classes(outcome: Outcome) -> int:
    return len(view(outcome, "classes")["claims"])


def claims_about_cells(outcome: Outcome) -> tuple[object, ...]:
    """Claims, cells of what happens and of where; claims about pairs and unions of classes; classes."""
    found = view(outcome, "classes")
    happens = {tuple(x["happens"]) for x in found["classes"]}
    classes, scenarios = len(found["classes"]), {y for x in found["classes"] for y in x["scenarios"]}
    pairs = classes * (classes - 1) // 2
    cells = len(happens), kinds_of_places(outcome)
    return claims_of_classes(outcome), *cells, f"{pairs + len(scenarios):,}", all_witnessed(outcome)


def classes_proofs_drives(outcome: Outcome) -> tuple[str, int, str]:
    return all_witnessed(outcome), claims_of_classes(outcome), all_witnessed(outcome)


def needed_definitions(outcome: Outcome) -> int:
    return outcome.printed.count(": needed, by a drive on ")


def counts_of_order(outcome: Outcome) -> tuple[int, ...]:
    """Formulas, proofs, refuted implications, doubts."""
    index = view(outcome, "order")
    return tuple(len(index[key]) for key in ("kinds", "proved", "missing", "doubts"))


def least_measures(outcome: Outcome) -> tuple[str, ...]:
    """The least measure of each scenario, in the order of their numbers."""
    return tuple(value for (_, sense), value in sorted(measures(outcome).items()) if sense == "least")
