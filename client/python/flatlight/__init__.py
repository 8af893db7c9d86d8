# SPDX-License-Identifier: Apache-2.0
"""Flatlight from Python: submit jobs to a server, watch them, and have their results as numpy arrays.

    import flatlight
    client = flatlight.Client("127.0.0.1:7000")
    result = client.render("gallery:penumbra", target_error=0.01)
    print(result["floor"].arc_length, result["floor"].irradiance, result["floor"].standard_error)
"""
from flatlight.arrays import Probe, Records
from flatlight.client import Client
from flatlight.errors import BadRequest, Denied, Error, JobFailed, Unreachable
from flatlight.job import Job
from flatlight.plots import picture, plot
from flatlight.progress import Display
from flatlight.result import Result, load
from flatlight.settings import settings
from flatlight.watch import Snapshot, Watch

__all__ = ["BadRequest", "Client", "Denied", "Display", "Error", "Job", "JobFailed", "Probe", "Records", "Result",
           "Snapshot", "Unreachable", "Watch", "load", "picture", "plot", "settings"]
