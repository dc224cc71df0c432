"""The titles of the JSON schemas of this extension."""

from collections.abc import Mapping

from roadproof.extensions.traffic.answers import monitor, traffic

TITLES: Mapping[type, str] = {
    monitor.MonitorData: "roadproof monitor --json: where a formula holds on one trace",
    traffic.EvaluationData: (
        "results.json of roadproof evaluate, and its --json: dangers in recordings, and what matches them"
    ),
}
