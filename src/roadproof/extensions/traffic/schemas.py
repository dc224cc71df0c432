"""What the schemas of the JSON files of this extension are called."""

from collections.abc import Mapping

from roadproof.extensions.traffic.answers import monitor, traffic

TITLES: Mapping[type, str] = {
    monitor.Answer: "roadproof monitor --json: where a formula holds on one trace",
    traffic.Answer: (
        "results.json of roadproof evaluate, and its --json: dangers in recordings, and what matches them"
    ),
}
