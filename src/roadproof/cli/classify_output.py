"""What ``roadproof classify`` hands over: plain data, files of evidence, and a few lines about them."""

import argparse
import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.cli.evidence import keep_specifications, write_index
from roadproof.cli.options import json_text, write_json, write_text
from roadproof.files import make_folder, write_whole

if TYPE_CHECKING:
    from roadproof.analysis.classify.classes import Class, Classes
    from roadproof.analysis.classify.drives import Example
    from roadproof.analysis.classify.shares import Shares
    from roadproof.analysis.classify.text import Claim
    from roadproof.analysis.requests import Asked
    from roadproof.prove.prover import Result
    from roadproof.spec.library import Specification

SCHEMA = "roadproof/classify/1"
CLAIMS_FILE = "claims.txt"
MOST_TOLD = 20
_HEADINGS = {
    "exclusive": "any two classes exclude each other",
    "covers": "each scenario is the union of its classes",
    "empty": "combinations of scenarios that do not occur",
}


@dataclass(frozen=True)
class Answers:
    """All that was found; ``source`` says in words what the shares were counted on."""

    asked: "Asked"
    specification: "Specification"
    classes: "Classes"
    text: str
    examples: "Mapping[str, Example]"
    proofs: "Sequence[tuple[Claim, Result]]"
    shares: "Shares | None"
    source: str


def as_data(answers: Answers, folder: Path | None, seconds: float) -> tuple[dict[str, Any], dict[str, str]]:
    """The answer as plain data, and files by their path in ``folder``; without one, evidence is inside."""
    from roadproof.analysis.classify.text import FILE_NAME
    from roadproof.evidence.certificate import to_json

    files: dict[str, str] = {}

    def put(name: str, content: str, inline: object) -> object:
        if folder is None:
            return inline
        files[name] = content
        return str(folder / name)

    def drive_of(one: "Class") -> object:
        drive = answers.examples[one.name].drive
        if drive is None:
            return None
        return put(f"drives/{one.name}.json", json_text(drive), drive)

    def certificate_of(claim: "Claim", result: "Result") -> object:
        if result.certificate is None:
            return None
        text = to_json(result.certificate)
        return put(f"proofs/{claim.name}.json", text, text)

    data = {
        "schema": SCHEMA,
        "set": answers.specification.set_name,
        "options": dict(answers.specification.options),
        "parameters": {name: str(value) for name, value in sorted(answers.asked.values.items())},
        "scenarios": sorted(number for group in answers.classes.plan.groups for number in group.rows),
        "specs": [*keep_specifications(folder, answers.asked.specs), FILE_NAME],
        "view": "dense",
        "text": answers.text,
        "classes": [{**entry, "drive": drive_of(one)} for one, entry in _classes(answers)],
        "claims": [
            {
                "name": claim.name,
                "kind": claim.kind,
                "claim": claim.text,
                "verdict": str(result.verdict),
                "reason": result.reason,
                "certificate": certificate_of(claim, result),
                "seconds": round(result.seconds, 3),
            }
            for claim, result in answers.proofs
        ],
        "shares": _shares(answers),
        "seconds": round(seconds, 1),
    }
    if folder is not None:
        files |= {FILE_NAME: answers.text, CLAIMS_FILE: _claims_text([claim for claim, _ in answers.proofs])}
    return data, files


def _classes(answers: Answers) -> "Iterator[tuple[Class, dict[str, Any]]]":
    from roadproof.analysis.classify.text import describe

    counts = answers.shares
    for one in answers.classes.all():
        example = answers.examples[one.name]
        yield (
            one,
            {
                "name": one.name,
                "vehicles": list(one.vehicles),
                "scenarios": list(one.scenarios),
                "happens": list(one.what.holds),
                "where": None if one.where is None else answers.classes.place(one.where),
                "description": "; ".join(describe(answers.specification, n) for n in one.what.holds),
                "formula": one.formula,
                "verdict": str(example.verdict),
                "reason": example.reason,
                "situations": None if counts is None else counts.situations[one.name],
                "traces": None if counts is None else counts.traces[one.name],
            },
        )


