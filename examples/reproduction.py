"""Tables and plots of the pages docs/reproduction-*.md: how a script prints them, writes them into its page, or compares.

A page has its tables between `<!-- begin NAME -->` and `<!-- end NAME -->`. A script is a list of sections: a name and a function
that takes a Run and returns Markdown. Plots are SVG files beside the page, in docs/images."""
import argparse
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
INK, BLUE, RUST, GREEN = "#222", "#1f6f8b", "#b3541e", "#5b8c2a"


class Run:
    """The program in a folder that holds a copy of the example; each command is run once."""

    def __init__(self, program, example, folder):
        self.program, self.folder, self.known, self.plots = program, pathlib.Path(folder), {}, {}
        for file in (ROOT / "examples" / example).iterdir():
            if file.suffix in (".yaml", ".csv", ".urdf"):
                shutil.copy(file, folder)

    def json(self, *words):
        if words not in self.known:
            done = subprocess.run([self.program, *words, "--json"], cwd=self.folder, capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"posewright {' '.join(words)}: {done.stderr}")
            self.known[words] = json.loads(done.stdout)
        return self.known[words]

    def plot(self, name, title, svg):
        self.plots[f"{name}.svg"] = svg
        return f"![{title}](images/{name}.svg)"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in row) + " |" for row in lines) + "\n"


def rms(values):
    values = list(values)
    return math.sqrt(sum(v * v for v in values) / len(values))


class Panel:
    """One diagram of an SVG picture: axes in the units of the data, marks in the picture's."""

    def __init__(self, title, x, y, left, width=300, height=200, grid=True):
        self.x, self.y, self.left, self.right, self.top, self.bottom = x, y, left + 46, left + width - 12, 34, height - 34
        self.marks = [f'<text x="{self.left}" y="20" fill="{INK}">{title}</text>',
                      f'<rect x="{self.left}" y="{self.top}" width="{self.right - self.left}" height="{self.bottom - self.top}" '
                      'fill="none" stroke="#888"/>']
        for value in ticks(*y) if grid else ():
            self.line((x[0], value), (x[1], value), "#ddd")
            self.marks.append(f'<text x="{self.left - 5}" y="{self.at(x[0], value)[1] + 4:.1f}" text-anchor="end" fill="#444">{value:g}</text>')

    def at(self, x, y):
        return (self.left + (x - self.x[0]) / (self.x[1] - self.x[0]) * (self.right - self.left),
                self.bottom - (y - self.y[0]) / (self.y[1] - self.y[0]) * (self.bottom - self.top))

    def label_x(self, x, text):
        self.marks.append(f'<text x="{self.at(x, 0)[0]:.1f}" y="{self.bottom + 17}" text-anchor="middle" fill="#444">{text}</text>')

    def line(self, a, b, colour, width=1):
        (x1, y1), (x2, y2) = self.at(*a), self.at(*b)
        self.marks.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" stroke-width="{width}"/>')

    def bar(self, x, width, y, colour):
        (left, top), (right, bottom) = self.at(x - width / 2, y), self.at(x + width / 2, max(self.y[0], 0))
        self.marks.append(f'<rect x="{left:.1f}" y="{top:.1f}" width="{right - left:.1f}" height="{bottom - top:.1f}" '
                          f'fill="{colour}" fill-opacity="0.7"/>')

    def mark(self, x, y, kind, colour):
        a, b = self.at(x, y)
        shape = {"circle": f'<circle cx="{a:.1f}" cy="{b:.1f}" r="4" fill="none"',
                 "cross": f'<path d="M{a - 4:.1f} {b - 4:.1f}l8 8m0 -8l-8 8" fill="none"',
                 "triangle": f'<path d="M{a:.1f} {b - 5:.1f}l5 8h-10z" fill="none"'}[kind]
        self.marks.append(f'{shape} stroke="{colour}" stroke-width="1.5"/>')


