# SPDX-License-Identifier: Apache-2.0
"""Running a sweep: every run a job, once, however often the program is ended and begun anew."""
import json
import os
import uuid

import grpc
from flatlight import sweep_file
from flatlight.errors import BadRequest, Denied, Error
from flatlight.progress import Display

_BUSY = ("TOO_MANY_JOBS",)  # Refusals that end when jobs do.


class Sweep:
    """The sweep in the file `path` on a server. runs: sweep_file.Run each; jobs: the Job of each by its key. What was
    submitted is kept in PATH.jobs, under the server's address."""

    def __init__(self, client, path, quiet=False):
        self.runs = sweep_file.read(path)
        self.jobs = {}
        self._client = client
        self._quiet = quiet
        self._state = _State(path + ".jobs", client.address)

    def submit(self, again=False):
        """Submits what is not on the server yet, waiting for own jobs where it takes no more at once. `again`: also what
        failed or was cancelled."""
        for run in self.runs:
            job = self._known(run)
            if job is None or again and job.state in ("FAILED", "CANCELLED"):
                if job is not None or run.key not in self._state.pending:
                    self._state.begin(run.key)
                job = self._submit(run)
            self.jobs[run.key] = job

    def wait(self):
        """Returns when all jobs have ended."""
        for number, run in enumerate(self.runs, start=1):
            self._wait_for(self.jobs[run.key], number)

    def result(self, run):
        """The Result of a run that has one, or None."""
        return self.jobs[run.key].result() if self.jobs[run.key].state == "SUCCEEDED" else None

    def _known(self, run):
        name = self._state.jobs.get(run.key)
        if name is None:
            return None
        try:
            return self._client.job(name)
        except Error as error:
            if error.code != grpc.StatusCode.NOT_FOUND:  # Deleted, or of a server that keeps nothing: once more.
                raise
            return None

    def _submit(self, run):
        while True:
            unfinished = [job for job in self.jobs.values() if not job.ended]
            try:
                job = self._client.submit(run.scene, job_class=run.job_class, request_id=self._state.pending[run.key],
                                          final=_BUSY if unfinished else (), **run.values)
            except Denied as error:
                if error.reason not in _BUSY or not unfinished:
                    raise
                self._wait_for(unfinished[0], self.runs.index(run))
                continue
            except BadRequest as error:
                raise BadRequest(f"{run.label} with {run.values}: {error}", error.code, error.reason, error.mistakes) from None
            self._state.finish(run.key, job.name)
            return job

    def _wait_for(self, job, number):
        if job.ended:
            return
        display = None if self._quiet else Display(prefix=f"[{number}/{len(self.runs)}] ")
        for snapshot in job.watch():
            if display:
                display.show(snapshot)
        if display:
            display.close()


class _State:
    """What was submitted, on the disk. A request's id is written before it is sent, so that one whose answer was lost finds
    its job. jobs, pending: of this server, by the keys of runs."""

    def __init__(self, path, address):
        self._path = path
        try:
            with open(path, encoding="utf-8") as file:
                self._servers = json.load(file)
            own = self._servers.setdefault(address, {})
            self.jobs, self.pending = own.setdefault("jobs", {}), own.setdefault("pending", {})
        except FileNotFoundError:
            self.jobs, self.pending = {}, {}
            self._servers = {address: {"jobs": self.jobs, "pending": self.pending}}
        except (ValueError, AttributeError):
            raise BadRequest(f"{path}: is not what a sweep keeps; delete it to submit all anew") from None

    def begin(self, key):
        self.pending[key] = str(uuid.uuid4())
        self.jobs.pop(key, None)
        self._write()

    def finish(self, key, name):
        self.jobs[key] = name
        self.pending.pop(key, None)
        self._write()

    def _write(self):
        temporary = self._path + ".new"
        with open(temporary, "w", encoding="utf-8") as file:
            json.dump(self._servers, file, indent=1)
            file.write("\n")
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, self._path)
