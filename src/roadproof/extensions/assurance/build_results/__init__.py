"""What build servers and code hosts are told of an answer: cases with places, as JUnit XML and SARIF."""
