# SPDX-License-Identifier: Apache-2.0
"""A job on a server: state, watching, control, result."""
import grpc
from flatlight.errors import JobFailed, error_of
from flatlight.progress import Display
from flatlight.result import Result
from flatlight.v1 import render_service_pb2 as api, result_pb2
from flatlight.v1.sharing_pb2 import Share
from flatlight.watch import ENDED, Watch


class Job:
    """A job. Its attributes are of the time of the last call: refresh() asks anew."""

    def __init__(self, client, message):
        self._client = client
        self.message = message  # flatlight.v1.Job.

    @property
    def name(self):
        return self.message.name

    @property
    def state(self):
        """QUEUED, RUNNING, PAUSED, SUCCEEDED, FAILED or CANCELLED."""
        return api.Job.State.Name(self.message.state)

    @property
    def ended(self):
        return self.message.state in ENDED

    @property
    def progress(self):
        """flatlight.v1.Progress: fraction, relative_error, rays, ..."""
        return self.message.progress

    @property
    def owner(self):
        """The user that made it."""
        return self.message.owner

    @property
    def shares(self):
        """With whom it is shared, as {"user:ada": "READ", "course": "CONTROL"}: for those who may share it."""
        return {share.grantee: Share.Access.Name(share.access) for share in self.message.shares}

    @property
    def webhook(self):
        """Who is told of the job's end, and how far that is: flatlight.v1.Webhook. For those who may share the job."""
        return self.message.webhook

    def refresh(self):
        self.message = self._client.call(self._client.render_service.GetJob, api.GetJobRequest(name=self.name))
        return self

    def watch(self, **options):
        """Iterates over Snapshots until the job has ended; a broken connection is taken up again. Leaving early leaves the
        job alone, unless it is watched with cancel_on_disconnect=True. Options: see flatlight.Watch."""
        for snapshot in Watch(self._client, self.name, **options):
            self.message = snapshot.job
            yield snapshot

    def wait(self, *, progress=True, **options):
        """Returns when the job has ended. `progress`: True for a display on the terminal or in the notebook, a function
        that takes each Snapshot, or None. Raises JobFailed if the job failed."""
        display = Display() if progress is True else None
        show = display.show if display else progress or (lambda snapshot: None)
        try:
            if not self.ended:
                for snapshot in self.watch(**options):
                    show(snapshot)
        finally:
            if display:
                display.close()
        if self.message.state == api.Job.FAILED:
            raise JobFailed(f"{self.name} failed: {self.message.error.message}", reason="JOB_FAILED")
        return self

    def result(self):
        """The Result of an ended job (of a cancelled one: as far as it went)."""
        try:
            chunks = self._client.render_service.GetResult(api.GetResultRequest(name=self.name),
                                                           metadata=self._client.metadata)
            data = b"".join(chunk.data for chunk in chunks)
        except grpc.RpcError as error:
            raise error_of(error, self._client.address) from None
        return Result(result_pb2.RenderResult.FromString(data))

    def cancel(self):
        return self._control(self._client.render_service.CancelJob, api.CancelJobRequest)

    def pause(self):
        return self._control(self._client.render_service.PauseJob, api.PauseJobRequest)

    def resume(self):
        return self._control(self._client.render_service.ResumeJob, api.ResumeJobRequest)

    def share(self, grantee, *, control=False):
        """Lets "user:NAME", "group:NAME" or "course" (everybody) see, watch and fetch it; with `control`, also cancel, pause
        and resume it."""
        share = Share(grantee=grantee, access=Share.CONTROL if control else Share.READ)
        return self._change_shares(self._client.render_service.ShareJob, api.ShareJobRequest(name=self.name, share=share))

    def unshare(self, grantee):
        """Ends that. Raises BadRequest if it is not shared so."""
        request = api.UnshareJobRequest(name=self.name, grantee=grantee)
        return self._change_shares(self._client.render_service.UnshareJob, request)

    def delete(self):
        self._client.call(self._client.render_service.DeleteJob, api.DeleteJobRequest(name=self.name))

    def _change_shares(self, method, request):
        self.message = self._client.call(method, request)
        return self

    def _control(self, method, request):
        self.message = self._client.call(method, request(name=self.name))
        return self

    def __repr__(self):
        return f"<{self.name} of {self.message.scene!r}: {self.state.lower()} {self.progress.fraction:.0%}>"
