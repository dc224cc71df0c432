"""The titles of the JSON schemas of this extension."""

from collections.abc import Mapping

from roadproof.extensions.assurance.answers import assurance, bundle, trace, trace_changes, trace_lock

TITLES: Mapping[type, str] = {
    assurance.AssuranceData: "roadproof assurance --json: an argument in GSN, and which of its parts hold",
    bundle.Manifest: "manifest.json of roadproof bundle: what is in it, and what checks it",
    trace.TraceData: "roadproof trace --json: which requirements are shown",
    trace_changes.TraceChangesData: "roadproof trace --baseline --json: what changed between two states",
    trace_lock.Lock: "requirements.lock.json: what every link of a trace rested on when it was accepted",
}
