# SPDX-License-Identifier: Apache-2.0
"""What the display of progress shows on a terminal, in a file, in a notebook."""
import io
import sys
import types
import unittest
from unittest import mock

from flatlight import Display, Snapshot
from flatlight.progress import details
from flatlight.v1 import render_service_pb2 as api


def snapshot(fraction, state=api.Job.RUNNING, **progress):
    job = api.Job(name="jobs/x", scene="<room>", state=state, progress=api.Progress(fraction=fraction, **progress))
    return Snapshot(job, {}, 0, 0)


class Terminal(io.StringIO):
    def isatty(self):
        return True


class ProgressTest(unittest.TestCase):
    def test_a_line_says_how_far_how_well_how_fast_how_long(self):
        job = snapshot(1, relative_error=0.0123, rays=3e6, elapsed_seconds=2, remaining_seconds=4.2, records=7).job
        self.assertEqual(details(job), " 99 %  error 1.2 %  7 records  1.5 M rays/s  4.2 s left")
        self.assertEqual(details(snapshot(1, api.Job.SUCCEEDED).job), "100 %")
        self.assertEqual(details(snapshot(0.5, api.Job.PAUSED).job), " 50 %  paused")
        job = snapshot(0, api.Job.QUEUED).job
        self.assertEqual(details(job), "waiting for its turn")
        job.queue.ahead = 3
        self.assertEqual(details(job), "waiting, 3 ahead")

    def test_a_terminal_s_line_is_drawn_over_and_fits(self):
        out = Terminal()
        display = Display(out, notebook=False, prefix="[1/2] ")
        with mock.patch("shutil.get_terminal_size", return_value=types.SimpleNamespace(columns=40)):
            display.show(snapshot(0.5))
            display.show(snapshot(0.5))  # Nothing new: not drawn.
            display.show(snapshot(1, api.Job.SUCCEEDED))
        display.close()
        draws = out.getvalue().split("\r\x1b[K")
        self.assertEqual(draws, ["", "[1/2] <room> [############------------]  50 %"[:39],
                                 "[1/2] <room> [########################] 100 %"[:39] + "\n"])

    def test_elsewhere_there_is_a_line_a_second_and_the_last(self):
        out = io.StringIO()
        display = Display(out, notebook=False)
        clock = iter((0.0, 0.5, 1.0, 1.1))
        with mock.patch("time.monotonic", lambda: next(clock)):
            for one in (snapshot(0.1), snapshot(0.2), snapshot(0.3), snapshot(1, api.Job.SUCCEEDED)):
                display.show(one)
        display.close()
        self.assertEqual(out.getvalue(), "<room>  10 %\n<room>  30 %\n<room> 100 %\n")

    def test_a_notebook_has_one_cell_that_changes(self):
        shown = []

        class Handle:
            def update(self, content):
                shown.append(content)

        def show(content, display_id):
            self.assertTrue(display_id)
            shown.append(content)
            return Handle()

        module = types.ModuleType("IPython.display")
        module.HTML, module.display = str, show
        package = types.ModuleType("IPython")
        package.display = module
        package.get_ipython = lambda: type("ZMQInteractiveShell", (), {})()
        with mock.patch.dict(sys.modules, {"IPython": package, "IPython.display": module}):
            display = Display()
            display.show(snapshot(0.25))
            display.show(snapshot(1, api.Job.SUCCEEDED))
            display.close()
        self.assertEqual(len(shown), 2)
        self.assertIn("value='0.250'", shown[0])
        self.assertIn("&lt;room&gt;  25 %", shown[0])
        self.assertIn("value='1.000'", shown[1])


if __name__ == "__main__":
    unittest.main()
