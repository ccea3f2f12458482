"""Numbers have names: what a kernel may reach by a literal are components of vectors in space."""

import ast
from collections import Counter
from pathlib import Path

import pytest

import iiwa_dnn
from iiwa_dnn.compiling.sources import decoration

ROOT = Path(iiwa_dnn.__file__).parent

SPATIAL = {
    "references/rotations.py": {"R", "u", "v"},
    "references/shapes.py": {"target.position", "target.linear_velocity"},
    "robot/kinematics_kernel.py": {"axes", "v", "moved.axes", "start.axes", "placed"},
    "step/bodies.py": {"place.axes"},
    "schemes/collisions.py": {"Body.of(scene.bodies[pair.second]).half"},
    "schemes/dynamics.py": {
        *("A", "here.axes", "link.placement.axes", "wrench.force", "wrench.moment"),
        *("here.rate", "here.change", "here.linear"),
    },
    "schemes/scene.py": {"half", "x", "side", "Body.of(scene.bodies[body]).half", "place.axes"},
    "schemes/step.py": {"axis", "placement.axes"},
    "schemes/tasks.py": {"axes", "target.rotation"},
}
"""Vectors, rotations and placements of each file."""

SERIES = {"compiling/trigonometry.py": {"SINE", "COSINE", "HALF_PI", "sin_cos(angle)"}}
"""Tables of coefficients, and the pair of a sine and a cosine."""


def is_bare(node: ast.expr | None) -> bool:
    """Test whether an index has a number, or a constant in capitals, in place of a name."""
    match node:
        case ast.Tuple(elts=items):
            return any(map(is_bare, items))
        case ast.Slice(lower=lower, upper=upper):
            return is_bare(lower) or is_bare(upper)
        case ast.Constant(value=int()) | ast.UnaryOp():
            return True
        case ast.Name(id=name):
            return len(name) > 1 and name.isupper()
        case ast.BinOp(op=ast.Mult(), left=left, right=right):
            return is_bare(left) or is_bare(right)
        case ast.BinOp(left=left, right=right):
            # The place after another one has a name.
            sides = [side for side in (left, right) if not isinstance(side, ast.Constant)]
            return any(map(is_bare, sides))
    return False


def bare_indices(tree: ast.AST) -> Counter[str]:
    """Count the bare indices in kernels, by what they reach into."""
    kernels = [each for each in ast.walk(tree) if decoration(each)]
    found = [
        each.value
        for kernel in kernels
        for each in ast.walk(kernel)
        if isinstance(each, ast.Subscript) and is_bare(each.slice)
    ]
    names = [own for own in found if not (isinstance(own, ast.Attribute) and own.attr == "shape")]
    return Counter(map(ast.unparse, names))


def test_every_number_of_a_kernel_has_a_name() -> None:
    total = 0
    for path in sorted(ROOT.rglob("*.py")):
        file = str(path.relative_to(ROOT))
        found = bare_indices(ast.parse(path.read_text(encoding="utf-8")))
        found.subtract(dict.fromkeys(SERIES.get(file, ()), found.total()))
        reached = {name for name, count in found.items() if count > 0}
        assert reached <= SPATIAL.get(file, set()), file
        total += sum(found[name] for name in reached)
    assert total <= 100


@pytest.mark.parametrize(
    ("index", "bare"),
    [
        ("0", True),
        ("k, 2", True),
        ("3 * n + i", True),
        (":4", True),
        ("-1", True),
        ("FIRST", True),
        ("SIZE * n:", True),
        ("i, FIRST", True),
        ("i", False),
        ("k + 1", False),
        ("low + n - 1, j", False),
        ("Kind.FIRST", False),
        (":n", False),
    ],
)
def test_what_counts_as_a_number_without_a_name(index: str, bare: bool) -> None:
    source = f"@compiled\ndef f(a: Vector) -> float:\n    return a[{index}]\n"
    assert bare_indices(ast.parse(source)) == Counter({"a": 1} if bare else {})
    assert not bare_indices(ast.parse(source.replace("@compiled\n", "")))
