"""Every relative link of every Markdown file leads to a file, every anchor to a heading: check_links.py SOURCE. No network."""
import pathlib
import re
import sys
import urllib.parse

SKIPPED = ("build", ".git", "node_modules", "dist")


def pages(root):
    for file in sorted(root.rglob("*.md")):
        parts = file.relative_to(root).parts
        if not any(part == skip or (skip == "build" and part.startswith("build")) for part in parts for skip in SKIPPED):
            yield file


def without_code(text):
    text = re.sub(r"```.*?```", "", text, flags=re.S)
    text = re.sub(r"^ {4}.*$", "", text, flags=re.M)
    return re.sub(r"`[^`\n]*`", "`code`", text)


def anchors(text):
    """As GitHub makes them from headings."""
    found = set()
    for heading in re.findall(r"^#{1,6} +(.*?) *#*$", re.sub(r"```.*?```", "", text, flags=re.S), re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        slug = re.sub(r"[^\w\- ]", "", heading).replace(" ", "-")
        number = 0
        while (name := slug if number == 0 else f"{slug}-{number}") in found:
            number += 1
        found.add(name)
    return found


def complaints(root):
    for page in pages(root):
        text = page.read_text()
        for link in re.findall(r"!?\[[^\]]*\]\(([^)\s]+)\)", without_code(text)):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (page.parent / path).resolve() if path else page
            name = f"{page.relative_to(root)}: {link}"
            if not target.exists():
                yield f"{name}: there is no such file"
            elif anchor and target.suffix == ".md" and anchor not in anchors(target.read_text()):
                yield f"{name}: there is no such heading"
    index = (root / "docs/README.md").read_text()
    for page in sorted((root / "docs").glob("*.md")):
        if page.name != "README.md" and f"]({page.name})" not in index:
            yield f"docs/README.md: does not lead to {page.name}"


def main(source):
    root = pathlib.Path(source).resolve()
    found = list(complaints(root))
    print("\n".join(found))
    sys.exit(1 if found or len(list(pages(root))) < 10 else 0)


main(sys.argv[1])
