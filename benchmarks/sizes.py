"""Size on disk of the package's dependencies, of each extra's, and of all, as installed."""

from importlib.metadata import PackageNotFoundError, distribution

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

PACKAGE = "iiwa-dnn"


def needed(name: str, extras: tuple[str, ...] = ()) -> dict[str, set[str]]:
    """Collect the installed distributions that one needs, itself included, with their extras."""
    found: dict[str, set[str]] = {}
    left = [(name, ("", *extras))]
    while left:
        name, asked = left.pop()
        name = canonicalize_name(name)
        new = set(asked) - found.setdefault(name, set())
        found[name] |= new
        try:
            requires = distribution(name).requires or []
        except PackageNotFoundError:  # a marker or an extra that this environment does not have
            del found[name]
            continue
        for requirement in map(Requirement, requires):
            marker = requirement.marker
            # An extra's own requirements are those whose marker is not true without it.
            if any(
                (marker is None or marker.evaluate({"extra": extra}))
                and (extra == "" or not (marker is None or marker.evaluate({"extra": ""})))
                for extra in new
            ):
                left.append((requirement.name, ("", *requirement.extras)))
    return found


def size(name: str) -> float:
    """Add up the sizes of a distribution's files [MB]."""
    files = [file.locate() for file in distribution(name).files or []]
    return sum(file.stat().st_size for file in files if file.is_file()) / 1e6


def bench_sizes(arguments: list[str], prog: str) -> int:
    """Print a table of the extras with the size that each adds to a plain install; return 0."""
    base = needed(PACKAGE)
    print("| extra | MB | of which |\n| --- | --- | --- |")
    every: set[str] = set(base)
    for extra in ("", *(distribution(PACKAGE).metadata.get_all("Provides-Extra") or [])):
        more = set(needed(PACKAGE, (extra,)) if extra else base) - (set(base) if extra else set())
        every |= more
        sizes = sorted(((size(name), name) for name in more), reverse=True)
        largest = ", ".join(f"{name} {mb:.0f}" for mb, name in sizes[:6] if mb > 1.0)
        print(f"| {extra or 'none'} | {sum(mb for mb, _ in sizes):.0f} | {largest} |")
    print(f"| all | {sum(map(size, every)):.0f} | |")
    return 0