def ticks(low, high):
    step = 10 ** math.floor(math.log10((high - low) / 2))
    step = next(step * factor for factor in (1, 2, 5, 10) if (high - low) / (step * factor) <= 6)
    return [round(k * step, 9) for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def svg(panels, width, height=200, legend=()):
    words = [f'<text x="{46 + 150 * k}" y="{height + 16}" fill="{colour}">{text}</text>' for k, (text, colour) in enumerate(legend)]
    full = height + (24 if legend else 0)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {full}" font-family="sans-serif" font-size="12">'
            f'<rect width="{width}" height="{full}" fill="#ffffff"/>\n'
            + "\n".join(mark for panel in panels for mark in panel.marks) + "\n" + "\n".join(words) + "</svg>\n")


def histograms(title, values, width):
    """One histogram an axis; `values`: axis → mm, `width` of a bin in mm."""
    panels = []
    for k, (axis, numbers) in enumerate(values.items()):
        counts = {}
        for number in numbers:
            counts[math.floor(number / width)] = counts.get(math.floor(number / width), 0) + 1
        end = max(map(abs, [*counts, 1])) + 1
        panel = Panel(f"{title} {axis}, mm", (-end * width, end * width), (0, max(counts.values()) * 1.1), 230 * k, 230)
        for place, count in counts.items():
            panel.bar((place + 0.5) * width, 0.9 * width, count, BLUE)
        for x in ticks(-end * width, end * width):
            panel.label_x(x, f"{x:g}")
        panels.append(panel)
    return svg(panels, 230 * len(panels))


def block(name):
    return re.compile(rf"(<!-- begin {re.escape(name)} -->\n).*?(<!-- end {re.escape(name)} -->)", re.S)


def into_page(page, name, text):
    return block(name).sub(lambda match: f"{match[1]}\n{text.strip()}\n\n{match[2]}", page)


def difference(page, name, text):
    """None if the page has this section as it is printed, else what differs."""
    found = block(name).search(page)
    if not found:
        return f"the page has no section {name}"
    old = found[0].splitlines()[2:-2]
    new = text.strip().splitlines()
    return next((f"{name}: the page has\n  {a}\nthe program gives\n  {b}" for a, b in zip(old + [""] * len(new), new + [""] * len(old)) if a != b), None)


def main(doc, example, sections, plans, prepare=lambda run: None):
    """`sections`: name → function of a Run; `plans`: pose list of the example → words of the command that made it, after `prepare`."""
    parser = argparse.ArgumentParser(description=doc.split("\n", maxsplit=1)[0])
    parser.add_argument("sections", nargs="*", help=f"{', '.join(sections)} (all)")
    parser.add_argument("--program", default="posewright", help="the posewright to run")
    parser.add_argument("--plan", action="store_true", help="search for the stored pose lists again, first (minutes)")
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--write", action="store_true", help="write tables and plots into the page of the documentation")
    way.add_argument("--check", action="store_true", help="compare with that page; exit status 1 if something differs")
    options = parser.parse_args()
    unknown = set(options.sections) - set(sections)
    if unknown:
        sys.exit(f"no section {', '.join(sorted(unknown))}; there are {', '.join(sections)}")
    if os.sep in options.program:
        options.program = str(pathlib.Path(options.program).resolve())
    page, images, differing = ROOT / "docs" / f"reproduction-{example}.md", ROOT / "docs" / "images", []
    with tempfile.TemporaryDirectory() as folder:
        run = Run(options.program, example, folder)
        if options.plan:
            prepare(run)
        for name, words in plans.items() if options.plan else ():
            subprocess.run([options.program, *words.split(), "-o", "-", "--poses-csv", name, "--force"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            shutil.copy(pathlib.Path(folder) / name, ROOT / "examples" / example / name)
        for name in options.sections or sections:
            run.plots = {}
            text = sections[name](run)
            if options.write:
                page.write_text(into_page(page.read_text(), name, text))
                for file, plot in run.plots.items():
                    (images / file).write_text(plot)
            elif options.check:
                differing += filter(None, [difference(page.read_text(), name, text)])
                differing += [f"docs/images/{file} differs" for file, plot in run.plots.items() if (images / file).read_text() != plot]
            else:
                print(f"## {name}\n\n{text}")
    print("\n".join(differing), end="\n" if differing else "")
    sys.exit(1 if differing else 0)
