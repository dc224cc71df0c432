"""Random claims in the shapes that users write, each with the truth that its shape gives it.

    python benchmarks/random_claims.py [--count 400] [--seed 1]

A shape is a text with numbers drawn at random; for half of the claims they are drawn so that the claim is
true, for the other half so that it is false. A claim without a label is an implication between two scenarios,
of which no shape tells whether it is true.
"""

import argparse
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Claim:
    """``truth``: whether it holds, from how it was made; None where that is not known."""

    family: str
    text: str
    truth: bool | None


Shape = Callable[[random.Random, bool], str]

PAIR = "SV,POV,L"
TWO_VEHICLES = (1, 3, 4, 5, 6, 7, 8)


def scenarios(rng: random.Random, truth: bool) -> str:
    """Scenarios imply what their template says; no bound on speeds, times or gaps."""
    i, keeps = rng.choice(TWO_VEHICLES), rng.choice((1, 3, 4))
    speed, seconds, metres = rng.randint(0, 30), rng.randint(2, 9), rng.randint(20, 200)
    here, there = f"scenario_{i}({PAIR})", f"scenario_{keeps}({PAIR})"
    true = [
        f"{here} -> dangerArises(SV,POV)",
        f"{here} -> F danger(SV,POV)",
        f"{here} -> initSafe(SV,POV)",
        f"{here} -> instSafe(SV,POV)",
        f"{there} -> atLane(SV,L) or danger(SV,POV)",
        f"scenario_4({PAIR}) -> s(SV) < s(POV)",
        f"scenario_8({PAIR}) -> F not atLane(SV,L)",
        f"scenario_{rng.choice((3, 4))}({PAIR}) -> disturb_{keeps}@extA({PAIR}) or F danger(POV,SV)",
        f"{there} and v_lon(SV) > {speed + 3} m/s -> v_lon(SV) > {speed} m/s and F danger(SV,POV)",
        f"scenario_3({PAIR}) -> scenario_3@extA({PAIR})",
        f"scenario_4({PAIR}) -> scenario_4@extA({PAIR})",
    ]
    false = [
        f"{there} -> v_lon(SV) > {speed} m/s",
        f"{there} -> v_lon(POV) < {speed} m/s",
        f"{there} -> F[0, {seconds} s] danger(SV,POV)",
        f"dangerArises(SV,POV) -> {here}",
        f"scenario_4({PAIR}) -> s(POV) - s(SV) <= {metres} m",
        f"scenario_4({PAIR}) -> G atLane(SV,L)",
        f"scenario_4({PAIR}) -> G[0, {seconds} s] v_lon(SV) >= v_lon(POV)",
        f"scenario_3@extA({PAIR}) -> scenario_3({PAIR})",
        f"scenario_4@extA({PAIR}) -> scenario_4({PAIR})",
        f"scenario_5({PAIR}) -> F atLane(POV,L) and v_lon(SV) > {speed} m/s",
    ]
    return rng.choice(true if truth else false)


def pairs(rng: random.Random, truth: bool) -> str:
    """Whether one scenario implies another; the numbers alone do not tell."""
    i, j = rng.sample(TWO_VEHICLES, 2)
    return f"scenario_{i}({PAIR}) -> {rng.choice(('', '', 'not '))}scenario_{j}({PAIR})"


def speeds(rng: random.Random, truth: bool) -> str:
    """Bounds on speeds follow from bounds on speeds, in other units, later, and as squares."""
    low, step = rng.randint(1, 25), rng.randint(1, 9)
    high = low + step
    kept = rng.choice(("", "G ", f"G[0, {step} s] ", "F "))
    a, b = (high, low) if truth else (low, high)  # above a -> above b
    return rng.choice(
        [
            f"{kept}v_lon(SV) > {a} m/s -> {kept}v_lon(SV) > {b} m/s",
            f"{kept}v_lon(SV) >= {a} m/s -> {kept}v_lon(SV) >= {b * 18 / 5:g} km/h",
            f"v_lon(SV) >= {a} m/s -> v_lon(SV)^2 >= {b * b} * 1 m/s * 1 m/s",
            f"{kept}v_lon(SV) <= {b} m/s -> {kept}v_lon(SV) <= {a} m/s",
            f"v_lon(SV) <= {low} m/s and v_lon(POV) >= {step} m/s"
            f" -> v_lon(SV) - v_lon(POV) <= {low - step + (1 if truth else -1)} m/s",
            f"abs(v_lat(SV)) <= {b} m/s -> v_lat(SV) >= -{a} m/s",
            f"fasterThan(SV,POV) and v_lon(SV) > {a} m/s -> v_lon(POV) > {b} m/s",
            f"max(v_lon(SV), v_lon(POV)) <= {b} m/s -> v_lon(POV) <= {a} m/s",
        ]
    )


