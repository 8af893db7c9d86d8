# SPDX-License-Identifier: Apache-2.0
"""Plots by matplotlib, on axes of the caller or new ones."""
import numpy as np
from flatlight.errors import BadRequest

_UNITS = {"irradiance": "W/m", "gradient": "W/m²", "hessian": "W/m³", "rotation_gradient": "W/(m rad)"}
_ERRORS = {"gradient": "gradient_error", "hessian": "hessian_error", "rotation_gradient": "rotation_gradient_error"}
_COLOURS = ("tab:red", "tab:green", "tab:blue")


def plot(result, quantity="irradiance", ax=None):
    """Draws irradiance, gradient, hessian or rotation_gradient of every probe over arc length, with a band of two errors;
    with irradiance of irradiance caching, a mark at each record (in colour: at the mean of the channels). Of a picture: the
    picture. Returns the axes."""
    if quantity not in _UNITS:
        raise BadRequest(f"quantity: is {quantity!r}; allowed: {', '.join(_UNITS)}")
    ax = ax or _new_axes()
    probes = [probe for probe in result.probes if getattr(probe, quantity) is not None]
    if not probes:
        raise BadRequest(f"the result has no {quantity}; ask for it, or by another method")
    if probes[0].is_picture:
        return picture(probes[0], ax)
    for probe in probes:
        _draw_lines(ax, probe, quantity)
    if quantity == "irradiance" and len(result.records):
        arc_length = result.records.arc_length
        shown = np.isfinite(arc_length) & (result.records.bounce == 0)
        values = result.records.irradiance
        values = values if values.ndim == 1 else values.mean(axis=1)
        ax.plot(arc_length[shown], values[shown], "k|", label="records")
    ax.set_xlabel("arc length (m)" if probes[0].arc_length is not None else "point")
    ax.set_ylabel(f"{probes[0].quantity.lower() if quantity == 'irradiance' else quantity.replace('_', ' ')} ({_UNITS[quantity]})")
    ax.legend()
    return ax


def picture(probe, ax=None):
    """Draws a picture's fluence; in colour with the brightest hundredth white. Returns the axes."""
    ax = ax or _new_axes()
    values = probe.irradiance
    (left, bottom), (right, top) = probe.corners
    if values.ndim == 3:
        values = np.clip(values / max(np.quantile(values, 0.99), np.finfo(float).tiny), 0, 1)
    image = ax.imshow(values, origin="lower", extent=(left, right, bottom, top))
    if values.ndim == 2:
        ax.figure.colorbar(image, ax=ax, label="fluence (W/m)")
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    return ax


def _draw_lines(ax, probe, quantity):
    where = probe.arc_length if probe.arc_length is not None else np.arange(len(probe.irradiance))
    known = probe.known
    values = getattr(probe, quantity)[known]
    error = probe.error if quantity == "irradiance" else getattr(probe, _ERRORS[quantity])
    for channel in range(probe.channels):
        line = values if values.ndim == 1 else values[:, channel]
        colour = {} if probe.channels == 1 else {"color": _COLOURS[channel]}
        label = probe.name if probe.channels == 1 else f"{probe.name}, {'red green blue'.split()[channel]}"
        drawn, = ax.plot(where[known], line, label=label, **colour)
        if error is not None:
            band = 2 * (error[known] if error.ndim == 1 else error[known][:, channel])
            ax.fill_between(where[known], line - band, line + band, alpha=0.3, color=drawn.get_color())


def _new_axes():
    try:
        from matplotlib import pyplot
    except ImportError:
        raise ImportError("plots need matplotlib: Debian's python3-matplotlib") from None
    return pyplot.subplots()[1]
