"""Results for build servers and code hosts: test cases with source locations, as JUnit XML and SARIF."""
