"""The reasons for an UNKNOWN, or for evidence that is not accepted: every kind with its words.

>>> ReasonKind.WORK(60.0)
'no answer within 60 units of work'
>>> ReasonKind.WORK(60.0).kind
<ReasonKind.WORK: 'no answer within {:g} units of work'>
"""

from collections.abc import Iterable
from enum import StrEnum, unique
from functools import reduce
from typing import Final


class Reason(str):
    """A reason as its words, which are empty where there is none; code decides by its ``kind``.

    ``values``: what the words of the kind are filled in with.
    """

    kind: "ReasonKind"
    values: tuple[object, ...]

    def __new__(cls, kind: "ReasonKind", *values: object) -> "Reason":
        made = super().__new__(cls, kind.value.format(*values))
        made.kind, made.values = kind, values
        return made

    def __reduce__(self) -> "tuple[type[Reason], tuple[object, ...]]":
        return Reason, (self.kind, *self.values)

    @property
    def is_late(self) -> bool:
        """Return whether the clock or the end of a process left no answer; this says nothing of the claim."""
        return self.kind in (ReasonKind.CLOCK, ReasonKind.PROCESS, ReasonKind.WORKERS)


@unique
class ReasonKind(StrEnum):
    """The kinds of reasons. Called with what its words leave open, a kind gives a reason."""

    NONE = ""
    TOLD = "{}"
    """Words from where they are known: of an error, of limits, of a cause, of an answer that was kept."""
    AND = "{}; {}"
    # Work that ended
    WORK = "no answer within {:g} units of work"
    CLOCK = (
        "cut off by the clock after {:g} s, not by the count of work, so an idle or faster machine may "
        "answer: raise --timeout"
    )
    PROCESS = "its process ended each time, the last time alone: {}"
    WORKERS = "its workers ended each time, the last time while no other job ran"
    # Proofs
    FEW_LANES = "no countermodel on a road of few lanes"
    GROUND_QUERY = "z3 gave no answer to the ground query"
    STATE = "z3 gave no answer about a state with {} conditions: {}"
    ELEMENTS = "no end after {} lanes and lanelets that must exist"
    ROUNDS = "no end after {} rounds of instantiation"
    TRACES = "the only countermodels found over points in time are no traces"
    FACTS = "no proof was found from what is known of motion"
    CONTRADICTION = "what is assumed contradicts itself, so every claim follows"
    PREMISE = "the premise never holds, whatever the conclusion"
    NO_CERTIFICATE = "a proof was found, but no certificate can be made of it: {}"
    UNCONFIRMED = "a proof was found, but z3 answers {} to its derived query '{}'"
    LEFT_OPEN = "not proved where it is left open what a driver prevents, and no other proof was looked for"
    NO_REFUTATION = "no drive was found that refutes it"
    NO_REFUTATION_SOUGHT = "no drive that refutes it was looked for"
    NO_PROOF = "no proof that there is none was found"
    NO_STATE = "neither a proof nor a state against it was found"
    WITH = "with {}"
    LATE_PROOF = "a proof that the class is empty was found late, and is not kept"
    IMPOSSIBLE = "proved impossible: {}"
    PROVED_CORE = "proved for all {}; core: {}"
    PROVED_STATES = "proved for all states, with the parameters at their values here"
    OPEN_READINGS = "neither a proof nor a drive against {}"
    # Searches for drives
    UNREAD = (
        "no engine reads a part of the formula about time 0: no drive was found on which it holds whatever "
        "that part says, and others were not tried"
    )
    UNREAD_NO_STATE = (
        "no engine reads a part of the formula about time 0, and no state in which it holds was found among "
        "those that were looked at"
    )
    UNREAD_SAMPLED = (
        "no engine reads a part of the formula about time 0: from {} sampled states in which it holds no "
        "drive was found, and others were not tried"
    )
    SOLVER_GAVE_UP = "the solver gave up"
    NONE_FOUND = "none was found"
    BREACH = "after rounding, {}"
    OVERLAP = "between the samples, {}"
    BETWEEN_SAMPLES = "the drives that were found fail the formula between the samples of dt={} s"
    NEITHER = "neither a drive nor a refutation was found with the work given for {}"
    FEWER_DRIVES = "{} of {} drives that differ clearly; no further one: {}"
    NO_DRIVE = "no drive was found"
    NO_TREES = "no trees were found that show it"
    NO_DRIVE_ELSEWHERE = "no drive was found for the same in other places"
    SEARCH_FOUND_NONE = "a search found none"
    NONE_APART = "no drive was found that begins {:g} or more from all others"
    NOT_SHOWN = "the trace shows something else"
    NO_ANSWER = "the folder has no answer to it"
    WITH_QUESTION = "it is checked with the question of its folder"
    NONE_AHEAD = "no drive was found, {} s ahead"
    ON_ROAD = "{} (road {}, {:g} units of work)"
    NO_SEARCH = "no search: {}"
    NOT_ON = "on {}: {}"
    WORK_EACH = "{}; {:g} units of work each, {} s of driving"
    NOT_LOOKED_THROUGH = "some of the simple drives were not looked through: {}"
    NO_COMMON_STEP = "durations have no common step of {:g} s or more; no drive of coarser ones does"
    FOUND_OVERLAP = "on the drive that was found, {}"
    FOUND_REJECTED = "the drive that was found is rejected by the judge"
    DRIVE_REJECTED = "the judge rejects its drive"
    NO_GAP = "its drive is no gap when it is looked at as a test"
    EXTREME = "the {} {}: {}"
    OCCURS = "occurs in {}"
    # Drivers
    BOTH_SIDES = "drives were found on both sides"
    ONE_SIDE = "drives found: {}; no other was looked for; nothing is proved"
    ONE_SIDE_SOUGHT = "drives found: {}; a search found none on another side; nothing is proved"
    NOT_DRIVEN = (
        "{} drives begin in such a state, but with {} in place of SV they end otherwise ({}); a plate of "
        "'preventable' has drives on each side"
    )
    NOT_BEGUN = "no {} begins, of which the models speak"
    NO_PLACE = "no place of the plane is {}"
    TOO_LONG = "SV touches POV later than {} s after its start, up to which the controller is followed"
    PASSED_BY = "SV has passed POV at {} s; nothing is claimed after that"
    PASSED = (
        "no drive shows it: SV has passed POV, which then hits it from behind, or is never faster than POV "
        "and never brakes"
    )
    CONTRADICTS_BOUNDARY = "the drive from {} (SI) is not {}, as the boundary says it is: {}"
    # Evidence that is checked
    DOES_NOT_HOLD = "the formula does not hold on the drive: {}"
    NOT_REFUTED = "its trace does not refute it: {}"
    NOT_DERIVED = "the query cannot be derived: {}"
    NOT_UNSAT = "the query '{}' was answered {}, not unsat"
    ASSUMPTIONS = "the assumptions are {}, not {}"
    OPTIONS = "it does not name the options {}, but {}"
    STORED_QUERY = "the stored query is not the one that claim and instances give"
    UNSAID = "it does not say with which {} it was judged"
    NO_SCENARIO = "scenario={}, but there is none of that number"
    OTHER_SCENARIO = "scenario={}, but its formula is another: {:.120}"
    OTHER_VERDICT = "its verdict is {:.40}, but a drive that holds is WITNESSED"
    OTHER_VIEW = "its view is {:.40}, but a drive is judged in dense time"
    OTHER_TIMES = "the times at which it says that its parts are true are not those"
    NEEDS_SPECIFICATIONS = "{}; if it was made with specification files, name them with --spec FILE"
    LINK = "a link is no evidence: copy the file"
    NOT_ITS_ANSWER = "no claim of the question has this name"
    # Evidence that a kernel is asked about
    NOT_PUT = "it cannot be put to the kernel: {}"
    NOT_PRINTED = "it is not printed for the kernel: {}"
    NO_TABLEAU = "no tableau was found: {}"
    NO_DERIVATION = "no derivation was found: {}"
    NO_THEOREM = "no theorem for {} ({})"
    COQ_ENDED = "coqc ended without an answer: {}"
    COQ_SAYS = "coqc says: {:.200}"
    COQ_DOES_NOT_READ = "coqc does not read the claim: {:.200}"
    AXIOMS_UNSAID = "coqc did not say on which axioms it stands"
    AXIOMS = "it stands on {}"
    NOT_BY_COQ = "the proved checker does not accept it"
    NO_SCHEMA = "what it supposes of motion is no instance of a schema"
    LEMMA = "lemma {}, a fact about one instant, is not proved"
    LEMMA_TACTICS = f"{LEMMA}: --kernel coq tries tactics, too"
    LEMMA_TOO_LARGE = (
        "lemma {}, a fact about one instant, has no reason that was found, and more than {} comparisons: "
        "Coq's own tactics are not asked"
    )
    PROGRAM_ENDED = "the program ended without an answer: {}"
    PROGRAM_DOES_NOT_READ = "the program does not read it: {:.200}"
    NOT_BY_PROGRAM = "the checker does not accept its certificate"
    # The search for a tableau
    TABLEAU_LIMIT = "the search for a tableau came to its limit"
    TWO_ELEMENTS = "the certificate calls two elements {}"
    NO_RULE = "no rule is for {}"
    INSTANCES_USED = "the instances of the certificate are used up"
    # The search for a derivation
    NO_LANE = "the road has no lane for {}"
    TOO_MANY_STEPS = "it would have more than {} steps"
    NOT_SO = "the formula is not what it should be at some instant"
    IRRATIONAL = "an instant is irrational"
    IRRATIONAL_CHANGE = "what holds changes exactly at an irrational instant"
    IRRATIONAL_LIMIT = "what holds changes at an irrational instant, which rational ones only approach"
    IRRATIONAL_SIGN = "a sign is not seen between rational instants, so one may be irrational"
    SIGN_UNSEEN = "a sign is not seen at a rational instant"
    NO_INSTANT = "no rational instant was found at which it comes"
    CHANGE_TOGETHER = "both sides of an until change at one instant, or at an irrational one"
    CHANGE_TWICE = "what holds changes twice at nearly one instant"
    TOO_NEAR = "two instants are too near"
    # Catalogues that are judged again
    OTHER_TABLE = "it is not the table that these answers make"
    TEST_GONE = "there is no such test now: the answer is stale; ask again"
    TEST_UNKNOWN = "the answer does not know this test: it is stale; ask again"
    FILE_GONE = "{} is not there any more: the answer is stale; ask again"
    FILE_CHANGED = "{} has changed since it was judged: the answer is stale; ask again"
    # Requirements
    NO_EVIDENCE = "there is no evidence for it"
    NEVER_HOLDS = "it is proved that it never holds"
    ONE_DRIVE = "a drive shows it once; a claim about all traffic needs a proof"
    TRACE_REFUTES = "a judged drive or trace refutes it"
    DRIVE_REFUTES = "a judged drive refutes it"
    NO_DRIVE_SHOWS = "it is proved that no drive shows it"
    OPPOSITE_DRIVE = "a drive shows the opposite; that alone excludes nothing"
    OPPOSITE_PROVED = "the opposite is proved"
    VACUOUS = "it holds only because its premise never does"
    VERDICT = "{}: {}"
    DRIVER_SIDE = "{} is {} under this driver model"
    SHOWS_NONE = "it shows no scenario"
    NO_DRIVE_OF_FORMULA = "no drive of its formula was found"
    JUDGED_WITH = "judged with {}"
    TEXT_CHANGED = "its text changed"
    # Vehicles under test
    CONTROLLER_FAILED = "the controller failed after {} simulations: {}"
    NOT_PREVENTED = "{} simulations: it fails, but no driver model prevents a judged failure"
    NO_FAILURE = "no failure was found in {} simulations"
    SCENARIO_NOT_SHOWN = "it was not shown in {} simulations"
    CONTROLLER_GAVE_NO_DRIVE = "the controller failed: {}"
    BREAKS_REQUIREMENT = "it keeps clear of the vehicle of its rule, but breaks the requirement, too"
    # Recordings
    OFF_ROAD = "on no lane at any time"
    OFF_LINE = "the reference line of the road does not follow their way"
    OF_KIND = "they are {}"
    NOT_ALONG = "they are not on the road along it for a second"
    STANDING = "they are parked, or stand all the time"
    # Assurance cases
    NAME_FOLDER = "name the folder of --out, of which check reads the evidence"
    NO_FILE = "{} does not exist"
    DIGEST = "{} has changed: sha256 {}"
    NOT_ACCEPTED = "{}: {}: {}"
    WHOLE = "{} is {}, expected {}"
    WHOLE_BECAUSE = f"{WHOLE}: {{}}"
    NO_ENTRY = "no entry of {} matches {}"
    ENTRIES = "{} has {} entries, expected {}"
    EXPECTED = "{}: {}, expected {}"
    LACKS_EVIDENCE = "{}: {} has no evidence"
    UNDEVELOPED = "this part of the argument is not developed"

    def __call__(self, *values: object) -> Reason:
        return Reason(self, *values)


NO_REASON: Final = ReasonKind.NONE()


def joined(reasons: Iterable[Reason]) -> Reason:
    """Return reasons as one reason, without empty ones."""
    parts = [x for x in reasons if x]
    return reduce(ReasonKind.AND, parts) if parts else NO_REASON
