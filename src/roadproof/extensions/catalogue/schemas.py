"""What the schemas of the JSON files of this extension are called."""

from collections.abc import Mapping

from roadproof.extensions.catalogue import kept

TITLES: Mapping[type, str] = {
    kept.Index: "roadproof catalogue --json: what tests show and mean, and what nobody tests",
}
