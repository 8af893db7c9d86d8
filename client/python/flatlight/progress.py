# SPDX-License-Identifier: Apache-2.0
"""A display of a job's progress: a line that is drawn anew on a terminal, a bar in a notebook, else a line a second."""
import html
import shutil
import sys
import time

from flatlight.v1 import render_service_pb2 as api

_BAR = 24
_INTERVAL = 1.0  # s between lines, where they cannot be drawn over.
_ERASE = "\r\x1b[K"  # To the first column; erase to the end (ECMA-48, EL).


def details(job):
    """ "42 %  error 1.3 %  2.1 M rays/s  3.4 s left" of a flatlight.v1.Job."""
    if job.state == api.Job.QUEUED:
        if not job.HasField("queue"):
            return "waiting for its turn"
        return f"waiting, {job.queue.ahead:.0f} ahead" if job.queue.ahead else "waiting, next"
    progress = job.progress
    percent = int(100 * min(max(progress.fraction, 0), 1))
    parts = [f"{min(percent, 99) if job.state == api.Job.RUNNING else percent:3d} %"]  # 100 is kept for the end.
    if progress.HasField("relative_error"):
        parts.append(f"error {100 * progress.relative_error:.2g} %")
    if progress.records:
        parts.append(f"{progress.records:.0f} records")
    if progress.rays and progress.elapsed_seconds:
        parts.append(f"{progress.rays / progress.elapsed_seconds / 1e6:.3g} M rays/s")
    if progress.HasField("remaining_seconds") and job.state == api.Job.RUNNING:
        parts.append(f"{progress.remaining_seconds:.2g} s left")
    if job.state == api.Job.PAUSED:
        parts.append("paused")
    return "  ".join(parts)


class Display:
    """Shows Snapshots. `notebook`: whether to, None to find out."""

    def __init__(self, out=None, notebook=None, prefix=""):
        self._out = out or sys.stderr
        self._notebook = _in_notebook() if notebook is None else notebook
        self._prefix = prefix
        self._cell = None
        self._drawn = ""
        self._shown_at = None

    def show(self, snapshot):
        job = snapshot.job
        label, text = self._prefix + (job.scene or job.name), details(job)
        if self._notebook:
            self._show_in_notebook(label, text, job.progress.fraction)
        elif self._out.isatty():
            done = int(_BAR * min(max(job.progress.fraction, 0), 1))
            line = f"{label} [{'#' * done}{'-' * (_BAR - done)}] {text}"
            # The last column stays free: some terminals wrap as soon as it is written.
            self._draw(_ERASE + line[:shutil.get_terminal_size().columns - 1], line)
        else:
            now = time.monotonic()
            last = job.state in (api.Job.SUCCEEDED, api.Job.FAILED, api.Job.CANCELLED)
            if last or self._shown_at is None or now - self._shown_at >= _INTERVAL:
                self._shown_at = now
                self._draw(f"{label} {text}\n", f"{label} {text}")

    def close(self):
        """The terminal's line is left as it is."""
        if not self._notebook and self._out.isatty() and self._drawn:
            self._out.write("\n")
        self._drawn = ""

    def _draw(self, output, line):
        if line != self._drawn:
            self._out.write(output)
            self._out.flush()
            self._drawn = line

    def _show_in_notebook(self, label, text, fraction):
        from IPython.display import HTML, display
        content = HTML(f"<progress max='1' value='{fraction:.3f}'></progress> "
                       f"<code>{html.escape(label)} {html.escape(text)}</code>")
        if self._cell is None:
            self._cell = display(content, display_id=True)
        else:
            self._cell.update(content)


def _in_notebook():
    shell = sys.modules.get("IPython") and sys.modules["IPython"].get_ipython()
    return shell is not None and type(shell).__name__ == "ZMQInteractiveShell"  # Of a kernel, not of a terminal.
