# SPDX-License-Identifier: Apache-2.0
"""An HTTP server on loopback that keeps what is posted to it, for as long as a `with` block lasts."""
import http.server
import threading
import time


class Receiver:
    """`answers`: the statuses of the first posts, then 200 for ever. A number of seconds in place of a status: is silent for so
    long, and then hangs up."""

    def __init__(self, *answers, headers=(), port=0):
        self.posts = []  # (path, headers in lower case, body), in the order of their arrival.
        self.most_at_once = 0
        open_posts = []
        answers = list(answers)
        lock = threading.Lock()

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(handler):
                body = handler.rfile.read(int(handler.headers["content-length"]))
                with lock:
                    self.posts.append((handler.path, {key.lower(): value for key, value in handler.headers.items()}, body))
                    answer = answers.pop(0) if answers else 200
                    open_posts.append(handler)
                    self.most_at_once = max(self.most_at_once, len(open_posts))
                if answer < 100:
                    self._closing.wait(answer)
                with lock:
                    open_posts.remove(handler)
                if answer < 100:
                    return
                handler.send_response(answer)
                for name, value in headers:
                    handler.send_header(name, value)
                handler.send_header("content-length", "0")
                handler.end_headers()

            def log_message(handler, *unused):
                pass

        self._closing = threading.Event()
        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.host = f"127.0.0.1:{self._server.server_port}"
        self.url = f"http://{self.host}/hook?token=hidden"

    def __enter__(self):
        self._thread = threading.Thread(target=self._server.serve_forever, kwargs={"poll_interval": 0.05})
        self._thread.start()
        return self

    def __exit__(self, *unused):
        self._closing.set()
        self._server.shutdown()
        self._thread.join()
        self._server.server_close()

    def await_posts(self, count, seconds=60):
        end = time.monotonic() + seconds
        while len(self.posts) < count:
            if time.monotonic() > end:
                raise AssertionError(f"{len(self.posts)} posts in place of {count} after {seconds} s")
            time.sleep(0.02)
        return self.posts
