"""Global actions of a storyboard, and the values of parameters and variables that they change."""

from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.maps.xml_reader import Element

_IGNORED = frozenset(("EnvironmentAction", "InfrastructureAction"))
"""Actions that have no effect on the motion of a vehicle that does as the storyboard says."""


def initial_values(document: Document) -> dict[str, str]:
    """Values of the parameters and variables that the file declares, by name."""
    declared = document.root.iter("ParameterDeclaration"), document.root.findall("VariableDeclarations/*")
    return {(x.get("name") or "").lstrip("$"): x.get("value") or "" for nodes in declared for x in nodes}


def act_globally(document: Document, node: Element, values: dict[str, str]) -> None:
    """Do what the element inside a GlobalAction says. Raises ``InputError`` for what is not supported."""
    if node.tag in _IGNORED:
        return
    if node.tag not in ("ParameterAction", "VariableAction"):
        raise document.error(node, "this action is not supported")
    name = document.text(node, node.tag.removesuffix("Action").lower() + "Ref").lstrip("$")
    if name not in values:
        raise document.error(node, f"there is no parameter or variable {name}")
    kind = document.only(node)
    if kind.tag in ("SetAction", "ParameterSetAction", "VariableSetAction"):
        values[name] = document.text(kind, "value")
        return
    if kind.tag not in ("ModifyAction", "ParameterModifyAction", "VariableModifyAction"):
        raise document.error(kind, "this action is not supported")
    rule = document.only(document.child(kind, "Rule"))
    value = document.number(rule, "value")
    try:
        before = float(values[name])
    except ValueError:
        raise document.error(rule, f"{name}={values[name]}: a number is needed") from None
    if rule.tag == "AddValue":
        values[name] = repr(before + value)
    elif rule.tag == "MultiplyByValue":
        values[name] = repr(before * value)
    else:
        raise document.error(rule, "this rule is not supported")
