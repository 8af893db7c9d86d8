# SPDX-License-Identifier: Apache-2.0
"""The door to a server: Client("HOST:PORT").submit("gallery:penumbra", target_error=0.01).result()"""
import os
import re
import time
import uuid

import grpc
from flatlight import scenes
from flatlight.errors import BadRequest, error_of
from flatlight.job import Job
from flatlight.retry import Retry
from flatlight.settings import enum_value, settings as make_settings
from flatlight.tls import Tls
from flatlight.v1 import (render_service_pb2, render_service_pb2_grpc, scene_service_pb2, scene_service_pb2_grpc,
                          server_service_pb2, server_service_pb2_grpc, sharing_pb2)

_ADDRESS = re.compile(r"unix:.+|(\[[0-9a-fA-F:.]+\]|[^:/\[\]]+):[0-9]{1,5}")
_LOCAL = re.compile(r"unix:|localhost:|127\.|\[::1\]")
_DEADLINE = 60  # s, of a call that is no stream.


class Client:
    """A connection to a server at HOST:PORT or unix:PATH; without an address, that of FLATLIGHT_SERVER. `token`: that
    the server asks for; without it, that of FLATLIGHT_TOKEN. TLS is spoken with other machines, and wherever a
    keyword of it is given here (or as FLATLIGHT_TLS_CA and so on): `tls_ca`, a PEM file of those who may vouch for the
    server, else the system's; `tls_cert` and `tls_key`, PEM files of one's own certificate, where the server asks for it;
    `tls_name`, the server's, where its address is another. Safe to share among threads."""

    def __init__(self, address=None, token=None, *, tls_ca=None, tls_cert=None, tls_key=None, tls_name=None):
        address = address or os.environ.get("FLATLIGHT_SERVER", "")
        if not _ADDRESS.fullmatch(address):
            raise BadRequest(f"the server's address is {address!r}; must be HOST:PORT or unix:PATH, here or in FLATLIGHT_SERVER")
        token = token or os.environ.get("FLATLIGHT_TOKEN", "")
        self.address = address
        self._tls = Tls(_LOCAL.match(address) is not None, tls_ca, tls_cert, tls_key, tls_name)
        self.metadata = [("authorization", f"Bearer {token}")] if token else []
        self.reconnect()

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.close()

    def close(self):
        self._channel.close()

    def reconnect(self):
        """Makes a connection anew, for calls from now on. A peer that vanished without a word is never missed by TCP."""
        options = {
            # The server bounds what it sends.
            "grpc.max_receive_message_length": -1,
            # gRPC's waits are long for a server that is just starting. The least is also how long a try may take.
            "grpc.initial_reconnect_backoff_ms": 20,
            "grpc.min_reconnect_backoff_ms": 1000,
            "grpc.max_reconnect_backoff_ms": 1000,
            # Without a pool of its own the channel would be given the old connection.
            "grpc.use_local_subchannel_pool": 1,
            "grpc.enable_http_proxy": 0 if _LOCAL.match(self.address) else 1,
        }
        self._channel = self._tls.channel(self.address, options)
        self.render_service = render_service_pb2_grpc.RenderServiceStub(self._channel)
        self.scene_service = scene_service_pb2_grpc.SceneServiceStub(self._channel)
        self.server_service = server_service_pb2_grpc.ServerServiceStub(self._channel)

    def call(self, method, request, *, final=()):
        """The answer of a call that is no stream, or an Error. Where the server is too busy, or does not answer, the call is
        made up to four times more, if that is safe, with a warning in the log "flatlight". `final`: reasons of refusals
        after which it is not."""
        tries = Retry(request)
        while True:
            try:
                return method(request, timeout=_DEADLINE, metadata=self.metadata)
            except grpc.RpcError as rpc_error:
                error = error_of(rpc_error, self.address)
            wait = tries.next(error) if error.reason not in final else None
            if wait is None:
                raise error
            time.sleep(wait)

    def submit(self, scene, *, probes=(), job_class=None, request_id=None, anew=False, webhook="", settings=None,
               final=(), **keywords):
        """Submits a job and returns it at once. `scene`: gallery:NAME, a file's path, a dictionary in the file's form.
        Settings are keywords (method="path-tracing", target_error=0.01) or a flatlight.v1.Settings. `job_class`:
        interactive, graded or regrade. The same `request_id` (a UUID) finds the job of the first call.
        `anew`: the job does its own work, also if an equal one of the server has done it. `webhook`: a URL that the server
        sends a POST when the job has ended, signed with webhook_secret(). `final`: as in call()."""
        request = render_service_pb2.CreateJobRequest(scene=scenes.provide(self, scene, probes),
                                                      settings=_settings(settings, keywords),
                                                      request_id=request_id or str(uuid.uuid4()), anew=anew,
                                                      webhook=webhook)
        if job_class is not None:
            request.job_class = enum_value(request.DESCRIPTOR.fields_by_name["job_class"].enum_type, job_class, "job_class")
        return Job(self, self.call(self.render_service.CreateJob, request, final=final))

    def render(self, scene, *, progress=True, **keywords):
        """Submits, waits with a display of progress, and returns the Result."""
        return self.submit(scene, **keywords).wait(progress=progress).result()

    def job(self, name):
        """The job `name`: "jobs/UUID" or the UUID."""
        name = name if name.startswith("jobs/") else "jobs/" + name
        return Job(self, self.call(self.render_service.GetJob, render_service_pb2.GetJobRequest(name=name)))

    def jobs(self, *, shared=False, own=False):
        """The caller's own jobs (everybody's, for graders and above, but with `own`), the newest first; with `shared`,
        those of others that are shared with the caller."""
        request = render_service_pb2.ListJobsRequest(page_size=1000, shared=shared, own=own)
        while True:
            page = self.call(self.render_service.ListJobs, request)
            yield from (Job(self, job) for job in page.jobs)
            request.page_token = page.next_page_token
            if not request.page_token:
                return

    def scenes(self, *, shared=False, own=False):
        """The gallery, then the caller's uploads (everybody's, for graders and above): flatlight.v1.SceneInfo each. With
        `own`, the caller's uploads alone; with `shared`, those of others that are shared with the caller."""
        request = scene_service_pb2.ListScenesRequest(page_size=1000, shared=shared, own=own)
        while True:
            page = self.call(self.scene_service.ListScenes, request)
            yield from page.scenes
            request.page_token = page.next_page_token
            if not request.page_token:
                return

    def share_scene(self, name, grantee, *, control=False):
        """Lets `grantee` ("user:NAME", "group:NAME" or "course") read and render an upload of one's own, "scenes/HASH";
        with `control`, delete it too. The flatlight.v1.SceneInfo, with all its shares."""
        share = sharing_pb2.Share(grantee=grantee, access=sharing_pb2.Share.CONTROL if control else sharing_pb2.Share.READ)
        return self.call(self.scene_service.ShareScene, scene_service_pb2.ShareSceneRequest(name=name, share=share))

    def unshare_scene(self, name, grantee):
        """Ends that. Raises BadRequest if it is not shared so."""
        request = scene_service_pb2.UnshareSceneRequest(name=name, grantee=grantee)
        return self.call(self.scene_service.UnshareScene, request)

    def delete_scene(self, name):
        """Takes an upload, "scenes/HASH", from oneself; jobs that were made from it keep it."""
        self.call(self.scene_service.DeleteScene, scene_service_pb2.DeleteSceneRequest(name=name))

    def validate(self, scene, *, probes=()):
        """Every mistake of a scene, as (path, message); none: it is good."""
        source = scenes.provide(self, scene, probes)
        response = self.call(self.scene_service.ValidateScene, scene_service_pb2.ValidateSceneRequest(scene=source))
        return [(diagnostic.path, diagnostic.message) for diagnostic in response.diagnostics]

    def explain(self, scene, *, probes=(), settings=None, **keywords):
        """The plan for a scene, a flatlight.v1.Plan. Renders nothing."""
        request = render_service_pb2.ExplainJobRequest(scene=scenes.provide(self, scene, probes),
                                                       settings=_settings(settings, keywords))
        return self.call(self.render_service.ExplainJob, request).plan

    def webhook_secret(self):
        """With what webhooks of one's own jobs are signed: "whsec_…", as the Standard Webhooks specification has it."""
        return self.call(self.server_service.GetWebhookSecret, server_service_pb2.GetWebhookSecretRequest()).secret

    def rotate_webhook_secret(self, keep_earlier_seconds=None):
        """Makes a new one, which it returns. Messages are signed with the earlier one too for so many seconds (none
        given: a day; 0: not at all, as for one that others know)."""
        request = server_service_pb2.RotateWebhookSecretRequest(keep_earlier_seconds=keep_earlier_seconds)
        return self.call(self.server_service.RotateWebhookSecret, request).secret

    def capabilities(self):
        """What the server is and allows: flatlight.v1.GetCapabilitiesResponse."""
        return self.call(self.server_service.GetCapabilities, server_service_pb2.GetCapabilitiesRequest())


def _settings(message, keywords):
    if message is not None and keywords:
        raise BadRequest("settings come as one message or as keywords, not both")
    return message if message is not None else make_settings(**keywords)
