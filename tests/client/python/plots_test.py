# SPDX-License-Identifier: Apache-2.0
"""What plots draw, on axes that write it down: the package needs no matplotlib but to open new ones."""
import types
import unittest

import flatlight
import numpy as np
from flatlight.v1 import result_pb2


class Axes:
    def __init__(self):
        self.lines, self.bands, self.images, self.labels = [], [], [], {}
        self.figure = types.SimpleNamespace(colorbar=lambda image, ax, label: self.labels.update(colour=label))

    def plot(self, x, y, *style, label=None, color="a colour"):
        self.lines.append((np.array(x), np.array(y), label))
        return [types.SimpleNamespace(get_color=lambda: color)]

    def fill_between(self, x, low, high, alpha, color):
        self.bands.append((np.array(low), np.array(high), color))

    def imshow(self, values, origin, extent):
        self.images.append((values, origin, extent))

    def set_xlabel(self, text):
        self.labels["x"] = text

    def set_ylabel(self, text):
        self.labels["y"] = text

    def legend(self):
        pass


def result(*probes, records=()):
    return flatlight.Result(result_pb2.RenderResult(probes=[result_pb2.ProbeResult(**probe) for probe in probes],
                                                    records=[result_pb2.CacheRecord(**record) for record in records]))


class PlotsTest(unittest.TestCase):
    def test_a_line_has_a_band_of_two_errors_and_leaves_out_what_is_not_known(self):
        ax = Axes()
        floor = {"name": "floor", "count": 3, "channels": 1, "quantity": 1, "arc_length": [0, 1, 2],
                 "irradiance": [5, 6, 0], "standard_error": [0.5, 0.25, 0], "samples": [16, 16, 0]}
        self.assertIs(flatlight.plot(result(floor), ax=ax), ax)
        (x, y, label), = ax.lines
        self.assertEqual((list(x), list(y), label), ([0, 1], [5, 6], "floor"))
        (low, high, colour), = ax.bands
        self.assertEqual((list(low), list(high), colour), ([4, 5.5], [6, 6.5], "a colour"))
        self.assertEqual(ax.labels, {"x": "arc length (m)", "y": "irradiance (W/m)"})

    def test_a_coloured_gradient_has_a_line_a_channel(self):
        ax = Axes()
        wall = {"name": "wall", "count": 2, "channels": 3, "quantity": 1, "arc_length": [0, 1], "irradiance": [1] * 6,
                "gradient": [1, 2, 3, 4, 5, 6], "gradient_error": [0, 0, 0, 1, 2, 3]}
        flatlight.plot(result(wall), "gradient", ax)
        self.assertEqual([list(y) for _, y, _ in ax.lines], [[1, 4], [2, 5], [3, 6]])
        self.assertEqual([label for *_, label in ax.lines], ["wall, red", "wall, green", "wall, blue"])
        self.assertEqual([list(high) for _, high, _ in ax.bands], [[1, 6], [2, 9], [3, 12]])
        with self.assertRaisesRegex(flatlight.BadRequest, "no hessian"):
            flatlight.plot(result(wall), "hessian", ax)
        with self.assertRaisesRegex(flatlight.BadRequest, "'slope'; allowed: irradiance, gradient"):
            flatlight.plot(result(wall), "slope", ax)

    def test_records_on_probes_are_marks(self):
        ax = Axes()
        floor = {"name": "floor", "count": 2, "channels": 1, "quantity": 1, "arc_length": [0, 1], "irradiance": [5, 6]}
        place = {"position": [0, 0], "normal": [0, 1], "radius": [1, 1]}
        records = [place | {"irradiance": [5], "arc_length": 0.5, "bounce": 0}, place | {"irradiance": [7], "bounce": 0},
                   place | {"irradiance": [9], "arc_length": 0.7, "bounce": 1}]
        flatlight.plot(result(floor, records=records), ax=ax)
        self.assertEqual([list(part) for part in ax.lines[-1][:2]], [[0.5], [5]])

    def test_a_picture_stands_upright_in_its_corners(self):
        ax = Axes()
        plane = {"name": "plane", "count": 6, "channels": 1, "quantity": 2, "width": 3, "height": 2,
                 "corners": [-1, -2, 5, 2], "irradiance": [0, 1, 2, 3, 4, 5]}
        flatlight.plot(result(plane), ax=ax)
        (values, origin, extent), = ax.images
        self.assertEqual((values.tolist(), origin, extent), ([[0, 1, 2], [3, 4, 5]], "lower", (-1, 5, -2, 2)))
        self.assertEqual(ax.labels["colour"], "fluence (W/m)")
        plane |= {"channels": 3, "irradiance": list(range(18))}
        flatlight.plot(result(plane), ax=ax)
        self.assertEqual((ax.images[-1][0].shape, ax.images[-1][0].max(), ax.images[-1][0].min()), ((2, 3, 3), 1, 0))


if __name__ == "__main__":
    unittest.main()
