# SPDX-License-Identifier: Apache-2.0
"""A TCP proxy on loopback whose connections can be cut, or fall silent."""
import socket
import threading


class Proxy:
    """Forwards to `target` ("HOST:PORT") for as long as a `with` block lasts; clients connect to `address`."""

    def __init__(self, target):
        host, port = target.rsplit(":", 1)
        self._target = (host, int(port))
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self._listener.getsockname()[1]
        self._lock = threading.Lock()
        self._sockets = []
        self._silent = set()  # Connections that swallow what comes from the server.
        self.connections = 0

    def __enter__(self):
        threading.Thread(target=self._accept, daemon=True).start()
        return self

    def __exit__(self, *unused):
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self.cut()

    def cut(self):
        """Ends all connections as if a cable had been pulled and put back."""
        with self._lock:
            sockets, self._sockets = self._sockets, []
        for pair in sockets:
            for end in pair:
                try:
                    end.shutdown(socket.SHUT_RDWR)
                except OSError:  # Has ended by itself.
                    pass
                end.close()

    def silence(self):
        """Lets the connections of now stay open, and nothing of the server come through any more."""
        with self._lock:
            self._silent.update(server for _, server in self._sockets)

    def _accept(self):
        while True:
            try:
                client, _ = self._listener.accept()
                server = socket.create_connection(self._target)
            except OSError:
                return
            with self._lock:
                self._sockets.append((client, server))
            self.connections += 1
            threading.Thread(target=self._forward, args=(client, server), daemon=True).start()
            threading.Thread(target=self._forward, args=(server, client), daemon=True).start()

    def _forward(self, source, sink):
        try:
            while data := source.recv(1 << 16):
                with self._lock:
                    silent = source in self._silent
                if not silent:
                    sink.sendall(data)
        except OSError:
            pass
        for end in (source, sink):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
