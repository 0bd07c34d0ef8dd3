"""Every equation that a comment cites as `theory.md eq. (n)` is in docs/theory.md, each number is there once and none is
missing, no comment cites a page or document that is not in the repository, and every @param is in the declaration below it:
check_comments.py SOURCE."""

import pathlib
import re
import sys

SOURCE = pathlib.Path(sys.argv[1])
there = [int(n) for n in re.findall(r"^    \((\d+)\)", (SOURCE / "docs/theory.md").read_text(), re.M)]
bad = [] if sorted(there) == list(range(1, len(there) + 1)) else [f"docs/theory.md: equations are numbered {there}"]
cited = 0
for folder in ("include", "src", "planners", "python", "tests"):
    for path in sorted((SOURCE / folder).rglob("*")):
        if path.suffix not in (".hpp", ".cpp", ".inl", ".py") or path.name == "check_comments.py":
            continue
        text = re.sub(r"\s*\n\s*(///?|#|\*)?\s*", " ", path.read_text())
        for rest in re.findall(r"theory\.md eqs?\. ((?:\(\d+\)(?:, | and | to |–)?)+)", text):
            for number in re.findall(r"\d+", rest):
                cited += 1
                if int(number) not in there:
                    bad.append(f"{path.relative_to(SOURCE)}: theory.md has no eq. ({number})")
        for page in re.findall(r"\bdocs/[\w-]+\.md", text):
            if not (SOURCE / page).is_file():
                bad.append(f"{path.relative_to(SOURCE)}: there is no {page}")
        if re.search(r"\bdesign(\.md)? §", text, re.I):
            bad.append(f"{path.relative_to(SOURCE)}: cites a design document that is not in the repository")
PARAMETER = re.compile(r"@param(?:\[\w+\])?\s+(\w+(?:, \w+)*)")
COMMENTED = re.compile(r"((?:^[ ]*///.*\n)+)((?:(?![ ]*///).*\n){0,25}?.*[;{][ ]*(?://.*)?$)", re.M)
parameters = 0
for path in sorted(p for folder in ("include", "src") for p in (SOURCE / folder).rglob("*.[ch]pp")):
    for comment, declaration in COMMENTED.findall(path.read_text()):
        for name in re.split(r", ", ", ".join(PARAMETER.findall(comment))):
            parameters += name != ""
            if not re.search(rf"\b{name}\b", declaration):
                bad.append(f"{path.relative_to(SOURCE)}: @param {name} is not in '{declaration.strip().splitlines()[0]}'")
print("\n".join(bad) or f"{cited} citations of {len(there)} equations, {parameters} parameters")
sys.exit(1 if bad or cited < 10 or parameters < 100 else 0)
