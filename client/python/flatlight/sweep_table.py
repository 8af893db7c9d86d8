# SPDX-License-Identifier: Apache-2.0
"""The table of a sweep: what was varied, and what came of it."""
import csv
import os

import numpy as np
from flatlight.settings import text as setting_text

# After the columns of what was varied. Seconds; relative_error: as Job.progress has it; mean: of all values, W/m.
_OUTCOMES = ("state", "end_reason", "seconds", "cpu_seconds", "rays", "records", "relative_error", "mean")


def varied(runs):
    """The settings that tell runs apart, in the order in which they appear."""
    names = dict.fromkeys(name for run in runs for name in run.values)
    return [name for name in names if len({repr(run.values.get(name)) for run in runs}) > 1]


def row(number, run, job, result):
    """A row by the names of columns; None where there is nothing to say."""
    cells = {"run": number, "job": job.name, "scene": run.label, "state": job.state.lower()} | run.values
    cells |= dict.fromkeys(_OUTCOMES[1:])
    if job.progress.HasField("relative_error"):
        cells["relative_error"] = job.progress.relative_error
    if result is not None:
        statistics = result.statistics
        values = [probe.irradiance[probe.known].ravel() for probe in result.probes]
        cells |= {"end_reason": setting_text(result.end_reason), "seconds": statistics.wall_seconds,
                  "cpu_seconds": statistics.cpu_seconds, "rays": statistics.rays or None,
                  "records": statistics.records or None, "mean": float(np.concatenate(values).mean())}
    return cells


def text(rows, varied_names):
    """For people: as few columns as tell something, numbers of 4 digits."""
    several_scenes = len({cells["scene"] for cells in rows}) > 1
    columns = ["run"] + ["scene"] * several_scenes + varied_names
    columns += [name for name in _OUTCOMES if any(cells.get(name) is not None for cells in rows)]
    table = [[name.upper().replace("_", " ") for name in columns]]
    table += [[_cell(cells.get(name)) for name in columns] for cells in rows]
    widths = [max(len(line[i]) for line in table) for i in range(len(columns))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in table)


def write_csv(path, rows, varied_names):
    """For programs: all columns, numbers with the digits that read back exactly. Whole or not at all."""
    columns = ["run", "job", "scene", *varied_names, *_OUTCOMES]
    temporary = path + ".new"
    with open(temporary, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for cells in rows:
            writer.writerow([" ".join(cell) if isinstance(cell := cells.get(name), list) else cell for name in columns])
    os.replace(temporary, path)


def _cell(value):
    if value is None:
        return "-"
    if isinstance(value, list):
        return " ".join(value) or "none"
    return f"{value:.4g}" if isinstance(value, float) else setting_text(value) if isinstance(value, str) else str(value)
