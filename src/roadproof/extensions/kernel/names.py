"""Names of claims as names in Coq. Trusted: no name may be mistaken for another, or for a keyword of Coq.

A name that collides with one of Coq, of the notations, or of the same file gets a number. The original name,
such as the vehicle "SV", is kept as a string constant.
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
_RESERVED = """
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
WORDS = frozenset(_RESERVED.split())


@dataclass
class Names:
    """The names of one printed file; each thing keeps its first name.

    ``things`` are vehicles and lanes; functions use only their arguments, so an argument may have the name of
    a thing. ``arguments`` and ``bound``: names in use inside functions and quantifiers.
    """

    given: dict[tuple[str, str], str] = field(default_factory=dict)
    taken: set[str] = field(default_factory=lambda: set(WORDS))
    things: set[str] = field(default_factory=set)
    arguments: set[str] = field(default_factory=set)
    bound: set[str] = field(default_factory=set)

    def thing(self, kind: str, name: str) -> str:
        """Return the Coq name of a vehicle or lane."""
        if (kind, name) not in self.given:
            word = _unused_name(name, self.taken | self.things | self.bound)
            self.things.add(word)
            self.given[kind, name] = word
        return self.given[kind, name]

    def of(self, kind: str, name: str) -> str:
        """Return the Coq name of a parameter or variable."""
        if (kind, name) not in self.given:
            self.given[kind, name] = self.new(name)
        return self.given[kind, name]

    def new(self, name: str) -> str:
        """Return an unused name similar to ``name``. Raises ``InputError`` if ``name`` is malformed."""
        word = _unused_name(name, self.taken | self.things | self.bound | self.arguments)
        self.taken.add(word)
        return word

    def argument(self, name: str, scope: Collection[str]) -> str:
        """Return a name for an argument that is not in ``scope``."""
        word = _unused_name(name, self.taken | set(scope))
        self.arguments.add(word)
        return word

    def local(self, name: str, scope: Collection[str]) -> str:
        """Return a name for a bound variable that is not in ``scope`` and no thing."""
        word = _unused_name(name, self.taken | self.things | set(scope))
        self.bound.add(word)
        return word


def zone(name: str) -> str:
    """Return the name of a zone. Raises ``InputError`` for one that proofs/kernel/Meaning.v lacks."""
    if name not in _ZONES:
        raise InputError(f"zone={name[:40]}: there are {', '.join(_ZONES)}")
    return name


def _unused_name(name: str, others: Collection[str]) -> str:
    if not name or len(name) > LONGEST:
        raise InputError(f"'{name[:60]}' is no name: it must have 1 to {LONGEST} characters")
    base = _STRANGE.sub("_", name.replace("@", "_at_"))
    base = base if _PLAIN.fullmatch(base) else f"x_{base}"
    word, count = base, 1
    while word in others:
        count += 1
        word = f"{base}_{count}"
    return word


def literal(text: str) -> str:
    """Return a name as a Coq string. Raises ``InputError`` for characters that names do not have."""
    if not _PLAIN.fullmatch(text) or len(text) > LONGEST:
        raise InputError(f"'{text[:60]}' is no name: letters, digits and _ make one")
    return f'"{text}"'


def quoted(text: str) -> str:
    """Return any printable ASCII text as a Coq string. Raises ``InputError`` for other texts."""
    if not (text.isascii() and text.isprintable()) or len(text) > LONGEST:
        raise InputError(f"'{text[:60]}' is not printed for Coq: a name there is printable ASCII")
    return '"' + text.replace('"', '""') + '"'


def comment(source: str) -> str:
    """Return text that is safe in a Coq comment: it cannot end it, or open a comment or string."""
    text = " ".join(source.split()).replace("*", " * ").replace('"', "'")
    return "".join(c if c.isascii() and c.isprintable() else "?" for c in text)


def q(value: Fraction) -> str:
    """Return a rational as a term of Tableau.v that needs no scope.

    >>> q(Fraction(-3, 4))
    '(q (-3) 4)'
    """
    top = str(value.numerator) if value >= 0 else f"({value.numerator})"
    return f"(q {top} {value.denominator})"
