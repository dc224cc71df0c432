"""Writes requirements.toml: 40 requirements, linked to 24 scenarios, 60 tests and 11 claims."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

import roadproof as rp

ZONES = {"SYS-2": "main road", "SYS-3": "merge zone", "SYS-4": "departure zone"}
CLAIMS = {
    "P2 base": "Danger is symmetric: it does not matter which vehicle is named first.",
    "P4 scenario 3 base": "On the main road, acceleration behind is deceleration ahead with roles exchanged.",
    "P4 scenario 11 base": "In the merge zone, the same holds.",
    "P4 scenario 19 base": "In the departure zone, the same holds.",
    "P6 scenario 1 base": "Cut-in and deceleration ahead exclude each other on the main road.",
    "P6 scenario 9 base": "Cut-in and deceleration ahead exclude each other in the merge zone.",
    "P7-ahead base": "Ahead, the robust predicates agree in sign with the Boolean ones.",
    "P7-left base": "To the left, the robust predicates agree in sign with the Boolean ones.",
    "P8-rear base": "The RSS distance grows with the speed of the rear vehicle.",
    "P8-front base": "The RSS distance falls with the speed of the front vehicle.",
    "P9 base": "A gap above the RSS distance is never used up.",
}
SETTINGS = '[trace]\nevidence = ["evidence/proofs", "evidence/tests"]\n'


def table(name: str, text: str, parents: Sequence[str] = (), **links: Sequence[object]) -> str:
    fields = {"id": name, "text": text, "derived_from": parents, **links}
    lines = [f"{key} = {json.dumps(value)}" for key, value in fields.items() if value]
    return "\n".join(["[[requirement]]", *lines, ""])


def tables() -> Iterator[str]:
    yield SETTINGS
    yield table(
        "SYS-1", "The tests cover the traffic disturbances of ISO 34502, and the definitions are sound."
    )
    for name, zone in ZONES.items():
        yield table(name, f"The tests cover the disturbances of the {zone}.", ["SYS-1"])
    yield table("SYS-5", "The definitions mean what the standard says.", ["SYS-1"])
    home = rp.load()
    for number in range(1, 25):
        sets = ("base", "ext", "extA") if number <= 12 else ("base", "ext")
        tests = [f"scenario-{number:02}-{name}" for name in sets]
        text = f"A test shows scenario {number}: {home.words(number).name}."
        zone = [*ZONES][(number - 1) // 8]
        yield table(f"DIST-{number:02}", text, [zone], scenarios=[number], tests=tests)
    for number, (claim, text) in enumerate(CLAIMS.items(), 1):
        yield table(f"DEF-{number:02}", text, ["SYS-5"], claims=[claim])


if __name__ == "__main__":
    Path(__file__).with_name("requirements.toml").write_text("\n".join(tables()), "utf-8")
