"""A run directory of bounce, read and checked: scene.toml, run.json, frames.extxyz, monitor.csv."""

import csv
import json
import re
import tomllib
from dataclasses import dataclass

import numpy as np

from studies.study import InputError


@dataclass
class Frame:
    """Positions (cm) of all particles at one time (s), in the listing's numbering."""

    time: float
    x: np.ndarray
    y: np.ndarray
    ring: np.ndarray  # 1, 2, ... of each particle


@dataclass
class Run:
    path: object
    scene: dict
    record: dict  # run.json
    frames: list
    monitor: dict  # column name -> values

    def at(self, time):
        """The frame at this time; InputError if the run wrote none."""
        half_step = 0.5 * self.scene["time"]["step"]
        for frame in self.frames:
            if abs(frame.time - time) < half_step:
                return frame
        raise InputError(f"{self.path / 'frames.extxyz'}: no frame at t = {time:g} s")


def read_run(path):
    """The complete run in this directory. InputError if it is missing, incomplete or not finite."""
    if not (path / "run.json").is_file():
        raise InputError(f"{path}: no run there")
    record = read_with(lambda file: json.loads(file.read_text()), path / "run.json")
    if record.get("status") != "complete":
        raise InputError(f"{path}: the run is not complete but {record.get('status')}")
    return Run(
        path,
        read_with(lambda file: tomllib.loads(file.read_text()), path / "scene.toml"),
        record,
        read_with(read_frames, path / "frames.extxyz"),
        read_with(read_monitor, path / "monitor.csv"),
    )


def read_with(reader, path):
    """What the reader makes of the file; InputError naming the file if it cannot."""
    try:
        return reader(path)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise InputError(f"{path}: cannot be read: {error}") from error


def read_frames(path):
    """All frames of an extended XYZ file as bounce writes it."""
    frames = []
    with open(path) as file:
        while line := file.readline():
            count = int(line)
            comment = file.readline()
            time = re.search(r"\bTime=(\S+)", comment)
            if not time or "species:S:1:pos:R:3:velo:R:3:ring:I:1" not in comment:
                raise ValueError(f"unknown comment line {comment.strip()!r}")
            rows = [file.readline().split() for _ in range(count)]
            if any(len(row) != 8 for row in rows):
                raise ValueError(f"the frame of t = {time[1]} is cut short")
            table = np.array([row[1:] for row in rows], dtype=float)
            if not np.isfinite(table).all():
                raise ValueError(f"the frame of t = {time[1]} is not finite")
            frames.append(Frame(float(time[1]), table[:, 0], table[:, 1], table[:, 6].astype(int)))
    return frames


def read_monitor(path):
    """The columns of monitor.csv by name."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2 or any(len(row) != len(rows[0]) for row in rows):
        raise ValueError("empty or cut short")
    table = np.array(rows[1:], dtype=float)
    if not np.isfinite(table).all():
        raise ValueError("not finite")
    return dict(zip(rows[0], table.T))
