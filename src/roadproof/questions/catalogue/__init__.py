"""What tests show and mean."""
