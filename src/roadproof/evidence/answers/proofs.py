"""What claims are called in findings."""


def shown(label: tuple[str, str, int | None] | None, set_name: str) -> str:
    """A label as text: ``P1 scenario 1 base``."""
    name, part, scenario = label or ("", "", None)
    middle = f" scenario {scenario}" if scenario is not None else ""
    return f"{name}{'-' + part if part else ''}{middle} {set_name}".strip()


def misnamed(where: str, told: tuple[str, str, int | None], label: tuple[str, str, int | None] | None) -> str:
    """Why a claim is not what it is called."""
    right = "no template property" if label is None else f"that of {shown(label, '')}"
    return f"{where} is called {shown(told, '')[:60]}, but its claim is {right}"
