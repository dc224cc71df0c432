"""What the schemas of the JSON files of this extension are called."""

from collections.abc import Mapping

from roadproof.extensions.assurance.answers import assurance, bundle, trace, trace_changes, trace_lock

TITLES: Mapping[type, str] = {
    assurance.Answer: "roadproof assurance --json: an argument in GSN, and which of its parts hold",
    bundle.Manifest: "manifest.json of roadproof bundle: what is in it, and what checks it",
    trace.Answer: "roadproof trace --json: which requirements are shown",
    trace_changes.Changes: "roadproof trace --baseline --json: what changed between two states",
    trace_lock.Lock: "requirements.lock.json: what every link of a trace rested on when it was accepted",
}