def gaps(rng: random.Random, truth: bool) -> str:
    """Bounds on gaps: from lengths, headways and the RSS distance."""
    gap, more, length = rng.randint(5, 60), rng.randint(1, 9), rng.randint(4, 12)
    least = gap - length + (-more if truth else more)
    between = "s(POV) - length(POV) - s(SV)"
    smaller, larger = (gap, gap + more) if truth else (gap + more, gap)
    return rng.choice(
        [
            f"s(POV) - s(SV) >= {gap} m and length(POV) <= {length} m -> {between} >= {least} m",
            f"G (s(POV) - s(SV) >= {gap} m and length(POV) <= {length} m) -> G {between} >= {least} m",
            f"{between} >= {2 if truth else -2} m -> aheadOf(SV,POV)",
            f"s(POV) - s(SV) >= 2 s * v_lon(SV) and v_lon(SV) >= {gap} m/s"
            f" -> s(POV) - s(SV) >= {2 * gap + (-more if truth else more)} m",
            f"given u, v, w: m/s: 0 <= u and u <= v -> dRSS_lon({'u,w' if truth else 'v,w'})"
            f" <= dRSS_lon({'v,w' if truth else 'u,w'})",
            f"F {between} <= {smaller} m -> F {between} <= {larger} m",
            f"d(POV) - d(SV) >= {gap} m and width(POV) <= {more} m -> d(POV) - width(POV) - d(SV)"
            f" >= {gap - more + (0 if truth else 1)} m",
            f"instSafe(SV,POV) -> {'not danger(SV,POV)' if truth else f'{between} >= {gap} m'}",
        ]
    )


def orderings(rng: random.Random, truth: bool) -> str:
    """Who is ahead of whom, in chains."""
    names = [f"POV{k}" for k in range(1, rng.randint(3, 5))]
    order = rng.choice(("aheadOf", "aheadOf_ext", "fasterThan"))
    chain = " and ".join(f"{order}({a},{b})" for a, b in zip(["SV", *names], names, strict=False))
    ends = f"SV,{names[-1]}" if truth else f"{names[-1]},SV"
    kept = rng.choice(("", "G ", "F "))
    strict = [
        f"{kept}({chain}) -> {kept}{order}({ends})",
        f"G ({chain}) -> {'not F ' if truth else 'F '}{order}({names[-1]},SV)",
        f"aheadOf(SV,POV1) -> {'' if truth else 'not '}s(SV) < s(POV1)",
        f"d(SV) < d(POV1) and d(POV1) < d(POV2) -> {'d(SV) < d(POV2)' if truth else 'd(POV2) <= d(SV)'}",
    ]
    if truth:
        strict.append(f"F aheadOf(SV,POV1) and G aheadOf(POV1,{names[-1]}) -> F aheadOf(SV,{names[-1]})")
    else:
        strict.append(f"F aheadOf(SV,POV1) and F aheadOf(POV1,{names[-1]}) -> F aheadOf(SV,{names[-1]})")
    return rng.choice(strict)


def atoms(rng: random.Random) -> tuple[str, str, str]:
    """Three predicates, any of which may hold without the others."""
    p = rng.choice(
        (f"v_lon(SV) > {rng.randint(1, 30)} m/s", f"v_lon(SV) <= {rng.randint(5, 30)} m/s", "atLane(SV,L)")
    )
    q = rng.choice(
        (f"v_lon(POV) < {rng.randint(1, 30)} m/s", "atLane(POV,L)", f"v_lat(POV) > {rng.randint(1, 3)} m/s")
    )
    r = rng.choice((f"s(POV) - s(SV) < {rng.randint(5, 90)} m", f"d(POV) - d(SV) >= {rng.randint(2, 8)} m"))
    return p, q, r


