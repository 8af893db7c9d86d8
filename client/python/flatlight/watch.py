# SPDX-License-Identifier: Apache-2.0
"""Watching a job: a stream that is taken up again where it broke, until the job has ended."""
import random
import threading
import time

import grpc
import numpy as np
from flatlight.arrays import FIELDS, Probe, stride
from flatlight.errors import Error, JobFailed, error_of
from flatlight.v1 import render_service_pb2, result_pb2

_State = render_service_pb2.Job.State
ENDED = (_State.SUCCEEDED, _State.FAILED, _State.CANCELLED)
# Of what the same call may well recover a little later. INTERNAL and UNKNOWN are also gRPC's own, of a broken connection.
_MAY_COME_BACK = (grpc.StatusCode.UNAVAILABLE, grpc.StatusCode.DEADLINE_EXCEEDED, grpc.StatusCode.CANCELLED,
                  grpc.StatusCode.ABORTED, grpc.StatusCode.INTERNAL, grpc.StatusCode.UNKNOWN)


class Snapshot:
    """A job's newest state. job: flatlight.v1.Job, with state and progress. records: how many cache records there are so
    far. resumes: how often the watch was taken up again."""

    def __init__(self, job, fields, records, resumes):
        self.job = job
        self.records = records
        self.resumes = resumes
        self._fields = fields

    @property
    def probes(self):
        """The values so far when this is asked, a Probe each; empty until the first picture."""
        return [self._fields[index].probe() for index in sorted(self._fields) if self._fields[index].has_values]


class _Field:
    """What FieldUpdates have told of one probe so far."""

    def __init__(self):
        self._fixed = result_pb2.ProbeResult()
        self._arrays = {}

    def take(self, update):
        points = update.points
        for field in ("name", "quantity", "channels", "width", "height"):
            if getattr(points, field):
                setattr(self._fixed, field, getattr(points, field))
        if points.corners:
            self._fixed.corners[:] = points.corners
        for field in FIELDS:
            values = getattr(points, field)
            if not values:
                continue
            width = stride(field, self._fixed.channels or 1)
            first, end = update.first * width, update.first * width + len(values)
            old = self._arrays.setdefault(field, np.zeros(self._fixed.width * self._fixed.height * width))
            if len(old) < end:
                old = np.concatenate([old, np.zeros(end - len(old))])
                self._arrays[field] = old
            old[first:end] = values

    @property
    def has_values(self):
        return "irradiance" in self._arrays

    def probe(self):
        message = result_pb2.ProbeResult()
        message.CopyFrom(self._fixed)
        # Points come in pieces; of those without values yet there are 0 samples.
        widths = {field: stride(field, message.channels or 1) for field in self._arrays}
        message.count = max(len(values) // widths[field] for field, values in self._arrays.items())
        for field, values in self._arrays.items():
            getattr(message, field).extend(np.pad(values, (0, message.count * widths[field] - len(values))))
        return Probe(message)


class _Silence:
    """Cancels a stream that says nothing for `seconds`: a peer that is gone without a word would hold it for ever."""

    def __init__(self, stream, seconds):
        self._stream = stream
        self._seconds = seconds
        self._heard = time.monotonic()
        self._done = threading.Event()
        self.too_long = False
        threading.Thread(target=self._run, daemon=True).start()

    def heard(self):
        self._heard = time.monotonic()

    def end(self):
        self._done.set()
        self._stream.cancel()

    def _run(self):
        while not self._done.wait(max(0, self._heard + self._seconds - time.monotonic())):
            if time.monotonic() - self._heard >= self._seconds:
                self.too_long = True
                self._stream.cancel()
                return


class Watch:
    """Iterates over the Snapshots of the job `name`, the last of which has ended. max_rate: updates a second. patience:
    seconds without a message after which a lost server is an error. silence: seconds without a message after which the
    stream is begun anew (heartbeats come every 10 s). cancel_on_disconnect: the server cancels the job when it loses this
    watch before the end, be it that you leave it, that the program ends, or that the connection breaks."""

    def __init__(self, client, name, *, max_rate=10, patience=120, silence=25, cancel_on_disconnect=False):
        self._client = client
        self._request = render_service_pb2.WatchJobRequest(name=name, max_rate=max_rate,
                                                           cancel_on_disconnect=cancel_on_disconnect)
        self._patience = patience
        self._silence = silence
        self._heard = time.monotonic()
        self._job = render_service_pb2.Job()
        self._failures = 0
        self.resumes = 0
        self._forget()

    def _forget(self):
        self._fields = {}
        self._records = 0

    def __iter__(self):
        while True:
            try:
                yield from self._stream()
            except grpc.RpcError as error:
                self._await_next_try(error)
            else:
                if self._job.state in ENDED:
                    return
                self._await_next_try(None)
            self.resumes += 1

    def _stream(self):
        stream = self._client.render_service.WatchJob(self._request, metadata=self._client.metadata)
        silence = _Silence(stream, self._silence)
        try:
            changed = False
            for message in stream:
                silence.heard()
                changed = self._take(message) or changed
                if not message.more and changed:
                    changed = False
                    yield Snapshot(self._job, self._fields, self._records, self.resumes)
                    if self._job.state in ENDED:
                        return
        finally:
            silence.end()
            if silence.too_long:
                self._client.reconnect()

    def _take(self, message):
        self._heard = time.monotonic()
        self._failures = 0
        if self._request.epoch not in (0, message.epoch):  # The server is another one: all comes again.
            self._forget()
        for update in message.updates:
            self._fields.setdefault(update.probe, _Field()).take(update)
        for update in message.records:
            self._records = max(self._records, update.first + len(update.records))
        if not message.more:
            self._request.epoch, self._request.sequence = message.epoch, message.sequence
        if message.HasField("job"):
            job = render_service_pb2.Job()
            job.CopyFrom(message.job)
            if not job.HasField("plan"):
                job.scene = self._job.scene
                job.settings.CopyFrom(self._job.settings)
                job.plan.CopyFrom(self._job.plan)
            self._job = job
        return bool(message.HasField("job") or message.updates or message.records)

    def _await_next_try(self, error):
        name, address = self._request.name, self._client.address
        if error is not None and error.code() == grpc.StatusCode.NOT_FOUND and self._request.epoch:
            raise JobFailed(f"the server no longer knows {name}; it was restarted, or the job deleted", error.code(),
                            "JOB_NOT_FOUND")
        if error is not None and error.code() not in _MAY_COME_BACK:
            raise error_of(error, address) from None
        lost = time.monotonic() - self._heard
        if lost > self._patience:
            reason = error_of(error, address) if error is not None else Error("the stream ended early")
            raise type(reason)(f"lost the server for more than {self._patience:g} s: {reason}", reason.code) from None
        self._failures += 1
        # Twice as long each time, from 50 ms to 2 s; by chance up to half less, so that watchers do not call in step.
        time.sleep(min(2.0, 0.05 * 2 ** min(self._failures - 1, 10)) * random.uniform(0.5, 1))
