"""Cases for tests: a small one as text, and random ones."""

import random
from pathlib import Path

from roadproof.extensions.assurance.case.case import AssuranceCase, CaseElement, ElementKind

GOOD = """\
title = "Trial"

[G1]
goal = "The catalogue covers the disturbances"
supported-by = ["S1"]
in-context-of = "C1"
[C1]

context = "Traffic disturbances of ISO 34502"
[S1]
strategy = "Argument by coverage and by prevention"
supported-by = ["G2", "G3"]

[G2]
goal = "The scenarios miss no danger"
supported-by = "Sn1"

[Sn1]
solution = "Coverage of set complete"
evidence = "coverage"
expect = "COVERED"

[G3]
goal = "Is developed later"
undeveloped = true
"""
WORDS = (
    "a careful driver",
    "prevents",
    "collisions",
    "WITNESSED",
    "iii",
    "longitudinal-lateral_disturbance" * 2,
)


def random_case(seed: int, most: int = 40, shared: bool = True) -> AssuranceCase:
    """A well-formed case; with ``shared`` some elements support several others."""
    chance = random.Random(seed)
    elements: dict[str, CaseElement] = {}
    waiting, count = [("G0", ElementKind.GOAL)], 0

    def text() -> str:
        return " ".join(chance.choices(WORDS, k=chance.randrange(1, 14)))

    while waiting:
        name, kind = waiting.pop(chance.randrange(len(waiting)))
        below: list[tuple[str, ElementKind]] = []
        is_arguing = kind in (ElementKind.GOAL, ElementKind.STRATEGY)
        while is_arguing and count < most and chance.random() < 0.72:
            count += 1
            kinds = (
                [ElementKind.GOAL, ElementKind.STRATEGY, ElementKind.SOLUTION]
                if kind is ElementKind.GOAL
                else [ElementKind.GOAL]
            )
            new = chance.choice(kinds)
            below.append((f"{new[:2].title()}{count}", new))
        waiting += below
        sides = [f"C{name}.{k}" for k in range(chance.choice((0, 0, 1, 2)) if is_arguing else 0)]
        for side in sides:
            elements[side] = CaseElement(side, chance.choice([*ElementKind][3:]), text(), line=1)
        under = tuple(x for x, _ in below)
        elements[name] = CaseElement(
            name, kind, text(), under, tuple(sides), is_arguing and not below, line=1
        )
    for name in [*elements] if shared else []:
        element, others = elements[name], [x for x in elements.values() if x.kind is ElementKind.SOLUTION]
        if element.kind is ElementKind.GOAL and element.supported_by and others and chance.random() < 0.3:
            more = chance.choice(others).id
            under = tuple(dict.fromkeys((*element.supported_by, more)))
            elements[name] = CaseElement(
                name, ElementKind.GOAL, element.text, under, element.in_context_of, line=1
            )
    return AssuranceCase(Path("random.toml"), "random", elements, "G0")
