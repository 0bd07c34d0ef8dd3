"""Every equation that a comment cites as `theory.md eq. (n)` is in docs/theory.md, each number is there once and none is
missing, and no comment cites a document that is not in the repository: check_equations.py SOURCE."""

import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
there = [int(n) for n in re.findall(r"^    \((\d+)\)", (SOURCE / "docs/theory.md").read_text(), re.M)]
bad = [] if sorted(there) == list(range(1, len(there) + 1)) else [f"docs/theory.md: equations are numbered {there}"]
cited = 0
for folder in ("include", "src", "planners", "python", "tests"):
    for path in sorted((SOURCE / folder).rglob("*")):
        if path.suffix not in (".hpp", ".cpp", ".inl", ".py") or path.name == "check_equations.py":
            continue
        text = re.sub(r"\s*\n\s*(///?|#|\*)?\s*", " ", path.read_text())
        for rest in re.findall(r"theory\.md eqs?\. ((?:\(\d+\)(?:, | and | to |–)?)+)", text):
            for number in re.findall(r"\d+", rest):
                cited += 1
                if int(number) not in there:
                    bad.append(f"{path.relative_to(SOURCE)}: theory.md has no eq. ({number})")
        if re.search(r"\bdesign(\.md)? §", text, re.I):
            bad.append(f"{path.relative_to(SOURCE)}: cites a design document that is not in the repository")
print("\n".join(bad) or f"{cited} citations of {len(there)} equations")
sys.exit(1 if bad or cited < 10 else 0)
