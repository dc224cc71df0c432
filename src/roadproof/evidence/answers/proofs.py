"""The labels of claims in findings."""


def shown(label: tuple[str, str, int | None] | None, set_name: str) -> str:
    """Return a label as text: ``P1 scenario 1 base``."""
    name, part, scenario = label or ("", "", None)
    middle = f" scenario {scenario}" if scenario is not None else ""
    return f"{name}{'-' + part if part else ''}{middle} {set_name}".strip()


def misnamed(
    where: str, stated: tuple[str, str, int | None], label: tuple[str, str, int | None] | None
) -> str:
    """Return the message that a claim is not the one that its label names."""
    actual = "no template property" if label is None else f"that of {shown(label, '')}"
    return f"{where} is called {shown(stated, '')[:60]}, but its claim is {actual}"