def untils(rng: random.Random, truth: bool) -> str:
    """Chains of until, windows inside each other, distribution."""
    p, q, r = atoms(rng)
    a, b = rng.randint(1, 4), rng.randint(1, 4)
    if truth:
        return rng.choice(
            [
                f"{p} U ({q} and ({q} U {r})) -> F {r}",
                f"({p}) U ({q}) and G {r} -> ({p} and {r}) U ({q})",
                f"F[0, {a} s] F[0, {b} s] {p} -> F[0, {a + b} s] {p}",
                f"G[0, {a + b} s] {p} -> G[0, {a} s] G[0, {b} s] {p}",
                f"G[0, {a + b} s] {p} and F[0, {a} s] {q} -> F ({p} and {q})",
                f"(({p}) U ({q})) U ({r}) -> F ({r})",
                f"G ({p} -> F[0, {a} s] {q}) and F {p} -> F {q}",
                f"({p}) U[{a} s, {a + b} s] ({q}) -> F[0, {a + b} s] {q}",
                f"({p}) U ({q}) and G not ({q}) -> {r}",
                f"F[{a} s, {a + b} s] ({p} and {q}) -> F {p} and F {q}",
            ]
        )
    return rng.choice(
        [
            f"({p}) U ({q}) -> G ({p})",
            f"F ({p}) and F ({q}) -> F ({p} and {q})",
            f"F[0, {a + b} s] {p} -> F[0, {a} s] {p}",
            f"G[0, {a} s] {p} -> G[0, {a + b} s] {p}",
            f"({p}) U ({q}) and ({p}) U ({r}) -> ({p}) U ({q} and {r})",
            f"G[0, {a} s] {p} and F[0, {a + b} s] {q} -> F ({p} and {q})",
            f"F[{a} s, {a + b} s] {q} -> ({p}) U ({q})",
            f"G ({p} or {q}) -> G ({p}) or G ({q})",
            f"({p}) U ({q}) -> F ({p} and {q})",
            f"G ({p} -> F[0, {a} s] {q}) -> F {q}",
        ]
    )


def lanes(rng: random.Random, truth: bool) -> str:
    """Quantifiers over lanes, beside until, F and G."""
    speed, seconds = rng.randint(5, 30), rng.randint(1, 5)
    fast, span = f"v_lon(SV) > {speed} m/s", f"[0, {seconds} s]"
    anywhere = "some M in lanes"
    if truth:
        return rng.choice(
            [
                f"(every M in lanes: G{span} not atLane(SV,M)) -> not F{span} atLane(SV,L)",
                "(some M in lanes: G atLane(SV,M)) -> G (some M in lanes: atLane(SV,M))",
                f"F (some M in lanes: atLane(SV,M) and {fast}) -> F {fast}",
                f"atLane(SV,L) and {fast} -> (some M in lanes: atLane(SV,M) and {fast})",
                "(some M in lanes: sameLane(SV,POV,M)) -> (some M in lanes: atLane(POV,M))",
                "inAdjLanes(SV,POV,L) -> (some M in lanes: atLane(POV,M))",
                f"G (every M in lanes: atLane(SV,M) -> {fast}) and atLane(SV,L) -> {fast}",
                "(every M in adjacentLanes(L): not atLane(SV,M))"
                " <-> not (some M in adjacentLanes(L): atLane(SV,M))",
                f"({anywhere}: atLane(SV,M) U{span} atLane(POV,M)) -> F ({anywhere}: atLane(POV,M))",
            ]
        )
    return rng.choice(
        [
            "(some M in lanes: atLane(SV,M)) -> atLane(SV,L)",
            f"G (some M in lanes: atLane(SV,M)) -> (some M in lanes: G[0, {seconds} s] atLane(SV,M))",
            f"F (some M in lanes: atLane(SV,M)) -> (every M in lanes: F atLane(SV,M)) or {fast}",
            f"{fast} -> (some M in lanes: atLane(SV,M) and {fast})",
            f"({anywhere}: atLane(SV,M)) and ({anywhere}: atLane(POV,M)) -> ({anywhere}: sameLane(SV,POV,M))",
            "atLane(SV,L) -> (some M in adjacentLanes(L): F atLane(SV,M))",
            f"atLane(SV,L) and F{span} not atLane(SV,L) -> F (some M in adjacentLanes(L): atLane(SV,M))",
            f"sameLane(SV,POV,L) -> G[0, {seconds} s] (some M in lanes: sameLane(SV,POV,M))",
        ]
    )


