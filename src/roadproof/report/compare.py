"""Two formulas side by side, in words."""

from roadproof.searching.compare import Comparison

_SENTENCES = {
    "equivalent": "the two are equivalent",
    "stronger": "the first is stronger: it implies the second, but not the reverse",
    "weaker": "the first is weaker: the second implies it, but not the reverse",
    "incomparable": "the two are incomparable: neither implies the other",
    "unknown": "not decided",
}


def as_text(comparison: Comparison) -> str:
    """The two formulas, how they relate, and what shows that."""
    sets = comparison.sets
    lines = [
        f"first   {comparison.first.text}  (set {sets[0]})",
        f"second  {comparison.second.text}  (set {sets[1]})",
        _SENTENCES[comparison.relation],
    ]
    for name, direction in comparison.directions.items():
        shown = f"  {name}: {direction.verdict}"
        shown += " for all time, on every road" if direction.certificate else ""
        shown += " by a judged drive" if direction.drive else ""
        shown += f"; {direction.reason}" if direction.reason else ""
        lines.append(shown)
    return "\n".join(lines)