def _shares(answers: Answers) -> dict[str, Any] | None:
    shares = answers.shares
    if shares is None:
        return None
    return {
        "source": answers.source,
        "recordings": shares.recordings,
        "end": "clip",
        "traces": shares.all_traces,
        "covered": shares.covered,
        "situations": {str(count): number for count, number in sorted(shares.classified.items())},
        "broken": shares.broken,
    }


def _claims_text(claims: "Sequence[Claim]") -> str:
    """The claims as a file for ``prove --claims``: paragraphs under a comment for each kind."""
    from roadproof.analysis.classify.classes import SET_NAME
    from roadproof.analysis.classify.text import FILE_NAME

    lines = [f"# To be proved with --spec {FILE_NAME} --set {SET_NAME}.", ""]
    for kind, heading in _HEADINGS.items():
        those = [claim.text for claim in claims if claim.kind == kind]
        if those:
            lines += [f"# {heading}", "", *(line for text in those for line in (text, ""))]
    return "\n".join(lines)


def write(
    data: Mapping[str, Any], files: Mapping[str, str], folder: Path | None, args: argparse.Namespace
) -> None:
    """Evidence first, index last; what an earlier run left of itself in the folder is removed before."""
    if folder is not None:
        _remove_former(folder, files)
        for name, content in files.items():
            make_folder((folder / name).parent)
            write_text(folder / name, content)
        if not args.no_pictures and args.out is not None:
            from roadproof.report.classify import draw_classes

            title = f"Classes of scenarios of set {data['set']}"
            for kind, picture in draw_classes(data, title).items():
                write_whole(folder / f"classes.{kind}", picture)
        write_index(folder, data)
    if args.json:
        write_json(data, args.json)


def _remove_former(folder: Path, files: Mapping[str, str]) -> None:
    """Remove evidence of classes that are no more: it speaks of another classes.spec."""
    try:
        former = json.loads((folder / "index.json").read_text("utf-8"))
        ours = former["schema"] == SCHEMA
    except (OSError, ValueError, KeyError, TypeError):
        return
    if not ours:
        return
    (folder / "index.json").unlink()
    for kind in ("proofs", "drives"):
        for path in (folder / kind).glob("*.json"):
            if f"{kind}/{path.name}" not in files:
                path.unlink()


def summary(data: Mapping[str, Any]) -> Iterator[str]:
    """What is proved, what was found, and whether recordings agree."""
    yield ""
    verdicts = Counter(x["verdict"] for x in data["classes"])
    count = len(data["classes"])
    yield f"{count} class{'es' * (count != 1)}: " + ", ".join(f"{n} {v}" for v, n in verdicts.items())
    for x in data["claims"]:
        if x["verdict"] not in ("PROVED", "VACUOUS"):
            yield f"  {x['verdict']}: {x['claim']}: {x['reason']}"
    for kind, heading in _HEADINGS.items():
        those = [x["verdict"] for x in data["claims"] if x["kind"] == kind]
        told = ", ".join(f"{n} {v}" for v, n in Counter(those).items())
        if those:
            yield f"{heading}: {told}"
    yield from (f"  {x['verdict']}: {x['name']}: {x['reason']}" for x in data["classes"] if x["reason"])
    shares = data["shares"]
    if shares is None:
        return
    uncovered = shares["traces"] - shares["covered"]
    part = f" ({100 * uncovered / shares['traces']:.1f} %)" if shares["traces"] else ""
    yield f"on {shares['source']}: {shares['traces']} traces, {uncovered}{part} in none of these scenarios"
    number = sum(shares["situations"].values())
    broken = shares["broken"]
    if broken:
        yield f"CROSSCHECK-FAILED: {len(broken)} of {number} situations are not in exactly their own class"
        yield from (f"  {line}" for line in broken[:MOST_TOLD])
    else:
        yield f"{number} situations with a scenario, each in exactly one class, which names its scenarios"
