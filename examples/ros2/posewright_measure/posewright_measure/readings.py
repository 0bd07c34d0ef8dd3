"""The file of readings that `posewright calibrate` takes: one line a pose, on the disk before the robot moves on."""
from __future__ import annotations

import csv
import os
import pathlib


class Mean:
    """Averages of what is read under each name."""

    def __init__(self) -> None:
        self._sums: dict[str, float] = {}
        self._counts: dict[str, int] = {}

    def add(self, name: str, value: float) -> None:
        self._sums[name] = self._sums.get(name, 0.0) + value
        self._counts[name] = self._counts.get(name, 0) + 1

    def value(self, name: str) -> float | None:
        """None: nothing was read under this name."""
        return self._sums[name] / self._counts[name] if name in self._sums else None


class Readings:
    """Lines id, joints, readings; a file that is there already goes on, if its columns are these."""

    def __init__(self, file: str, joints: list[str], readings: list[str]) -> None:
        self.columns = ["id", *[f"{joint} [rad]" for joint in joints], *[f"{name} [m]" for name in readings]]
        self.path = pathlib.Path(file)
        self.measured: set[int] = set()
        if self.path.exists() and self.path.stat().st_size:
            self._go_on()
        else:
            self._append(self.columns)

    def _go_on(self) -> None:
        with self.path.open(newline="") as file:
            lines = list(csv.reader(file))
        if lines[0] != self.columns:
            raise ValueError(f"{self.path} has other columns: {','.join(lines[0])}")
        for number, line in enumerate(lines[1:], 2):
            if len(line) != len(self.columns):
                raise ValueError(f"{self.path}:{number}: {len(line)} values, not {len(self.columns)}; take the line out to measure its pose again")
            self.measured.add(int(line[0]))
        if not self.path.read_bytes().endswith(b"\n"):
            raise ValueError(f"{self.path}:{len(lines)}: the line has no end; take it out to measure its pose again")

    def add(self, pose: int, joints: list[float], readings: list[float | None]) -> None:
        """A reading that is None was not read: its cell is empty."""
        self._append([pose, *map(repr, joints), *("" if value is None else repr(value) for value in readings)])
        self.measured.add(pose)

    def _append(self, row: list) -> None:
        with self.path.open("a", newline="") as file:
            csv.writer(file, lineterminator="\n").writerow(row)
            file.flush()
            os.fsync(file.fileno())
