"""Writes the versions of `uv.lock` into pyproject.toml as constraints: a lock without download addresses."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BLOCK = re.compile(r"^constraint-dependencies = \[\n.*?^\]\n", re.MULTILINE | re.DOTALL)


def main() -> None:
    """Replace the constraints by what is locked now."""
    packages = tomllib.loads((ROOT / "uv.lock").read_text())["package"]
    versions: dict[str, set[str]] = {}
    for package in packages:
        if "registry" in package["source"]:
            versions.setdefault(package["name"], set()).add(package["version"])
    # A package that is locked in several versions depends on the platform; its dependents choose.
    pins = [f"{name}=={next(iter(found))}" for name, found in sorted(versions.items()) if len(found) == 1]
    block = "constraint-dependencies = [\n" + "".join(f'    "{pin}",\n' for pin in pins) + "]\n"
    project = ROOT / "pyproject.toml"
    text = project.read_text()
    if not BLOCK.search(text):
        raise SystemExit("pyproject.toml has no [tool.uv] constraint-dependencies to replace")
    project.write_text(BLOCK.sub(lambda _: block, text))
    print(f"{len(pins)} packages pinned")


if __name__ == "__main__":
    main()
