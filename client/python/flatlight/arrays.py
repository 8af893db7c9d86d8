# SPDX-License-Identifier: Apache-2.0
"""The API's flat arrays as numpy's: one axis for points (of pictures two), then one for components or channels."""
import numpy as np

# Fields of a ProbeResult by what a point has of them.
_VECTORS = ("positions", "normals")  # x, y.
_SCALARS = ("arc_length", "samples")
SPECTRAL = ("irradiance", "standard_error", "gradient", "gradient_error", "hessian", "hessian_error", "irradiance_error",
            "rotation_gradient", "rotation_gradient_error", "estimated_bias", "estimated_error")  # Channels.
FIELDS = _VECTORS + _SCALARS + SPECTRAL


def stride(field, channels):
    """Numbers of a point."""
    return 2 if field in _VECTORS else channels if field in SPECTRAL else 1


def shaped(field, flat, channels, points):
    """`flat` with the shape points + (2,), points + (3,) in colour, or points."""
    width = stride(field, channels)
    return np.asarray(flat, dtype=float).reshape(points + ((width,) if width > 1 else ()))


class Probe:
    """The points of one probe. Arrays are None where the method does not give them, or nobody asked. With n points they
    have shape (n,), in colour (n, 3); of a picture (height, width), the lowest row first.

    irradiance: the quantity (W/m; RADIANCE of a camera: W/(rad m)); standard_error: its standard error, None if the
    method is deterministic; irradiance_error: a bound; gradient, hessian: derivatives along the probe (W/m^2, W/m^3), and
    gradient_error, hessian_error; samples: paths, 0 where nothing is known. The fields are those of ProbeResult in
    proto/flatlight/v1/result.proto, which has all meanings and units; positions and normals have shape (n, 2)."""

    def __init__(self, message):
        self.name = message.name
        self.quantity = message.DESCRIPTOR.enum_types_by_name["Quantity"].values_by_number[message.quantity].name
        self.channels = message.channels or 1
        self.is_picture = message.height > 1
        self.corners = np.array(message.corners).reshape(-1, 2) if message.corners else None
        count = message.count or len(message.irradiance) // self.channels
        points = (message.height, message.width) if self.is_picture else (count,)
        for field in FIELDS:
            flat = getattr(message, field)
            setattr(self, field, shaped(field, flat, self.channels, points) if len(flat) else None)

    @property
    def error(self):
        """What the method says of each value's error, the first of: standard error, bound, estimate. None: only the
        result's statistics have one."""
        for error in (self.standard_error, self.irradiance_error, self.estimated_error):
            if error is not None:
                return error
        return None

    @property
    def known(self):
        """Where values mean something: False where the time limit came before the point's turn."""
        points = self.irradiance.shape[:2] if self.is_picture else self.irradiance.shape[:1]
        return np.ones(points, dtype=bool) if self.samples is None else self.samples > 0

    def __repr__(self):
        return f"<probe {self.name!r}: {self.quantity.lower()} {'x'.join(map(str, self.irradiance.shape))}>"


class Records:
    """Cache records of irradiance caching, in the order in which they were made: arrays with a row a record. position,
    normal: (n, 2). irradiance, gradient, hessian: (n,), in colour (n, 3). radius: (n, 2), how far it counts against and
    along the curve, m. arc_length: NaN for free points. bounce, wave: int. curve: names."""

    def __init__(self, messages):
        for field, width in (("position", 2), ("normal", 2), ("radius", 2), ("irradiance", 1), ("gradient", 1),
                             ("hessian", 1)):
            table = np.array([list(getattr(message, field)) for message in messages], dtype=float)
            table = table.reshape(len(messages), table.size // len(messages) if messages else width)
            setattr(self, field, table[:, 0] if table.shape[1] == 1 else table)
        self.arc_length = np.array([m.arc_length if m.HasField("arc_length") else np.nan for m in messages], dtype=float)
        self.bounce = np.array([m.bounce for m in messages], dtype=int)
        self.wave = np.array([m.wave for m in messages], dtype=int)
        self.noise = np.array([m.noise for m in messages], dtype=float)
        self.curve = [m.curve for m in messages]

    def __len__(self):
        return len(self.curve)
