"""The index and the answers of ``roadproof classify``: classes with drives, and claims about them."""

from collections.abc import Iterator

from roadproof.evidence.answers.entry import Entry, evidence_name, shows_of, shows_of_claim
from roadproof.evidence.answers.proofs import unchecked_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.strict import Fields

SCHEMA = "roadproof/classify/1"
CLASSES = "classes"  # the spec set of the file that defines them
_CLASS = ("name", "vehicles", "scenarios", "happens", "where", "description", "formula", "verdict", "reason")
_CLASS_MORE = ("situations", "traces", "drive")
_DOUBT = ("about", "reason")
_CLAIM = ("name", "kind", "claim", "verdict", "reason", "certificate", "seconds")


def read(data: Fields, background: Background) -> Iterator[Entry]:
    """The entries of an index or a kept answer. Raises ``InputError``."""
    common = background.at(CLASSES)
    for number, content in enumerate(data.items("classes"), 1):
        line = Fields(content, f"{data.where}, class {number}", (*_CLASS, *_CLASS_MORE))
        verdict, name = line.text("verdict"), line.text("name")
        shows = shows_of(verdict, line.where, drive="drive")
        yield Entry(
            common,
            line.where,
            ("class", name),
            verdict,
            name,
            shows,
            line.text("formula"),
            evidence_name(line, "drive"),
            unchecked=("that the formula is the class of that name",) if shows == "drive" else (),
            fault="" if name in line.text("formula") else f"{line.where}: its formula is not {name}",
        )
    for number, content in enumerate(data.items("claims"), 1):
        line = Fields(content, f"{data.where}, claim {number}", _CLAIM)
        verdict, name, claim = line.text("verdict"), line.text("name"), line.text("claim")
        shows = shows_of_claim(verdict, line.where)
        yield Entry(
            common,
            line.where,
            ("claim", name),
            verdict,
            line.text("kind"),
            shows,
            claim,
            evidence_name(line, "certificate"),
            unchecked=unchecked_of(verdict),
        )
    for number, content in enumerate(data.items("doubts") if data.has("doubts") else (), 1):
        line = Fields(content, f"{data.where}, doubt {number}", _DOUBT)
        yield Entry(common, line.where, ("doubt", number), "UNKNOWN", line.text("about"), "nothing", "")


READER = Reader(
    SCHEMA,
    ("set", "options", "parameters", "scenarios", "specs"),
    ("view", "text", "classes", "claims", "shares", "seconds", "doubts"),
    read,
    ("classes", "claims"),
    read,
)
