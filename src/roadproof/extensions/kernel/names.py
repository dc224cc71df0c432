"""Names of claims as names in Coq. Trusted: no name may be taken for another, or for a word of Coq.

A name that could be one of Coq's, of the notations', or of another thing of the same file is given a number.
What a name stands for, such as the vehicle "SV", is a text beside it, exactly as it is written.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass, field
from fractions import Fraction

from roadproof.errors import InputError

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_STRANGE = re.compile(r"[^A-Za-z0-9_]", re.ASCII)
LONGEST = 200
_ZONES = ("main", "merge", "depart")

# Every word that a printed file says beside the names of the claim: Coq's, the notations', the theories'.
_SAID = """
_ as at cofix else end exists exists2 fix for forall fun if IF in let match mod Prop return Set SProp then
Type by where with using
Admitted Axiom Check Compute Definition End Eval Export Fail Fixpoint From Goal Hint Import Inductive Lemma
Ltac Module Notation Open Parameter Print Proof Qed Record Require Scope Section Theorem Variable
F G U and or not some every inf max min inverse true false
s d v_lon v_lat a_lon a_lat j_lon length width kind occ lanes adjacentLanes lanelets zone main merge depart
vehicle road term formula side bound at_least_0 above_0 own_at_least own_at_most
Par Var Sig Own Num Free Bound Truth Some None list nil cons
claim bounds tableau tableau_proves proved string accepted valid valid_always tree eq_refl
Forall_nil Forall_cons conj I
Siz Add Mul Pow Div Max Min Place_lon Place_lat Speed_lon Speed_lat Acceleration_lon Acceleration_lat Jerk_lon
Absurd Untrue Opposed Both Either Plain Reads Sized Largest Smallest Over Sign Length Width Kind add_ mul_
given_ square_ times_ product_ sum_ number_ c_ x_
q by_ CloseTruth Close CloseLinear CloseRoad CloseRoads CloseZones Alpha Beta Timing New Inst InstUntil
NewRoad InstRoad Cut Fact the_drive drive reasons derivation shows shown bodies first_rectangle
other_rectangles beside lanes_named values signals is_a car truck bus motorcycle other
long wide long_above_0 wide_above_0 along across starts_at
starts_with pieces finally lane lies_in from_s to_s right_d left_d numbers
Place_lon Place_lat Speed_lon Speed_lat Acceleration_lon Acceleration_lat Jerk_lon the_trace
Turn One Split Element Each Whole Moment
Reach Break Soon Crossing Fixed Later Drive Signs Zeros Shown Roadproof Coq Meaning Text Linear Tableau
Products Rss Instant Named Sane Guarantee Case Motion Integral Schemas Moves
world element R W B named holds respects unbound parameter now iff_trans Prescribed Braking Gained Boundary
Braked Following Responding Joined Aided Assisted Aeb Reading
"""
WORDS = frozenset(_SAID.split())


@dataclass
class Names:
    """The names of one printed file; each thing keeps the name that it was first given.

    ``things`` are vehicles and lanes, of which functions speak by their arguments alone: so an argument may
    be called what a thing is called. ``arguments`` and ``bound`` are names that are in use inside others.
    """

    given: dict[tuple[str, str], str] = field(default_factory=dict)
    taken: set[str] = field(default_factory=lambda: set(WORDS))
    things: set[str] = field(default_factory=set)
    arguments: set[str] = field(default_factory=set)
    bound: set[str] = field(default_factory=set)

    def thing(self, kind: str, name: str) -> str:
        """The name of a vehicle or lane that the claim calls ``name``."""
        if (kind, name) not in self.given:
            found = _apart(name, self.taken | self.things | self.bound)
            self.things.add(found)
            self.given[kind, name] = found
        return self.given[kind, name]

    def of(self, kind: str, name: str) -> str:
        """The name of a parameter or variable that the claim calls ``name``."""
        if (kind, name) not in self.given:
            self.given[kind, name] = self.new(name)
        return self.given[kind, name]

    def new(self, name: str) -> str:
        """A name that nothing has, like ``name``. Raises ``InputError`` for what is none."""
        found = _apart(name, self.taken | self.things | self.bound | self.arguments)
        self.taken.add(found)
        return found

    def argument(self, name: str, scope: Collection[str]) -> str:
        """A name for an argument, which nothing in ``scope`` has."""
        found = _apart(name, self.taken | set(scope))
        self.arguments.add(found)
        return found

    def local(self, name: str, scope: Collection[str]) -> str:
        """A name for what a quantifier speaks of, which nothing in ``scope`` has, and no thing."""
        found = _apart(name, self.taken | self.things | set(scope))
        self.bound.add(found)
        return found


def zone(name: str) -> str:
    """The name of a zone. Raises ``InputError`` for one that proofs/kernel/Meaning.v lacks."""
    if name not in _ZONES:
        raise InputError(f"zone={name[:40]}: there are {', '.join(_ZONES)}")
    return name


def _apart(name: str, others: Collection[str]) -> str:
    if not name or len(name) > LONGEST:
        raise InputError(f"'{name[:60]}' is no name: it must have 1 to {LONGEST} characters")
    plain = _STRANGE.sub("_", name.replace("@", "_at_"))
    plain = plain if _PLAIN.fullmatch(plain) else f"x_{plain}"
    found, count = plain, 1
    while found in others:
        count += 1
        found = f"{plain}_{count}"
    return found


def literal(text: str) -> str:
    """A text of Coq. Raises ``InputError`` for what names are not made of."""
    if not _PLAIN.fullmatch(text) or len(text) > LONGEST:
        raise InputError(f"'{text[:60]}' is no name: letters, digits and _ make one")
    return f'"{text}"'


def quoted(text: str) -> str:
    """Any text of printable ASCII as one of Coq. Raises ``InputError`` for others."""
    if not (text.isascii() and text.isprintable()) or len(text) > LONGEST:
        raise InputError(f"'{text[:60]}' is not printed for Coq: a name there is printable ASCII")
    return '"' + text.replace('"', '""') + '"'


def comment(words: str) -> str:
    """Words for a comment of Coq: nothing in them ends it, opens another, or begins a text."""
    said = " ".join(words.split()).replace("*", " * ").replace('"', "'")
    return "".join(c if c.isascii() and c.isprintable() else "?" for c in said)


def q(value: Fraction) -> str:
    """A rational, in words of Tableau.v that need no scope.

    >>> q(Fraction(-3, 4))
    '(q (-3) 4)'
    """
    top = str(value.numerator) if value >= 0 else f"({value.numerator})"
    return f"(q {top} {value.denominator})"
