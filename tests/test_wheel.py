"""How a wheel is laid out."""

import tomllib

from places import REPOSITORY


def test_folders_of_packages_do_not_lie_in_one_another():
    """The first of them that is the beginning of a path is taken off it."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    sources = project["tool"]["hatch"]["build"]["targets"]["wheel"]["sources"]
    assert not [
        (outer, inner) for outer in sources for inner in sources if outer != inner and inner.startswith(f"{outer}/")
    ]
