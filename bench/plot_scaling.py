#!/usr/bin/env python3
"""bench/plot_scaling.py FILE.csv OUT.svg: the table that bench/scaling.sh prints as a log-log plot."""
import csv
import math
import sys

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 340, 64, 24, 40, 52


def place(value, low, high, start, end):
    return start + (math.log10(value) - low) / (high - low) * (end - start)


def main():
    rows = list(csv.DictReader(open(sys.argv[1])))
    n = [float(r["blocks"]) for r in rows]
    series = [("seconds", "s", "#1f6f8b", [float(r["seconds"]) for r in rows]),
              ("peak MiB", "MiB", "#b3541e", [float(r["peak MiB"]) for r in rows])]
    x = [place(v, 3.9, 6.1, LEFT, WIDTH - RIGHT) for v in n]
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
           f'font-size="13"><rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
           f'<text x="{LEFT}" y="22" fill="#222">select, 18 of n blocks of 9 × 33, two threads, certificate included</text>']
    for k in range(0, 5):
        y = place(10 ** k, 0, 4, HEIGHT - BOTTOM, TOP)
        svg.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>'
                   f'<text x="{LEFT - 8}" y="{y + 4:.1f}" text-anchor="end" fill="#444">{10 ** k}</text>')
    for v, at in zip(n, x):
        svg.append(f'<text x="{at:.1f}" y="{HEIGHT - BOTTOM + 20}" text-anchor="middle" fill="#444">{v:,.0f}</text>')
    for name, unit, colour, values in series:
        y = [place(v, 0, 4, HEIGHT - BOTTOM, TOP) for v in values]
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
        svg.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for a, b, v in zip(x, y, values):
            svg.append(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.5" fill="{colour}"/>'
                       f'<text x="{a:.1f}" y="{b - 9:.1f}" text-anchor="middle" fill="{colour}">{v:g} {unit}</text>')
    svg.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}" text-anchor="middle" fill="#444">blocks n</text></svg>')
    open(sys.argv[2], "w").write("\n".join(svg) + "\n")


main()
