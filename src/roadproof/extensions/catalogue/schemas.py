"""Titles of the schemas of this extension's JSON files."""

from collections.abc import Mapping

from roadproof.extensions.catalogue.catalogue_data import CatalogueData

TITLES: Mapping[type, str] = {
    CatalogueData: "roadproof catalogue --json: what tests show and mean, and what nobody tests",
}