def motions(rng: random.Random, truth: bool) -> str:
    """Claims about vehicles that move: bounds that grow, what does not grow, crossings, braking."""
    v, r, d, x = rng.randint(2, 30), rng.randint(1, 6), rng.randint(1, 5), rng.randint(0, 40)
    more, off = ("F ", 0) if truth else ("", -1)
    far = f"s(SV) <= {x + v * d + off} m"
    braked = f"s(SV) <= {x + v * d} m + {r * d * d}/2 * 1 m" + ("" if truth else " - 1/4 * 1 m")
    bounded = f"assuming motion, a_lon(SV) <= {r} m/s^2:"
    slower, span, then = f"v_lon(SV) <= {v} m/s", f"[0, {d} s]", f"[{d} s, {d} s]"
    later = f"G{span} v_lon(SV) <= {v + r * d + off} m/s"
    crossed = v + (1 if truth else r + 3)
    return rng.choice(
        [
            f"assuming motion: {slower} and G a_lon(SV) <= {r} m/s^2 -> {later}",
            f"{bounded} {slower} -> {later}",
            f"assuming motion, a_lon(SV) >= -{r} m/s^2: v_lon(SV) >= {v} m/s"
            f" -> G{span} v_lon(SV) >= {v - r * d - off} m/s",
            f"assuming motion: s(SV) <= {x} m and G {slower} -> G{then} {far}",
            f"assuming motion, {slower}: s(SV) <= {x} m -> G{then} {far}",
            f"assuming motion: {'G ' if truth else ''}v_lon(SV) <= v_lon(POV) and s(SV) < s(POV)"
            " -> G s(SV) < s(POV)",
            f"assuming motion: v_lon(SV) > {v + r} m/s and F v_lon(SV) < {v} m/s"
            f" -> F v_lon(SV) = {crossed} m/s",
            f"assuming motion: s(SV) < s(POV) and F s(SV) > s(POV) -> {more}v_lon(SV) > v_lon(POV)",
            "assuming motion: atLane(SV,L) and F not atLane(SV,L) -> "
            + ("atLane(SV,L) U not atLane(SV,L)" if truth else f"F{span} not atLane(SV,L)"),
            f"{bounded} {slower} and s(SV) <= {x} m -> G{then} {braked}",
            f"assuming motion: d(SV) <= {x} m and G v_lat(SV) <= 1 m/s -> G{then} d(SV) <= {x + d + off} m",
            f"{bounded} a_lon(SV) <= {r + (1 if truth else -1)} m/s^2",
            f"assuming motion: {slower} -> "
            + (f"v_lon(SV) <= {v + r} m/s" if truth else f"G{span} v_lon(SV) <= {v + 20 * d} m/s"),
        ]
    )


def eventualities(rng: random.Random, truth: bool) -> str:
    """Eventualities inside each other, steps of time, boundaries that are left open."""
    p, q, _ = atoms(rng)
    v, d = rng.randint(1, 30), rng.randint(1, 3)
    if truth:
        return rng.choice(
            [
                f"F G ({p}) -> G F ({p})",
                f"F G ({p}) and G F ({q}) -> F ({p} and {q})",
                f"G ({p} -> F[{d} s, {d} s] {p}) and ({p}) -> F[{2 * d} s, {2 * d} s] ({p})",
                f"G ({p} -> F[{d} s, {d} s] {p}) and ({p}) -> G F ({p})",
                f"G F ({p} and {q}) -> G F ({p})",
            ]
        )
    return rng.choice(
        [
            f"G F ({p}) -> F G ({p})",
            f"G F ({p}) and G F ({q}) -> F ({p} and {q})",
            f"G F ({p}) -> ({p}) or F G ({p})",
            f"v_lon(SV) <= {v} m/s and F v_lon(SV) > {v} m/s -> v_lon(SV) <= {v} m/s U v_lon(SV) > {v} m/s",
            f"F ({p}) -> not ({p}) U ({p}) or F G ({q})",
        ]
    )


FAMILIES: tuple[tuple[Shape, int], ...] = (
    (scenarios, 15),
    (pairs, 5),
    (speeds, 13),
    (gaps, 13),
    (orderings, 10),
    (untils, 15),
    (lanes, 10),
    (motions, 15),
    (eventualities, 4),
)
"""The shapes, each with its share in percent."""


def draw(count: int, seed: int) -> Iterator[Claim]:
    """``count`` different claims: the same for the same seed, true and false ones in turns."""
    rng, seen, number = random.Random(seed), set[str](), 0
    shapes = [shape for shape, share in FAMILIES for _ in range(share)]
    while number < count:
        shape, truth = rng.choice(shapes), number % 2 == 0
        text = " ".join(shape(rng, truth).split())
        if text in seen:
            continue
        seen.add(text)
        number += 1
        yield Claim(shape.__name__, text, None if shape is pairs else truth)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    for claim in draw(options.count, options.seed):
        print(f"{claim.family:14} {claim.truth!s:6} {claim.text}")


if __name__ == "__main__":
    main()
