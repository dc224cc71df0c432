"""What the schemas of the JSON files of this extension are called."""

from collections.abc import Mapping

from roadproof.extensions.maps import answer

TITLES: Mapping[type, str] = {
    answer.Answer: "roadproof road --json: the roads of a map",
}
